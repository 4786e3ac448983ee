// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <compare>
#include <cstdint>
#include <vector>

#include "pcbmesh/geometry/point.hpp"

namespace pcbmesh::geometry {

/// Chain of straight segments and circular arcs.
/// `points` are the vertices in order; for every entry i of `arc_starts` (ascending) the three points
/// i, i+1, i+2 (cyclic if closed) are start, a point on the arc, and end of one arc. A path of one point is a dot.
/// A full circle is two arcs: points {a, top, b, bottom}, arc_starts {0, 2}, closed.
struct Path {
  std::vector<Point> points;
  std::vector<std::int32_t> arc_starts;
  bool closed = false;
  bool operator==(const Path&) const = default;
};

/// A drawn shape, as every board format has it: a path, swept by a round pen, perhaps filled.
/// dot + pen = disc; segment + pen = track; closed + filled + pen 0 = polygon; closed + filled + pen = rounded polygon.
struct Figure {
  Path path;
  Nm pen = 0;           ///< pen diameter, >= 0
  bool filled = false;  ///< fill the closed path as well
  bool operator==(const Figure&) const = default;
};

/// How chords replace an arc.
enum class ArcMode { inscribed, circumscribed, equal_area, octagon };

struct ArcOptions {
  Nm sagitta_nm = 5 * nm_per_um;      ///< largest distance between arc and chord, > 0
  ArcMode mode = ArcMode::inscribed;  ///< octagon: eight chords per turn whatever the radius, as in the paper
};

/// Vertices of the path with arcs replaced by chords. Shared circles give equal chords: the division of a full circle depends
/// on centre, radius and options alone. Nearly collinear arcs become one segment.
[[nodiscard]] Ring flatten(const Path& path, const ArcOptions& options);

/// Corners of a regular polygon for a circle. Counter-clockwise, first corner at angle 0 (octagon: edges axis-aligned).
[[nodiscard]] Ring circle(Point centre, Nm radius, const ArcOptions& options);

/// Rings whose union (non-zero winding) is the figure. All rings of a stroke are counter-clockwise and simple.
/// @param[out] simple  false if a filled path may cross itself, so that winding numbers can be negative;
///                     such a figure must be normalised on its own before it is added to others.
[[nodiscard]] std::vector<Ring> outline(const Figure& figure, const ArcOptions& options, bool& simple);

/// Bounding box of the figure, pen included (arcs bounded safely from outside).
[[nodiscard]] Box bounds(const Figure& figure);

/// A circle that an outline follows, in nanometres.
struct OutlineCircle {
  double x_nm = 0, y_nm = 0, radius_nm = 0;
  friend auto operator<=>(const OutlineCircle&, const OutlineCircle&) = default;
};

/// Appends the circles that the outline of a figure may follow: arcs of its path, widened by the pen, and the pen's round ends.
/// Some may lie inside the figure.
void append_circles(const Figure& figure, std::vector<OutlineCircle>& circles);

/// Disc, round-ended segment and polygon as figures.
[[nodiscard]] Figure disc(Point centre, Nm diameter);
[[nodiscard]] Figure segment(Point a, Point b, Nm width);
[[nodiscard]] Figure polygon(Ring corners);

}  // namespace pcbmesh::geometry
