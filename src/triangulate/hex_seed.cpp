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
#include "src/triangulate/split_edge.hpp"

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

void subdivide(Cdt& cdt, const GraphEdgeIndex& graph_edges, Vertex a, Vertex b, double wanted) {
  // Left to right whatever way the edge was found: the points are the same in any order of the edges.
  if (b->point() < a->point()) std::swap(a, b);
  const std::int32_t edge = graph_edge_of(graph_edges, a, b);
  const Point2 from = a->point(), to = b->point();
  const double length = std::sqrt(CGAL::squared_distance(from, to));
  const auto pieces = static_cast<std::int64_t>(std::round(length / wanted));
  for (std::int64_t k = 1; k < pieces; ++k) {
    const double t = static_cast<double>(k) / static_cast<double>(pieces);
    const Vertex v = split_edge(cdt, a, b, {from.x() + t * (to.x() - from.x()), from.y() + t * (to.y() - from.y())});
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
