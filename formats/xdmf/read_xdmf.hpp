// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "pcbmesh/base/progress.hpp"
#include "pcbmesh/mesh/mesh_data.hpp"

namespace pcbmesh::formats::xdmf {

/// All uniform grids of the file, numbers in HDF5 or as text. Tags from volume_tag and face_tag, else gmsh:physical.
/// Grids with the same points share them.
/// @throws Error file_unreadable (201), file_syntax (202), file_truncated (205), format_not_built (702), format_limit (703).
[[nodiscard]] mesh::MeshData read_xdmf(const std::filesystem::path& file, const Progress& progress);

}  // namespace pcbmesh::formats::xdmf
