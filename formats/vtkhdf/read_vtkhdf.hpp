// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "pcbmesh/base/progress.hpp"
#include "pcbmesh/mesh/mesh_data.hpp"

namespace pcbmesh::formats::vtkhdf {

/// Cells of /VTKHDF in one or several partitions; the tagged faces and names of a file of ours too.
/// @throws Error file_unreadable (201), file_syntax (202), file_truncated (205), format_not_built (702), format_limit (703).
[[nodiscard]] mesh::MeshData read_vtkhdf(const std::filesystem::path& file, const Progress& progress);

}  // namespace pcbmesh::formats::vtkhdf
