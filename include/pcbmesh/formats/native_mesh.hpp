// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "pcbmesh/base/progress.hpp"
#include "pcbmesh/mesh/prism_mesh.hpp"

namespace pcbmesh::formats {

/// Reads the implicit mesh of a native file (.pcbmesh, docs/native-mesh.md): equal to the one that was written.
/// @throws Error file_unreadable (201), file_syntax (202), file_truncated (205), format_not_built (702).
[[nodiscard]] mesh::PrismMesh read_prism_mesh(const std::filesystem::path& file, const Progress& progress = Progress{});

}  // namespace pcbmesh::formats
