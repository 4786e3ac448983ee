// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pcbmesh/base/progress.hpp"
#include "pcbmesh/mesh/planar_graph.hpp"
#include "src/triangulate/cdt.hpp"

namespace pcbmesh::triangulate {

/// Inserts every vertex and edge of the graph; each graph edge becomes one constrained edge.
/// @param unit_nm  nanometres per unit of the triangulation's coordinates; 1 keeps them exact
/// @throws Error planar_crossing_edges (403) naming both offenders and the place.
void insert_graph(const mesh::PlanarGraph& graph, double unit_nm, Cdt& cdt, const Progress& progress);

}  // namespace pcbmesh::triangulate
