// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/geometry/path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace pcbmesh::geometry {
namespace {

struct Circle {
  double x, y, r;
};

/// Circle through three points; nullopt if they are collinear or the radius is beyond a metre: then the arc is a segment.
std::optional<Circle> circle_through(Point a, Point b, Point c) {
  const double bx = static_cast<double>(b.x - a.x), by = static_cast<double>(b.y - a.y);
  const double cx = static_cast<double>(c.x - a.x), cy = static_cast<double>(c.y - a.y);
  const double d = 2 * (bx * cy - by * cx);
  if (a == c) {  // full circle given by two opposite points
    if (a == b) return std::nullopt;
    return Circle{static_cast<double>(a.x) + bx / 2, static_cast<double>(a.y) + by / 2, std::hypot(bx, by) / 2};
  }
  if (d == 0) return std::nullopt;
  const double ux = (cy * (bx * bx + by * by) - by * (cx * cx + cy * cy)) / d;
  const double uy = (bx * (cx * cx + cy * cy) - cx * (bx * bx + by * by)) / d;
  const double r = std::hypot(ux, uy);
  if (!(r < 1e9)) return std::nullopt;
  return Circle{static_cast<double>(a.x) + ux, static_cast<double>(a.y) + uy, r};
}

/// Chords of a full turn: a multiple of eight, so that axis and diagonal directions are corners and shared circles agree.
int chords_per_turn(double radius, const ArcOptions& options) {
  if (options.mode == ArcMode::octagon) return 8;
  const double sagitta = std::max(1.0, static_cast<double>(options.sagitta_nm));
  if (radius <= sagitta) return 8;
  const double half_angle = std::acos(1 - sagitta / radius);
  const double n = std::numbers::pi / half_angle;
  return 8 * std::clamp(static_cast<int>(std::ceil(n / 8 - 1e-9)), 1, 1 << 16);
}

/// Corner radius for a circle of radius r cut into n chords.
double corner_radius(double r, int n, ArcMode mode) {
  const double half = std::numbers::pi / n;
  switch (mode) {
    case ArcMode::inscribed:
      return r;
    case ArcMode::octagon:
    case ArcMode::circumscribed:
      return r / std::cos(half);
    case ArcMode::equal_area:
      return r * std::sqrt(2 * half / std::sin(2 * half));
  }
  return r;
}

Point rounded(double x, double y) {
  return {std::llround(x), std::llround(y)};
}

/// Appends the corners strictly between two angles of the circle's own division, walking by `sign`.
/// `from` and `to` are angles in radians, to reached from `from` in the direction of sign.
void append_corners(Ring& ring, const Circle& circle, double from, double to, int sign, const ArcOptions& options) {
  const int n = chords_per_turn(circle.r, options);
  const double step = 2 * std::numbers::pi / n;
  // An octagon stands on its sides (corners at odd multiples of 22.5 degrees), so that its edges run along the axes.
  const double phase = options.mode == ArcMode::octagon ? step / 2 : 0;
  const double radius = corner_radius(circle.r, n, options.mode);
  const double slack = 0.05;  // of a step: no sliver chord beside the ends
  double first = (from - phase) / step, last = (to - phase) / step;
  if (sign > 0) {
    while (last <= first) last += n;
    for (double k = std::floor(first + slack) + 1; k < last - slack; k += 1)
      ring.push_back(rounded(circle.x + radius * std::cos(k * step + phase), circle.y + radius * std::sin(k * step + phase)));
  } else {
    while (last >= first) last -= n;
    for (double k = std::ceil(first - slack) - 1; k > last + slack; k -= 1)
      ring.push_back(rounded(circle.x + radius * std::cos(k * step + phase), circle.y + radius * std::sin(k * step + phase)));
  }
}

void append_arc(Ring& ring, Point start, Point mid, Point end, const ArcOptions& options) {
  ring.push_back(start);
  const std::optional<Circle> circle = circle_through(start, mid, end);
  if (!circle) return;
  const auto angle = [&](Point p) {
    return std::atan2(static_cast<double>(p.y) - circle->y, static_cast<double>(p.x) - circle->x);
  };
  int sign = orientation(start, mid, end);
  if (sign == 0) sign = 1;
  append_corners(ring, *circle, angle(start), angle(end), sign, options);
}

void drop_repeats(Ring& ring, bool closed) {
  ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
  while (closed && ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
}

/// Round-ended stroke of one segment: counter-clockwise, simple.
Ring capsule(Point a, Point b, Nm width, const ArcOptions& options) {
  const double r = static_cast<double>(width) / 2;
  if (a == b) return circle(a, width / 2, options);
  const double dx = static_cast<double>(b.x - a.x), dy = static_cast<double>(b.y - a.y), length = std::hypot(dx, dy);
  const double nx = -dy / length * r, ny = dx / length * r;  // to the left
  const auto at = [&](Point p, double sx) {
    return rounded(static_cast<double>(p.x) + sx * nx, static_cast<double>(p.y) + sx * ny);
  };
  const double left = std::atan2(ny, nx), right = std::atan2(-ny, -nx);
  Ring ring;
  ring.push_back(at(b, -1));
  append_corners(ring, {static_cast<double>(b.x), static_cast<double>(b.y), r}, right, left, 1, options);
  ring.push_back(at(b, 1));
  ring.push_back(at(a, 1));
  append_corners(ring, {static_cast<double>(a.x), static_cast<double>(a.y), r}, left, right, 1, options);
  ring.push_back(at(a, -1));
  drop_repeats(ring, true);
  return ring;
}

/// Round-ended stroke of one arc as a single ring: outer side, cap, inner side, cap. Empty if the arc is straight, too tight
/// for the pen, or its ends come so close that the caps would overlap: then the caller strokes chord by chord.
Ring arc_band(Point start, Point mid, Point end, Nm width, const ArcOptions& options) {
  std::optional<Circle> circle = circle_through(start, mid, end);
  const double half = static_cast<double>(width) / 2;
  if (!circle || circle->r < 1.25 * half || start == end) return {};
  int sign = orientation(start, mid, end);
  if (sign < 0) std::swap(start, end);  // counter-clockwise about the centre
  const auto angle = [&](Point p) {
    return std::atan2(static_cast<double>(p.y) - circle->y, static_cast<double>(p.x) - circle->x);
  };
  const double from = angle(start);
  double to = angle(end);
  while (to <= from) to += 2 * std::numbers::pi;
  const double gap = 2 * std::numbers::pi - (to - from);
  if (sign == 0 || gap * circle->r < 2.5 * half) return {};
  const auto at = [&](double radius, double a) {
    return rounded(circle->x + radius * std::cos(a), circle->y + radius * std::sin(a));
  };
  const auto cap = [&](Point p) { return Circle{static_cast<double>(p.x), static_cast<double>(p.y), half}; };
  const double outer = circle->r + half, inner = circle->r - half;
  Ring ring;
  ring.push_back(at(outer, from));
  append_corners(ring, {circle->x, circle->y, outer}, from, to, 1, options);
  ring.push_back(at(outer, to));
  append_corners(ring, cap(end), to, to + std::numbers::pi, 1, options);
  ring.push_back(at(inner, to));
  append_corners(ring, {circle->x, circle->y, inner}, to, from, -1, options);
  ring.push_back(at(inner, from));
  append_corners(ring, cap(start), from + std::numbers::pi, from + 2 * std::numbers::pi, 1, options);
  drop_repeats(ring, true);
  return ring;
}

/// A polygon whose corners all turn left and once round is simple.
bool is_convex(const Ring& ring) {
  const std::size_t n = ring.size();
  if (n < 3) return false;
  double turned = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Point a = ring[i], b = ring[(i + 1) % n], c = ring[(i + 2) % n];
    if (orientation(a, b, c) < 0) return false;
    const double ux = static_cast<double>(b.x - a.x), uy = static_cast<double>(b.y - a.y);
    const double vx = static_cast<double>(c.x - b.x), vy = static_cast<double>(c.y - b.y);
    turned += std::atan2(ux * vy - uy * vx, ux * vx + uy * vy);
  }
  return turned < 3 * std::numbers::pi;
}

/// One ring per segment, one per arc where it can be a band, else one per chord.
void append_stroke(std::vector<Ring>& rings, const Path& path, Nm pen, const ArcOptions& options) {
  const std::size_t n = path.points.size();
  if (n == 1) rings.push_back(circle(path.points[0], pen / 2, options));
  std::size_t arc = 0;
  for (std::size_t i = 0; i + (path.closed ? 0 : 1) < n && n > 1;) {
    const Point a = path.points[i];
    if (arc < path.arc_starts.size() && static_cast<std::size_t>(path.arc_starts[arc]) == i && (path.closed || i + 2 < n)) {
      const Point mid = path.points[(i + 1) % n], b = path.points[(i + 2) % n];
      Ring band = arc_band(a, mid, b, pen, options);
      if (!band.empty()) {
        rings.push_back(std::move(band));
      } else {
        Ring chords;
        append_arc(chords, a, mid, b, options);
        chords.push_back(b);
        for (std::size_t k = 0; k + 1 < chords.size(); ++k) rings.push_back(capsule(chords[k], chords[k + 1], pen, options));
      }
      ++arc;
      i += 2;
    } else {
      const Point b = path.points[(i + 1) % n];
      if (a != b || n == 2) rings.push_back(capsule(a, b, pen, options));
      ++i;
    }
  }
}

}  // namespace

Ring flatten(const Path& path, const ArcOptions& options) {
  Ring ring;
  const std::size_t n = path.points.size();
  std::size_t arc = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (arc < path.arc_starts.size() && static_cast<std::size_t>(path.arc_starts[arc]) == i && (path.closed || i + 2 < n)) {
      append_arc(ring, path.points[i], path.points[(i + 1) % n], path.points[(i + 2) % n], options);
      ++i;  // the middle point is no corner
      ++arc;
    } else {
      ring.push_back(path.points[i]);
    }
  }
  drop_repeats(ring, path.closed);
  return ring;
}

Ring circle(Point centre, Nm radius, const ArcOptions& options) {
  const double r = static_cast<double>(radius);
  const int n = chords_per_turn(r, options);
  const double corner = corner_radius(r, n, options.mode), step = 2 * std::numbers::pi / n;
  const double phase = options.mode == ArcMode::octagon ? step / 2 : 0;
  Ring ring;
  ring.reserve(static_cast<std::size_t>(n));
  for (int k = 0; k < n; ++k)
    ring.push_back(rounded(static_cast<double>(centre.x) + corner * std::cos(k * step + phase),
                           static_cast<double>(centre.y) + corner * std::sin(k * step + phase)));
  drop_repeats(ring, true);
  return ring;
}

std::vector<Ring> outline(const Figure& figure, const ArcOptions& options, bool& simple) {
  std::vector<Ring> rings;
  simple = true;
  Ring corners = flatten(figure.path, options);
  if (corners.empty()) return rings;
  if (figure.filled && figure.path.closed && corners.size() >= 3) {
    Ring ring = corners;
    make_counter_clockwise(ring);
    simple = is_convex(ring);
    rings.push_back(std::move(ring));
  }
  if (figure.pen > 0) append_stroke(rings, figure.path, figure.pen, options);
  std::erase_if(rings, [](const Ring& ring) { return ring.size() < 3; });
  return rings;
}

Box bounds(const Figure& figure) {
  // Chords within a micrometre of the arcs, grown by that micrometre.
  constexpr Nm slack = nm_per_um;
  Box box;
  for (Point p : flatten(figure.path, {slack, ArcMode::inscribed})) box.add(p);
  return box.is_empty() ? box : box.grown((figure.pen + 1) / 2 + (figure.path.arc_starts.empty() ? 0 : slack));
}

void append_circles(const Figure& figure, std::vector<OutlineCircle>& circles) {
  const Path& path = figure.path;
  const std::size_t n = path.points.size();
  const double half = static_cast<double>(figure.pen) / 2;
  std::vector<char> is_corner(n, 1);
  for (const std::int32_t start : path.arc_starts) {
    const auto i = static_cast<std::size_t>(start);
    if (!path.closed && i + 2 >= n) continue;
    is_corner[(i + 1) % n] = 0;
    const std::optional<Circle> circle = circle_through(path.points[i], path.points[(i + 1) % n], path.points[(i + 2) % n]);
    if (!circle) continue;
    circles.push_back({circle->x, circle->y, circle->r + half});
    if (half > 0 && circle->r > half) circles.push_back({circle->x, circle->y, circle->r - half});
  }
  if (half <= 0) return;
  for (std::size_t i = 0; i < n; ++i)
    if (is_corner[i] != 0)
      circles.push_back({static_cast<double>(path.points[i].x), static_cast<double>(path.points[i].y), half});
}

Figure disc(Point centre, Nm diameter) {
  return {Path{{centre}, {}, false}, diameter, false};
}
Figure segment(Point a, Point b, Nm width) {
  return {Path{{a, b}, {}, false}, width, false};
}
Figure polygon(Ring corners) {
  return {Path{std::move(corners), {}, true}, 0, true};
}

}  // namespace pcbmesh::geometry
