// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pcbmesh/mesh/prism_mesh.hpp"

namespace pcbmesh::mesh {

/// Sizes, index ranges and order of every array of the parts. @throws Error internal (901). @cost O(parts).
void check_tables(const PrismMeshParts& parts);

/// X3: caps and walls are exactly the faces between present and absent cells, each once.
/// REQUIRES check_tables. @throws Error internal (901).
/// @cost O(triangles x slabs / 64 + triangles + regions x slabs + boundary faces x log).
void check_boundary(const PrismMeshParts& parts);

}  // namespace pcbmesh::mesh
