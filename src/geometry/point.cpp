// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/geometry/point.hpp"

#include <algorithm>
#include <cmath>

namespace pcbmesh::geometry {

void Box::add(Point p) noexcept {
  min = {std::min(min.x, p.x), std::min(min.y, p.y)};
  max = {std::max(max.x, p.x), std::max(max.y, p.y)};
}

void Box::add(const Box& other) noexcept {
  if (other.is_empty()) return;
  add(other.min);
  add(other.max);
}

Box Box::grown(Nm by) const noexcept {
  return {{min.x - by, min.y - by}, {max.x + by, max.y + by}};
}

bool Box::contains(Point p) const noexcept {
  return p.x >= min.x && p.x <= max.x && p.y >= min.y && p.y <= max.y;
}

bool Box::touches(const Box& other) const noexcept {
  return !is_empty() && !other.is_empty() && min.x <= other.max.x && other.min.x <= max.x && min.y <= other.max.y &&
         other.min.y <= max.y;
}

int orientation(Point a, Point b, Point c) noexcept {
  const __int128 turn = static_cast<__int128>(b.x - a.x) * (c.y - a.y) - static_cast<__int128>(b.y - a.y) * (c.x - a.x);
  return turn > 0 ? 1 : turn < 0 ? -1 : 0;
}

__int128 twice_area_nm2(const Ring& ring) noexcept {
  __int128 sum = 0;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++)
    sum += static_cast<__int128>(ring[j].x) * ring[i].y - static_cast<__int128>(ring[i].x) * ring[j].y;
  return sum;
}

double area_mm2(const Ring& ring) noexcept {
  return static_cast<double>(twice_area_nm2(ring)) * 0.5e-12;
}

void make_counter_clockwise(Ring& ring) {
  if (twice_area_nm2(ring) < 0) std::reverse(ring.begin(), ring.end());
}

Ring clip_to_box(const Ring& ring, const Box& box) {
  Ring current = ring;
  for (int side = 0; side < 4 && !current.empty(); ++side) {
    const bool along_x = side < 2;
    const Nm limit = side == 0 ? box.min.x : side == 1 ? box.max.x : side == 2 ? box.min.y : box.max.y;
    const bool keep_above = side % 2 == 0;
    const auto inside = [&](Point p) {
      const Nm value = along_x ? p.x : p.y;
      return keep_above ? value >= limit : value <= limit;
    };
    const auto cross = [&](Point a, Point b) {
      // Ordered ends: the same edge walked both ways gives the same point.
      if (b < a) std::swap(a, b);
      const long double t =
          static_cast<long double>(limit - (along_x ? a.x : a.y)) / static_cast<long double>(along_x ? b.x - a.x : b.y - a.y);
      if (along_x) return Point{limit, a.y + static_cast<Nm>(std::llroundl(t * static_cast<long double>(b.y - a.y)))};
      return Point{a.x + static_cast<Nm>(std::llroundl(t * static_cast<long double>(b.x - a.x))), limit};
    };
    Ring next;
    next.reserve(current.size() + 8);
    for (std::size_t i = 0, j = current.size() - 1; i < current.size(); j = i++) {
      const bool was = inside(current[j]), is = inside(current[i]);
      if (was != is) next.push_back(cross(current[j], current[i]));
      if (is) next.push_back(current[i]);
    }
    next.erase(std::unique(next.begin(), next.end()), next.end());
    while (next.size() > 1 && next.front() == next.back()) next.pop_back();
    current = std::move(next);
  }
  if (current.size() < 3) current.clear();
  return current;
}

}  // namespace pcbmesh::geometry
