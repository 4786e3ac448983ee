// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "pcbmesh/base/progress.hpp"
#include "src/triangulate/cdt.hpp"
#include "src/triangulate/graph_edges.hpp"

namespace pcbmesh::triangulate {

struct HexSeed {
  double edge = 0;                ///< of the lattice, in units of the triangulation
  double clearance = 0.62;        ///< of lattice points from constrained edges, over edge
  std::int64_t max_vertices = 0;  ///< @throws Error triangulation_limit (404) where the lattice alone would exceed it
};

/// Cuts constrained edges to about the lattice's edge and fills the domain with a hexagonal lattice: equilateral triangles
/// nearly everywhere before any refinement. Needs the faces marked in_domain; leaves the marks to be made anew.
/// New vertices on graph edges carry the edge in their Origin. @cost O(n log n).
void seed_hexagonal(Cdt& cdt, const GraphEdgeIndex& graph_edges, const HexSeed& seed, const Progress& progress);

}  // namespace pcbmesh::triangulate
