// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "pcbmesh/view/cell_mesh.hpp"
#include "validation/checks/cell_shapes.hpp"

namespace pcbmesh::view {

using validation::checks::LocalFace;
[[nodiscard]] inline std::span<const LocalFace> local_faces(mesh::CellKind kind) {
  return validation::checks::faces_of(kind);
}

/// CellMesh::faces(), with their tags; tells the tags which of them lie inside. Faces are brought together by their smallest
/// node, so many at a time that memory stays bounded.
[[nodiscard]] std::vector<CellFace> match_cell_faces(const CellMesh& mesh, std::span<CellFaceTag> tags,
                                                     std::int64_t most_at_once = 6'000'000);

}  // namespace pcbmesh::view
