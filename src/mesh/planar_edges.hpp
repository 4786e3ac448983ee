// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "pcbmesh/mesh/planar_mesh.hpp"

namespace pcbmesh::mesh {

struct PlanarEdge {
  std::int32_t a = 0, b = 0;  ///< a < b
  std::int32_t one = 0;       ///< triangle beside it
  std::int32_t other = -1;    ///< the other one, or -1
};

/// Every edge once, ascending by (a, b). @cost O(triangles log triangles).
[[nodiscard]] std::vector<PlanarEdge> edges_of(const PlanarMesh& planar);

}  // namespace pcbmesh::mesh
