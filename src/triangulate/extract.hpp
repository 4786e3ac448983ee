// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "pcbmesh/mesh/planar_mesh.hpp"
#include "src/triangulate/cdt.hpp"
#include "src/triangulate/flood.hpp"

namespace pcbmesh::triangulate {

struct Extraction {
  mesh::PlanarMeshParts parts;
  double smallest_sine2 = 1;         ///< of all angles
  std::int64_t num_below_bound = 0;  ///< triangles with a smaller angle than asked
  std::int64_t num_vertices = 0;     ///< of the triangulation, dropped ones included
};

/// Flat arrays of the faces inside the domain. Triangles follow a Hilbert curve, points and regions are numbered where the
/// triangles first meet them. Empties the triangulation, so that both never stand in memory at full size.
/// @param first  vertices that are numbered before all others, in this order.
[[nodiscard]] Extraction extract(Cdt& cdt, double unit_nm, const Regions& regions, double sine2_bound,
                                 const std::vector<Cdt::Vertex_handle>& first = {});

}  // namespace pcbmesh::triangulate
