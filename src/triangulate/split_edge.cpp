// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/triangulate/split_edge.hpp"

#include <array>
#include <utility>

#include "pcbmesh/base/error.hpp"
#include "src/triangulate/delaunay_flips.hpp"

namespace pcbmesh::triangulate {

using Vertex = Cdt::Vertex_handle;
using Point2 = Kernel::Point_2;

std::int32_t graph_edge_of(const GraphEdgeIndex& graph_edges, Vertex a, Vertex b) {
  return a->is_on_graph_edge()   ? a->graph_edge()
         : b->is_on_graph_edge() ? b->graph_edge()
                                 : graph_edges.find(a->graph_vertex(), b->graph_vertex());
}

Vertex split_edge(Cdt& cdt, Vertex a, Vertex b, const Point2& p) {
  Cdt::Face_handle face;
  int i = 0;
  if (!cdt.is_edge(a, b, face, i)) report_bug("an edge to be split is an edge", __FILE__, __LINE__);
  const bool is_constrained = face->is_constrained(i);
  const Cdt::Face_handle other = face->neighbor(i);
  const int j = other->index(face);
  // Counter-clockwise round the two faces, each edge seen from outside.
  const std::array<std::pair<Cdt::Face_handle, int>, 4> sides{
      {{face, Cdt::cw(i)}, {other, Cdt::ccw(j)}, {other, Cdt::cw(j)}, {face, Cdt::ccw(i)}}};
  std::array<Cdt::Edge, 4> outer;
  for (std::size_t k = 0; k < 4; ++k) {
    const auto& [inner, side] = sides[k];
    const Vertex from = inner->vertex(Cdt::ccw(side)), to = inner->vertex(Cdt::cw(side));
    if (!cdt.is_infinite(from) && !cdt.is_infinite(to) && cdt.orientation(from->point(), to->point(), p) != CGAL::LEFT_TURN)
      return {};
    outer[k] = {inner->neighbor(side), cdt.mirror_index(inner, side)};
  }
  const std::array<Cdt::Face_handle, 2> hole{face, other};
  const Vertex v = cdt.star_hole(p, outer.begin(), outer.end(), hole.begin(), hole.end());
  for (const Vertex end : {a, b}) {
    if (!is_constrained) break;
    if (!cdt.is_edge(v, end, face, i)) report_bug("a split edge has two halves", __FILE__, __LINE__);
    face->set_constraint(i, true);
    face->neighbor(i)->set_constraint(cdt.mirror_index(face, i), true);
  }
  make_delaunay_round(cdt, v);
  return v;
}

Vertex split_in_the_middle(Cdt& cdt, const GraphEdgeIndex& graph_edges, Vertex a, Vertex b) {
  Cdt::Face_handle face;
  int i = 0;
  const bool is_constrained = cdt.is_edge(a, b, face, i) && face->is_constrained(i);
  const std::int32_t edge = is_constrained ? graph_edge_of(graph_edges, a, b) : -1;
  const Vertex v = split_edge(cdt, a, b, CGAL::midpoint(a->point(), b->point()));
  if (v != Vertex() && is_constrained) v->set_graph_edge(edge);
  return v;
}

}  // namespace pcbmesh::triangulate
