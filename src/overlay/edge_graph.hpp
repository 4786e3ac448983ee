// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "pcbmesh/geometry/point.hpp"
#include "src/overlay/labels.hpp"

namespace pcbmesh::overlay {

using geometry::Point;

[[nodiscard]] constexpr std::size_t ix(std::int32_t id) noexcept {
  return static_cast<std::size_t>(id);
}

/// Straight edge u -> v; windings(left) = windings(right) + label.
struct Edge {
  std::int32_t u = 0;
  std::int32_t v = 0;
  std::int32_t label = 0;
};

/// Labelled edges over points. Points may be unused; edges are normalised by merge_edges: u < v, sorted, distinct.
struct EdgeGraph {
  std::vector<Point> points;
  std::vector<Edge> edges;
};

/// Orders each edge u < v (turning its label), sorts, adds the labels of equal edges, drops loops and empty labels.
void normalise(std::vector<Edge>& edges, LabelPool& labels);

/// Makes points distinct (edges follow) and drops unused ones; edges are normalised. Points come out ascending.
/// @param[in,out] flags  empty, or one value per point: equal points keep the largest.
void compact(EdgeGraph& graph, LabelPool& labels, std::vector<std::uint8_t>* flags = nullptr);

struct Vector {
  double x = 0, y = 0;
};

[[nodiscard]] inline Vector between(Point a, Point b) noexcept {
  return {static_cast<double>(b.x - a.x), static_cast<double>(b.y - a.y)};
}
[[nodiscard]] inline double dot(Vector a, Vector b) noexcept {
  return a.x * b.x + a.y * b.y;
}
[[nodiscard]] inline double cross(Vector a, Vector b) noexcept {
  return a.x * b.y - a.y * b.x;
}
[[nodiscard]] inline double distance2(Point a, Point b) noexcept {
  const Vector d = between(a, b);
  return dot(d, d);
}
[[nodiscard]] inline double distance(Point a, Point b) noexcept {
  return std::sqrt(distance2(a, b));
}

/// Sign of the turn a -> b -> c, exact: the double filter decides all but nearly collinear cases.
[[nodiscard]] inline int turn(Point a, Point b, Point c) noexcept {
  const Vector ab = between(a, b), ac = between(a, c);
  const double left = ab.x * ac.y, right = ab.y * ac.x, det = left - right;
  if (std::abs(det) > 4e-16 * (std::abs(left) + std::abs(right))) return det > 0 ? 1 : -1;
  return geometry::orientation(a, b, c);
}

/// Where p stands beside segment a-b: share of the way, and squared distance to the carrier line.
struct Foot {
  double share = 0;
  double line_distance2 = 0;
};
[[nodiscard]] inline Foot foot_of(Point p, Point a, Point b) noexcept {
  const Vector ab = between(a, b), ap = between(a, p);
  const double length2 = dot(ab, ab), side = cross(ab, ap);
  return {dot(ab, ap) / length2, side * side / length2};
}

/// Squared distance of p to segment a-b (a may equal b).
[[nodiscard]] inline double segment_distance2(Point p, Point a, Point b) noexcept {
  const Vector ab = between(a, b), ap = between(a, p);
  const double along = dot(ab, ap), length2 = dot(ab, ab);
  if (along <= 0) return dot(ap, ap);
  if (along >= length2) return distance2(b, p);
  const double side = cross(ab, ap);
  return side * side / length2;
}

/// True if the open segments a-b and c-d cross in one point interior to both. Exact.
[[nodiscard]] bool crosses_properly(Point a, Point b, Point c, Point d) noexcept;

/// Crossing point of two properly crossing segments, rounded to the grid.
[[nodiscard]] Point crossing_point(Point a, Point b, Point c, Point d) noexcept;

}  // namespace pcbmesh::overlay
