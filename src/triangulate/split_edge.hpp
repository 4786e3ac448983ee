// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "src/triangulate/cdt.hpp"
#include "src/triangulate/graph_edges.hpp"

namespace pcbmesh::triangulate {

/// Graph edge on which the constrained edge a-b lies.
[[nodiscard]] std::int32_t graph_edge_of(const GraphEdgeIndex& graph_edges, Cdt::Vertex_handle a, Cdt::Vertex_handle b);

/// Puts a vertex at p on the edge a-b; both halves are constrained if the edge was. Null, and nothing done, where p, which is
/// rounded, would turn a triangle over.
[[nodiscard]] Cdt::Vertex_handle split_edge(Cdt& cdt, Cdt::Vertex_handle a, Cdt::Vertex_handle b, const Kernel::Point_2& p);

/// The same in its middle; the vertex knows the graph edge it lies on.
[[nodiscard]] Cdt::Vertex_handle split_in_the_middle(Cdt& cdt, const GraphEdgeIndex& graph_edges, Cdt::Vertex_handle a,
                                                     Cdt::Vertex_handle b);

}  // namespace pcbmesh::triangulate
