// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

namespace pcbmesh::formats::kicad {

/// Point or vector in KiCad's frame: millimetres, y DOWN.
struct Vec {
  double x = 0, y = 0;
  friend Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y}; }
  friend Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y}; }
  friend Vec operator*(double s, Vec a) { return {s * a.x, s * a.y}; }
  bool operator==(const Vec&) const = default;
};

/// Turn and shift within KiCad's frame: angles counter-clockwise as seen on the screen, though y points down.
/// Footprints of the bottom side are stored already mirrored, so there is no mirror here.
class Placement {
 public:
  Placement() = default;
  Placement(Vec origin, double degrees);
  [[nodiscard]] Vec operator()(Vec p) const {
    return {origin_.x + p.x * cos_ + p.y * sin_, origin_.y - p.x * sin_ + p.y * cos_};
  }

 private:
  Vec origin_{};
  double cos_ = 1, sin_ = 0;
};

/// Chain of segments and three-point arcs in KiCad's frame; the meaning is geometry::Path's.
struct Outlined {
  std::vector<Vec> points{};
  std::vector<std::size_t> arc_starts{};
  bool closed = false;
  double pen = 0;  ///< millimetres
  bool filled = false;
  void line_to(Vec p) { points.push_back(p); }
  /// Arc from the last point over mid to end. A last arc back to the first point is closed with close_arc().
  void arc_to(Vec mid, Vec end);
  void close_arc(Vec mid);
};

/// Circle as a closed path of two arcs.
[[nodiscard]] Outlined circle(Vec centre, double radius);
/// Rectangle between two corners, with corner radius (0 = sharp).
[[nodiscard]] Outlined rectangle(Vec low, Vec high, double radius);
/// Arc given the old way: centre, start and swept angle in degrees, clockwise on the screen when positive.
[[nodiscard]] Outlined arc_by_angle(Vec centre, Vec start, double degrees);
/// Arc through three points; start = end means the full circle.
[[nodiscard]] Outlined arc_by_points(Vec start, Vec mid, Vec end);
/// Corners of a cubic Bezier curve, ends included, within `tolerance` of it.
void append_bezier(std::vector<Vec>& out, const Vec (&control)[4], double tolerance);

}  // namespace pcbmesh::formats::kicad
