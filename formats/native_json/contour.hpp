// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "formats/syntax/json_tree.hpp"
#include "pcbmesh/geometry/path.hpp"

namespace pcbmesh::formats::native_json {

/// Lengths of one file: bare numbers are in this many millimetres.
struct FileUnit {
  double mm = 1.0;
};

/// [x, y].
[[nodiscard]] geometry::Point read_point(const syntax::JsonValue& value, FileUnit unit);

/// Length above 0.
[[nodiscard]] Nm read_positive(const syntax::JsonValue& value, FileUnit unit);

/// Points [x, y] and arcs {"arc": [[x, y] on the way, [x, y] end]}. A closed path may repeat its first point at the end.
[[nodiscard]] geometry::Path read_path(const syntax::JsonValue& points, FileUnit unit, bool closed);

/// The closed path of an area: exactly one of "points", "rect", "circle" and "slot" among the object's members.
/// @throws Error, also for an area that encloses nothing.
[[nodiscard]] geometry::Path read_area(const syntax::JsonValue& object, FileUnit unit);
[[nodiscard]] bool has_area(const syntax::JsonValue& object);

[[nodiscard]] geometry::Path circle_path(geometry::Point centre, Nm radius);

/// A hole in copper, and the words for it in messages.
struct Hole {
  geometry::Path path;
  std::string what;  ///< "the hole /planes/0/holes/1"
  std::int64_t line = 0;
};

/// Outer path with its holes cut in through slits of no width, as one closed path: the form every filled figure has.
/// Holes must lie inside and apart from one another: winding numbers would count overlaps twice.
/// @param value  for the place of errors.
[[nodiscard]] geometry::Path cut_holes(geometry::Path outer, const std::vector<Hole>& holes, const syntax::JsonValue& value);

}  // namespace pcbmesh::formats::native_json
