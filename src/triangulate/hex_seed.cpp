// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/triangulate/hex_seed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "pcbmesh/base/error.hpp"
#include "src/triangulate/copper_distance.hpp"
#include "src/triangulate/delaunay_flips.hpp"

namespace pcbmesh::triangulate {
namespace {

using Point2 = Kernel::Point_2;
using Vertex = Cdt::Vertex_handle;

/// Constrained edges that bound the domain somewhere, as pairs of vertices.
std::vector<std::pair<Vertex, Vertex>> constrained_edges(const Cdt& cdt) {
  std::vector<std::pair<Vertex, Vertex>> edges;
  for (auto edge = cdt.finite_edges_begin(); edge != cdt.finite_edges_end(); ++edge) {
    const auto& [face, i] = *edge;
    if (!face->is_constrained(i) || !(face->is_in_domain() || face->neighbor(i)->is_in_domain())) continue;
    edges.emplace_back(face->vertex(Cdt::cw(i)), face->vertex(Cdt::ccw(i)));
  }
  return edges;
}

std::vector<Point2> lattice_in_domain(const Cdt& cdt, const HexSeed& seed, const SegmentDistance& outlines,
                                      const Progress& progress) {
  constexpr double most = std::numeric_limits<double>::max();
  double left = most, right = -most, low = most, high = -most;
  for (auto v = cdt.finite_vertices_begin(); v != cdt.finite_vertices_end(); ++v) {
    left = std::min(left, v->point().x());
    right = std::max(right, v->point().x());
    low = std::min(low, v->point().y());
    high = std::max(high, v->point().y());
  }
  const double row_height = seed.edge * std::sqrt(3.0) / 2;
  if ((right - left) / seed.edge * ((high - low) / row_height) > 2.0 * static_cast<double>(seed.max_vertices)) {
    throw Error(ErrorCode::triangulation_limit,
                fmt::format("the hexagonal lattice alone would exceed the limit of {} vertices. "
                            "Ask for longer edges, or raise the limit",
                            seed.max_vertices));
  }
  std::vector<Point2> points;
  const double clearance = seed.clearance * seed.edge;
  Cdt::Face_handle hint;
  std::int64_t row = 0;
  for (double y = low + 0.5 * row_height; y < high; y = low + (static_cast<double>(row) + 0.5) * row_height) {
    const double first = left + (row % 2 == 0 ? 0.25 : 0.75) * seed.edge;
    std::int64_t column = 0;
    for (double x = first; x < right; x = first + static_cast<double>(++column) * seed.edge) {
      if (outlines.at(x, y, clearance) < clearance) continue;
      hint = cdt.locate(Point2(x, y), hint);
      if (cdt.is_infinite(hint) || !hint->is_in_domain()) continue;
      points.emplace_back(x, y);
    }
    ++row;
    progress.check();
  }
  return points;
}

/// Puts a vertex at p on the constrained edge a-b, unless p, which is rounded, would turn a triangle over.
Vertex split(Cdt& cdt, Vertex a, Vertex b, const Point2& p) {
  Cdt::Face_handle face;
  int i = 0;
  if (!cdt.is_edge(a, b, face, i)) report_bug("a constrained edge is an edge", __FILE__, __LINE__);
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
    if (!cdt.is_edge(v, end, face, i)) report_bug("a split edge has two halves", __FILE__, __LINE__);
    face->set_constraint(i, true);
    face->neighbor(i)->set_constraint(cdt.mirror_index(face, i), true);
  }
  make_delaunay_round(cdt, v);
  return v;
}

void subdivide(Cdt& cdt, const GraphEdgeIndex& graph_edges, Vertex a, Vertex b, double wanted) {
  // Left to right whatever way the edge was found: the points are the same in any order of the edges.
  if (b->point() < a->point()) std::swap(a, b);
  const std::int32_t edge = a->is_on_graph_edge()   ? a->graph_edge()
                            : b->is_on_graph_edge() ? b->graph_edge()
                                                    : graph_edges.find(a->graph_vertex(), b->graph_vertex());
  const Point2 from = a->point(), to = b->point();
  const double length = std::sqrt(CGAL::squared_distance(from, to));
  const auto pieces = static_cast<std::int64_t>(std::round(length / wanted));
  for (std::int64_t k = 1; k < pieces; ++k) {
    const double t = static_cast<double>(k) / static_cast<double>(pieces);
    const Vertex v = split(cdt, a, b, {from.x() + t * (to.x() - from.x()), from.y() + t * (to.y() - from.y())});
    if (v == Vertex()) return;
    v->set_graph_edge(edge);
    a = v;
  }
}

}  // namespace

void seed_hexagonal(Cdt& cdt, const GraphEdgeIndex& graph_edges, const HexSeed& seed, const Progress& progress) {
  const auto edges = constrained_edges(cdt);
  std::vector<SegmentDistance::Segment> outlines;
  outlines.reserve(edges.size());
  for (const auto& [a, b] : edges) outlines.push_back({a->point().x(), a->point().y(), b->point().x(), b->point().y()});
  const std::vector<Point2> lattice = lattice_in_domain(cdt, seed, SegmentDistance(std::move(outlines)), progress);
  for (const auto& [a, b] : edges) subdivide(cdt, graph_edges, a, b, seed.edge);
  Cdt::Face_handle hint;
  for (const Point2& p : lattice) hint = cdt.insert(p, hint)->face();
}

}  // namespace pcbmesh::triangulate
