// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "pcbmesh/base/progress.hpp"
#include "pcbmesh/mesh/mesh_data.hpp"

namespace pcbmesh::formats::elmer {

/// Reads a folder of mesh.header, mesh.nodes, mesh.elements, mesh.boundary and, if there, mesh.names; `file` may be the folder
/// or its mesh.header.
///
/// Bodies are volume tags, boundary conditions face tags; faces of none (0) are left out and counted, like points and lines.
/// Which cells a boundary element belongs to is not taken from the file. Names under "names for bodies" are of volumes, under
/// "names for boundaries" of faces, others of both. Shares no code with the writer but the table of node orders.
///
/// @throws Error file_unreadable (201), file_syntax (202), file_truncated (205), with file and line.
[[nodiscard]] mesh::MeshData read_elmer(const std::filesystem::path& file, const Progress& progress);

}  // namespace pcbmesh::formats::elmer
