// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/triangulate/insert_graph.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "pcbmesh/base/error.hpp"
#include "src/triangulate/hilbert_order.hpp"

namespace pcbmesh::triangulate {
namespace {

using geometry::Point;

std::array<double, 2> millimetres(Point p) {
  return {static_cast<double>(p.x) / static_cast<double>(nm_per_mm), static_cast<double>(p.y) / static_cast<double>(nm_per_mm)};
}

/// Is p inside the segment a-b, ends excluded?
bool lies_within(Point p, Point a, Point b) {
  if (p == a || p == b || geometry::orientation(a, b, p) != 0) return false;
  return std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x) && std::min(a.y, b.y) <= p.y && p.y <= std::max(a.y, b.y);
}

std::array<double, 2> crossing_mm(Point a, Point b, Point c, Point d) {
  const auto [ax, ay] = millimetres(a);
  const auto [bx, by] = millimetres(b);
  const auto [cx, cy] = millimetres(c);
  const auto [dx, dy] = millimetres(d);
  const double cross = (bx - ax) * (dy - cy) - (by - ay) * (dx - cx);
  const double t = ((cx - ax) * (dy - cy) - (cy - ay) * (dx - cx)) / cross;
  return {ax + t * (bx - ax), ay + t * (by - ay)};
}

[[noreturn]] void throw_crossing(std::size_t first, std::int64_t second, std::array<double, 2> at_mm, const char* how) {
  Spot spot;
  spot.at_mm = at_mm;
  throw Error(
      ErrorCode::planar_crossing_edges,
      fmt::format("graph edge {} {} {}; edges of a planar graph may meet at common end points only. This is a fault of the "
                  "overlay step: please report it",
                  first, how, second),
      spot, {static_cast<std::int64_t>(first), second});
}

/// Finds what is in the way of one edge and says so. Linear search: it runs once, in an error path.
[[noreturn]] void report_obstacle(const mesh::PlanarGraph& graph, std::size_t edge) {
  const auto vertices = graph.vertices();
  const auto edges = graph.edges();
  const auto at = [&](std::int32_t id) { return vertices[static_cast<std::size_t>(id)]; };
  const Point a = at(edges[edge][0]), b = at(edges[edge][1]);
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    if (lies_within(vertices[v], a, b)) {
      throw_crossing(edge, static_cast<std::int64_t>(v), millimetres(vertices[v]), "runs through vertex");
    }
  }
  for (std::size_t other = 0; other < edges.size(); ++other) {
    const Point c = at(edges[other][0]), d = at(edges[other][1]);
    if (geometry::orientation(a, b, c) * geometry::orientation(a, b, d) < 0 &&
        geometry::orientation(c, d, a) * geometry::orientation(c, d, b) < 0) {
      throw_crossing(edge, static_cast<std::int64_t>(other), crossing_mm(a, b, c, d), "crosses edge");
    }
  }
  report_bug("an edge that can't be inserted crosses something", __FILE__, __LINE__);
}

}  // namespace

void insert_graph(const mesh::PlanarGraph& graph, double unit_nm, Cdt& cdt, const Progress& progress) {
  const auto vertices = graph.vertices();
  const auto edges = graph.edges();
  std::vector<std::array<float, 2>> rough(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i)
    rough[i] = {static_cast<float>(vertices[i].x), static_cast<float>(vertices[i].y)};
  std::vector<Cdt::Vertex_handle> handles(vertices.size());
  Cdt::Face_handle hint;
  for (const std::uint32_t i : hilbert_order(rough)) {
    const Point p = vertices[i];
    // In nanometres these are integers below 2^53, exact as doubles, so CGAL's exact predicates judge the true graph.
    handles[i] = cdt.insert(Kernel::Point_2(static_cast<double>(p.x) / unit_nm, static_cast<double>(p.y) / unit_nm), hint);
    handles[i]->set_graph_vertex(static_cast<std::int32_t>(i));
    hint = handles[i]->face();
    if ((i & 0xfffU) == 0) progress.check();
  }
  for (std::size_t e = 0; e < edges.size(); ++e) {
    try {
      cdt.insert_constraint(handles[static_cast<std::size_t>(edges[e][0])], handles[static_cast<std::size_t>(edges[e][1])]);
    } catch (const Cdt::Intersection_of_constraints_exception&) {
      report_obstacle(graph, e);
    }
    if ((e & 0xfffU) == 0) progress.check();
  }
  // An edge through a vertex, or along another edge, is cut in silence by CGAL.
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (!cdt.is_edge(handles[static_cast<std::size_t>(edges[e][0])], handles[static_cast<std::size_t>(edges[e][1])])) {
      report_obstacle(graph, e);
    }
  }
}

}  // namespace pcbmesh::triangulate
