// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/geometry/ring_contact.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace pcbmesh::geometry {
namespace {

struct Edge {
  Point a, b;
  bool second = false;  ///< of the second ring
  [[nodiscard]] Nm min_x() const { return std::min(a.x, b.x); }
  [[nodiscard]] Nm max_x() const { return std::max(a.x, b.x); }
  [[nodiscard]] Nm min_y() const { return std::min(a.y, b.y); }
  [[nodiscard]] Nm max_y() const { return std::max(a.y, b.y); }
};

void append_edges(std::vector<Edge>& edges, const Ring& ring, bool second, const Box& within) {
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const Edge edge{ring[j], ring[i], second};
    if (edge.max_x() < within.min.x || edge.min_x() > within.max.x || edge.max_y() < within.min.y ||
        edge.min_y() > within.max.y)
      continue;
    edges.push_back(edge);
  }
}

ContactKind edge_contact(const Edge& p, const Edge& q) {
  const int a = orientation(p.a, p.b, q.a), b = orientation(p.a, p.b, q.b);
  const int c = orientation(q.a, q.b, p.a), d = orientation(q.a, q.b, p.b);
  if (a * b < 0 && c * d < 0) return ContactKind::crossing;
  const auto on = [](const Edge& e, Point v, int turn) {
    return turn == 0 && v.x >= e.min_x() && v.x <= e.max_x() && v.y >= e.min_y() && v.y <= e.max_y();
  };
  if (on(p, q.a, a) || on(p, q.b, b) || on(q, p.a, c) || on(q, p.b, d)) return ContactKind::touching;
  return ContactKind::none;
}

/// Sweep from left to right; pairs(p, q) picks which edges are compared. Stops at the first crossing.
template <class Pairs>
Contact sweep(std::vector<Edge>& edges, const Pairs& pairs) {
  std::stable_sort(edges.begin(), edges.end(), [](const Edge& p, const Edge& q) { return p.min_x() < q.min_x(); });
  Contact found;
  std::vector<std::size_t> active;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Edge& edge = edges[i];
    std::erase_if(active, [&](std::size_t k) { return edges[k].max_x() < edge.min_x(); });
    for (std::size_t k : active) {
      const Edge& other = edges[k];
      if (other.max_y() < edge.min_y() || other.min_y() > edge.max_y() || !pairs(edge, other)) continue;
      const ContactKind kind = edge_contact(edge, other);
      if (kind <= found.kind) continue;
      const Point near{std::max(edge.min_x(), other.min_x()), std::max(edge.min_y(), other.min_y())};
      found = {kind, near};
      if (kind == ContactKind::crossing) return found;
    }
    active.push_back(i);
  }
  return found;
}

/// +1 or -1 from the first vertex of `inner` off the boundary of `outer`; 0 if all lie on it.
int first_location(const Ring& inner, const Ring& outer) noexcept {
  for (Point p : inner)
    if (const int where = location(p, outer); where != 0) return where;
  return 0;
}

}  // namespace

Box bounds(const Ring& ring) noexcept {
  Box box;
  for (Point p : ring) box.add(p);
  return box;
}

Contact contact(const Ring& a, const Ring& b) {
  const Box box_a = bounds(a), box_b = bounds(b);
  if (!box_a.touches(box_b)) return {};
  std::vector<Edge> edges;
  append_edges(edges, a, false, box_b);
  append_edges(edges, b, true, box_a);
  return sweep(edges, [](const Edge& p, const Edge& q) { return p.second != q.second; });
}

std::optional<Point> self_crossing(const Ring& ring) {
  if (ring.empty()) return std::nullopt;
  std::vector<Edge> edges;
  append_edges(edges, ring, false, bounds(ring));
  const Contact found = sweep(edges, [](const Edge&, const Edge&) { return true; });
  if (found.kind != ContactKind::crossing) return std::nullopt;
  return found.at;
}

int winding_number(const Ring& ring, Point p) noexcept {
  int winding = 0;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const int turn = orientation(ring[j], ring[i], p);
    if (ring[j].y <= p.y && ring[i].y > p.y && turn > 0) ++winding;
    if (ring[j].y > p.y && ring[i].y <= p.y && turn < 0) --winding;
  }
  return winding;
}

double distance_to_segment(Point p, Point a, Point b) noexcept {
  const double dx = static_cast<double>(b.x - a.x), dy = static_cast<double>(b.y - a.y);
  const double px = static_cast<double>(p.x - a.x), py = static_cast<double>(p.y - a.y);
  const double length2 = dx * dx + dy * dy;
  const double share = length2 > 0 ? std::clamp((px * dx + py * dy) / length2, 0.0, 1.0) : 0;
  return std::hypot(px - share * dx, py - share * dy);
}

int location(Point p, const Ring& ring) noexcept {
  int winding = 0;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const Point a = ring[j], b = ring[i];
    const int turn = orientation(a, b, p);
    if (turn == 0 && p.x >= std::min(a.x, b.x) && p.x <= std::max(a.x, b.x) && p.y >= std::min(a.y, b.y) &&
        p.y <= std::max(a.y, b.y))
      return 0;
    if (a.y <= p.y && b.y > p.y && turn > 0) ++winding;
    if (a.y > p.y && b.y <= p.y && turn < 0) --winding;
  }
  return winding != 0 ? 1 : -1;
}

bool is_inside(const Ring& inner, const Ring& outer) noexcept {
  if (inner.empty() || outer.empty()) return false;
  const int where = first_location(inner, outer);
  if (where != 0) return where > 0;
  return first_location(outer, inner) <= 0;
}

}  // namespace pcbmesh::geometry
