// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <compare>
#include <vector>

#include "pcbmesh/base/units.hpp"

namespace pcbmesh::geometry {

/// Point on the nanometre grid. x to the right, y up.
struct Point {
  Nm x = 0;
  Nm y = 0;
  friend constexpr auto operator<=>(const Point&, const Point&) = default;
};

/// Closed polygon; the last point joins the first. May be weakly simple (zero-width slits); the side that
/// counts as inside is decided by winding numbers, not by orientation.
using Ring = std::vector<Point>;

/// Axis-aligned box; empty while max < min.
struct Box {
  Point min{max_coordinate_nm * 4, max_coordinate_nm * 4};
  Point max{-max_coordinate_nm * 4, -max_coordinate_nm * 4};
  void add(Point p) noexcept;
  void add(const Box& other) noexcept;
  [[nodiscard]] bool is_empty() const noexcept { return max.x < min.x || max.y < min.y; }
  [[nodiscard]] Box grown(Nm by) const noexcept;
  [[nodiscard]] bool contains(Point p) const noexcept;
  [[nodiscard]] bool touches(const Box& other) const noexcept;
};

/// Sign of the turn a -> b -> c: +1 left (counter-clockwise), -1 right, 0 collinear. Exact.
[[nodiscard]] int orientation(Point a, Point b, Point c) noexcept;

/// Twice the signed area, in nm^2, exact; positive for counter-clockwise. @cost O(points).
[[nodiscard]] __int128 twice_area_nm2(const Ring& ring) noexcept;

/// Signed area in mm^2.
[[nodiscard]] double area_mm2(const Ring& ring) noexcept;

/// Reverses the ring if its signed area is negative.
void make_counter_clockwise(Ring& ring);

/// Clips a ring to a box (Sutherland-Hodgman): winding numbers inside the box are kept, new edges run along
/// the box. The result may be empty.
[[nodiscard]] Ring clip_to_box(const Ring& ring, const Box& box);

}  // namespace pcbmesh::geometry
