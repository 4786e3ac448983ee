// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/kicad/transform.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pcbmesh::formats::kicad {

Placement::Placement(Vec origin, double degrees) : origin_(origin) {
  const double turn = std::fmod(degrees, 360.0);
  // Quarter turns exactly: most parts stand so, and their pads must stay axis-parallel.
  const double quarters = turn / 90.0;
  if (quarters == std::round(quarters)) {
    switch ((static_cast<int>(quarters) % 4 + 4) % 4) {
      case 0:
        return;
      case 1:
        cos_ = 0, sin_ = 1;
        return;
      case 2:
        cos_ = -1, sin_ = 0;
        return;
      default:
        cos_ = 0, sin_ = -1;
        return;
    }
  }
  cos_ = std::cos(turn * std::numbers::pi / 180);
  sin_ = std::sin(turn * std::numbers::pi / 180);
}

void Outlined::arc_to(Vec mid, Vec end) {
  arc_starts.push_back(points.size() - 1);
  points.push_back(mid);
  points.push_back(end);
}

void Outlined::close_arc(Vec mid) {
  arc_starts.push_back(points.size() - 1);
  points.push_back(mid);
  closed = true;
}

Outlined circle(Vec centre, double radius) {
  Outlined path;
  path.line_to({centre.x + radius, centre.y});
  path.arc_to({centre.x, centre.y + radius}, {centre.x - radius, centre.y});
  path.close_arc({centre.x, centre.y - radius});
  return path;
}

Outlined rectangle(Vec low, Vec high, double radius) {
  if (high.x < low.x) std::swap(low.x, high.x);
  if (high.y < low.y) std::swap(low.y, high.y);
  const double r = std::min({radius, (high.x - low.x) / 2, (high.y - low.y) / 2});
  Outlined path;
  path.closed = true;
  if (!(r > 0)) {
    path.points = {low, {high.x, low.y}, high, {low.x, high.y}};
    return path;
  }
  const double k = r * (1 - std::numbers::sqrt2 / 2);  // from the sharp corner to the middle of the arc
  path.line_to({low.x + r, low.y});
  path.line_to({high.x - r, low.y});
  path.arc_to({high.x - k, low.y + k}, {high.x, low.y + r});
  path.line_to({high.x, high.y - r});
  path.arc_to({high.x - k, high.y - k}, {high.x - r, high.y});
  path.line_to({low.x + r, high.y});
  path.arc_to({low.x + k, high.y - k}, {low.x, high.y - r});
  path.line_to({low.x, low.y + r});
  path.close_arc({low.x + k, low.y + k});
  return path;
}

Outlined arc_by_angle(Vec centre, Vec start, double degrees) {
  const Vec arm = start - centre;
  if (std::abs(degrees) >= 360) return circle(centre, std::hypot(arm.x, arm.y));
  const auto at = [&](double turn) { return Placement(centre, -turn)(arm); };
  Outlined path;
  path.line_to(start);
  path.arc_to(at(degrees / 2), at(degrees));
  return path;
}

Outlined arc_by_points(Vec start, Vec mid, Vec end) {
  if (start == end && !(mid == start)) {
    const Vec centre = 0.5 * (start + mid);
    return circle(centre, std::hypot(start.x - centre.x, start.y - centre.y));
  }
  Outlined path;
  path.line_to(start);
  path.arc_to(mid, end);
  return path;
}

void append_bezier(std::vector<Vec>& out, const Vec (&c)[4], double tolerance) {
  // Chords of n equal parameter steps stay within max|B''| / (8 n^2) of the curve.
  const Vec a = c[0] - 2 * c[1] + c[2], b = c[1] - 2 * c[2] + c[3];
  const double bend = 6 * std::max(std::hypot(a.x, a.y), std::hypot(b.x, b.y));
  const int n = static_cast<int>(std::clamp(std::ceil(std::sqrt(bend / (8 * tolerance))), 1.0, 10000.0));
  for (int i = 0; i <= n; ++i) {
    const double t = static_cast<double>(i) / n, s = 1 - t;
    out.push_back(s * s * s * c[0] + 3 * s * s * t * c[1] + 3 * s * t * t * c[2] + t * t * t * c[3]);
  }
}

}  // namespace pcbmesh::formats::kicad
