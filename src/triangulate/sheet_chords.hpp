// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "pcbmesh/mesh/planar_graph.hpp"
#include "pcbmesh/model/model.hpp"
#include "src/triangulate/cdt.hpp"
#include "src/triangulate/graph_edges.hpp"

namespace pcbmesh::triangulate {

/// Puts a vertex in the middle of every edge inside a sheet whose two ends lie on the sheet's rim: afterwards two elements at
/// least lie across every sheet. A new vertex is off every rim unless it splits one, and edges that appear end at new
/// vertices, so the number of such edges falls with every vertex.
/// @return number of vertices added.
[[nodiscard]] std::int64_t split_sheet_chords(Cdt& cdt, const mesh::PlanarGraph& graph, const GraphEdgeIndex& graph_edges,
                                              const model::Model& model);

}  // namespace pcbmesh::triangulate
