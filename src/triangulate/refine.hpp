// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "pcbmesh/base/progress.hpp"
#include "src/triangulate/cdt.hpp"
#include "src/triangulate/graph_edges.hpp"
#include "src/triangulate/mesh_bounds.hpp"

namespace pcbmesh::triangulate {

/// Delaunay refinement of the faces marked in_domain. New vertices on graph edges carry the edge in their Origin.
/// @throws Error triangulation_limit (404), cancelled (103).
void refine(Cdt& cdt, const MeshBounds& bounds, const GraphEdgeIndex& graph_edges, std::int64_t max_vertices,
            double expected_vertices, const Progress& progress);

}  // namespace pcbmesh::triangulate
