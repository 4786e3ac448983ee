// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/overlay/edge_graph.hpp"

#include <algorithm>
#include <numeric>

namespace pcbmesh::overlay {

void normalise(std::vector<Edge>& edges, LabelPool& labels) {
  for (Edge& e : edges) {
    if (e.u > e.v) {
      std::swap(e.u, e.v);
      e.label = labels.negate(e.label);
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return a.u != b.u ? a.u < b.u : a.v != b.v ? a.v < b.v : a.label < b.label;
  });
  std::size_t out = 0;
  for (std::size_t i = 0; i < edges.size();) {
    Edge sum = edges[i++];
    for (; i < edges.size() && edges[i].u == sum.u && edges[i].v == sum.v; ++i)
      sum.label = labels.add(sum.label, edges[i].label);
    if (sum.label != 0 && sum.u != sum.v) edges[out++] = sum;
  }
  edges.resize(out);
}

void compact(EdgeGraph& graph, LabelPool& labels, std::vector<std::uint8_t>* flags) {
  std::vector<std::int32_t> order;
  {
    std::vector<std::uint8_t> used(graph.points.size(), 0);
    for (const Edge& e : graph.edges) used[ix(e.u)] = used[ix(e.v)] = 1;
    for (std::size_t i = 0; i < used.size(); ++i) {
      if (used[i]) order.push_back(static_cast<std::int32_t>(i));
    }
  }
  std::sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
    return graph.points[ix(a)] != graph.points[ix(b)] ? graph.points[ix(a)] < graph.points[ix(b)] : a < b;
  });
  std::vector<std::int32_t> renumbered(graph.points.size(), -1);
  std::vector<Point> points;
  std::vector<std::uint8_t> kept_flags;
  points.reserve(order.size());
  for (const std::int32_t old : order) {
    if (points.empty() || points.back() != graph.points[ix(old)]) {
      points.push_back(graph.points[ix(old)]);
      if (flags != nullptr) kept_flags.push_back(0);
    }
    renumbered[ix(old)] = static_cast<std::int32_t>(points.size()) - 1;
    if (flags != nullptr) kept_flags.back() = std::max(kept_flags.back(), (*flags)[ix(old)]);
  }
  for (Edge& e : graph.edges) e.u = renumbered[ix(e.u)], e.v = renumbered[ix(e.v)];
  const std::size_t before = graph.edges.size();
  normalise(graph.edges, labels);
  graph.points = std::move(points);
  if (flags != nullptr) *flags = std::move(kept_flags);
  if (graph.edges.size() < before) {
    // Edges may have cancelled and left points behind.
    std::vector<std::uint8_t> used(graph.points.size(), 0);
    for (const Edge& e : graph.edges) used[ix(e.u)] = used[ix(e.v)] = 1;
    if (std::find(used.begin(), used.end(), 0) != used.end()) compact(graph, labels, flags);
  }
}

bool crosses_properly(Point a, Point b, Point c, Point d) noexcept {
  const int c_side = turn(a, b, c);
  if (c_side == 0) return false;
  const int d_side = turn(a, b, d);
  if (d_side == 0 || d_side == c_side) return false;
  const int a_side = turn(c, d, a);
  if (a_side == 0) return false;
  const int b_side = turn(c, d, b);
  return b_side != 0 && b_side != a_side;
}

Point crossing_point(Point a, Point b, Point c, Point d) noexcept {
  const auto wide_cross = [](Point p, Point q, Point r, Point s) {
    return static_cast<__int128>(q.x - p.x) * (s.y - r.y) - static_cast<__int128>(q.y - p.y) * (s.x - r.x);
  };
  const auto share = static_cast<long double>(wide_cross(a, c, c, d)) / static_cast<long double>(wide_cross(a, b, c, d));
  const Point x{a.x + static_cast<Nm>(std::llroundl(share * static_cast<long double>(b.x - a.x))),
                a.y + static_cast<Nm>(std::llroundl(share * static_cast<long double>(b.y - a.y)))};
  return {std::clamp(x.x, std::min(a.x, b.x), std::max(a.x, b.x)), std::clamp(x.y, std::min(a.y, b.y), std::max(a.y, b.y))};
}

}  // namespace pcbmesh::overlay
