// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "pcbmesh/base/progress.hpp"
#include "src/triangulate/cdt.hpp"
#include "src/triangulate/graph_edges.hpp"
#include "src/triangulate/mesh_bounds.hpp"

namespace pcbmesh::triangulate {

struct RefineLimits {
  std::int64_t max_vertices = 0;
  double expected_vertices = 1;  ///< for the progress only
  double unit_nm = 1;            ///< for the place in messages
};

/// Delaunay refinement of the faces marked in_domain. New vertices on graph edges carry the edge in their Origin.
/// @throws Error triangulation_limit (404), cancelled (103).
/// @param as_in_paper  CGAL's own queue and criteria (so no grading) and closed diametral circles
void refine(Cdt& cdt, const MeshBounds& bounds, const GraphEdgeIndex& graph_edges, const RefineLimits& limits, bool as_in_paper,
            const Progress& progress);

}  // namespace pcbmesh::triangulate
