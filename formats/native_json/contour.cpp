// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/native_json/contour.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/geometry/ring_contact.hpp"

namespace pcbmesh::formats::native_json {
namespace {

using geometry::Path;
using geometry::Point;
using geometry::Ring;
using syntax::JsonKind;
using syntax::JsonValue;

/// Chords fine enough to tell whether holes overlap.
constexpr geometry::ArcOptions fine_chords{nm_per_um, geometry::ArcMode::inscribed};

/// A vertex and, if an arc leads on from it, a point on that arc.
struct Corner {
  Point at;
  std::optional<Point> mid{};
};
using Contour = std::vector<Corner>;

Contour contour_of(const Path& path) {
  Contour contour;
  std::size_t arc = 0;
  for (std::size_t i = 0; i < path.points.size(); ++i) {
    contour.push_back({path.points[i]});
    if (arc < path.arc_starts.size() && static_cast<std::size_t>(path.arc_starts[arc]) == i) {
      contour.back().mid = path.points[(i + 1) % path.points.size()];
      ++arc;
      ++i;
    }
  }
  return contour;
}

void append(Path& path, const Corner& corner) {
  if (corner.mid) path.arc_starts.push_back(static_cast<std::int32_t>(path.points.size()));
  path.points.push_back(corner.at);
  if (corner.mid) path.points.push_back(*corner.mid);
}

void reverse(Contour& contour) {
  const std::size_t n = contour.size();
  Contour out(n);
  // Corner k of the reversed walk is corner n-1-k; the arc that leaves it is the one that led to it.
  for (std::size_t k = 0; k < n; ++k) out[k] = {contour[n - 1 - k].at, contour[(2 * n - 2 - k) % n].mid};
  contour = std::move(out);
}

Path slot_path(Point a, Point b, Nm width) {
  const double dx = static_cast<double>(b.x - a.x), dy = static_cast<double>(b.y - a.y), length = std::hypot(dx, dy);
  const double r = static_cast<double>(width) / 2, ux = dx / length * r, uy = dy / length * r;
  const auto at = [](Point p, double x, double y) {
    return Point{std::llround(static_cast<double>(p.x) + x), std::llround(static_cast<double>(p.y) + y)};
  };
  // Right side from a to b, round b, left side back, round a.
  return {{at(a, uy, -ux), at(b, uy, -ux), at(b, ux, uy), at(b, -uy, ux), at(a, -uy, ux), at(a, -ux, -uy)}, {1, 4}, true};
}

constexpr std::array<std::string_view, 4> area_fields{"points", "rect", "circle", "slot"};

Path read_rect(const JsonValue& value, FileUnit unit) {
  if (value.as_array().size() != 2) value.fail("expected two opposite corners, [[x, y], [x, y]]");
  auto it = value.begin();
  const Point a = read_point(*it, unit);
  const Point b = read_point(*++it, unit);
  const Point low{std::min(a.x, b.x), std::min(a.y, b.y)}, high{std::max(a.x, b.x), std::max(a.y, b.y)};
  return {{low, {high.x, low.y}, high, {low.x, high.y}}, {}, true};
}

Path read_slot(const JsonValue& value, FileUnit unit) {
  value.allow_only({"points", "width"});
  const JsonValue points = value.at("points");
  if (points.as_array().size() != 2) points.fail("a slot has two points, the centres of its round ends");
  auto it = points.begin();
  const Point a = read_point(*it, unit);
  const Point b = read_point(*++it, unit);
  const Nm width = read_positive(value.at("width"), unit);
  return a == b ? circle_path(a, width / 2) : slot_path(a, b, width);
}

struct FlatHole {
  Ring ring;
  geometry::Box box;
  std::size_t index;
};

/// Every hole inside the outer ring and apart from every other.
void require_holes_apart(const Ring& outer, std::vector<FlatHole> holes, const std::vector<Hole>& named,
                         const JsonValue& value) {
  const auto text_at = [](Point p) {
    return fmt::format("({:.6g}, {:.6g}) mm", static_cast<double>(p.x) * 1e-6, static_cast<double>(p.y) * 1e-6);
  };
  for (const FlatHole& hole : holes) {
    const geometry::Contact met = geometry::contact(hole.ring, outer);
    if (met.kind == geometry::ContactKind::none && geometry::is_inside(hole.ring, outer)) continue;
    value.fail(ErrorCode::board_invalid,
               fmt::format("{} does not lie inside the copper at {}; move it, or draw the copper's edge round it",
                           named[hole.index].what, text_at(hole.ring.front())));
  }
  std::sort(holes.begin(), holes.end(), [](const FlatHole& a, const FlatHole& b) {
    return std::pair(a.box.min.x, a.index) < std::pair(b.box.min.x, b.index);
  });
  std::vector<std::size_t> active;
  for (std::size_t i = 0; i < holes.size(); ++i) {
    std::erase_if(active, [&](std::size_t k) { return holes[k].box.max.x < holes[i].box.min.x; });
    for (std::size_t k : active) {
      if (!holes[k].box.touches(holes[i].box)) continue;
      if (geometry::contact(holes[k].ring, holes[i].ring).kind == geometry::ContactKind::none &&
          !geometry::is_inside(holes[k].ring, holes[i].ring) && !geometry::is_inside(holes[i].ring, holes[k].ring))
        continue;
      const auto [first, second] = std::minmax(holes[k].index, holes[i].index);
      value.fail(ErrorCode::board_invalid,
                 fmt::format("{} and {} overlap or touch near {}; draw them as one hole (\"points\" or \"slot\")",
                             named[first].what, named[second].what, text_at(holes[i].ring.front())));
    }
    active.push_back(i);
  }
}

}  // namespace

Point read_point(const JsonValue& value, FileUnit unit) {
  if (!value.is(JsonKind::array) || value.size() != 2) value.fail("expected a point, [x, y]");
  auto it = value.begin();
  const Nm x = (*it).as_length(unit.mm);
  const Nm y = (*++it).as_length(unit.mm);
  return {x, y};
}

Nm read_positive(const JsonValue& value, FileUnit unit) {
  const Nm length = value.as_length(unit.mm);
  if (length <= 0)
    value.fail(ErrorCode::input_number, fmt::format("{} is no size; expected a length above 0", format_length(length)));
  return length;
}

Path read_path(const JsonValue& points, FileUnit unit, bool closed) {
  Path path;
  path.closed = closed;
  for (JsonValue entry : points.as_array()) {
    if (entry.is(JsonKind::array)) {
      path.points.push_back(read_point(entry, unit));
      continue;
    }
    entry.allow_only({"arc"});
    const JsonValue arc = entry.at("arc");
    if (path.points.empty()) entry.fail("a path can't begin with an arc: give the point it starts from first");
    if (arc.as_array().size() != 2) arc.fail("expected a point on the arc and its end, [[x, y], [x, y]]");
    auto it = arc.begin();
    path.arc_starts.push_back(static_cast<std::int32_t>(path.points.size()) - 1);
    path.points.push_back(read_point(*it, unit));
    path.points.push_back(read_point(*++it, unit));
  }
  if (path.points.empty()) points.fail("a path needs points");
  if (closed && path.points.size() > 1 && path.points.front() == path.points.back()) path.points.pop_back();
  return path;
}

Path circle_path(Point centre, Nm radius) {
  return {{{centre.x + radius, centre.y},
           {centre.x, centre.y + radius},
           {centre.x - radius, centre.y},
           {centre.x, centre.y - radius}},
          {0, 2},
          true};
}

bool has_area(const JsonValue& object) {
  return std::any_of(area_fields.begin(), area_fields.end(),
                     [&](std::string_view name) { return object.find(name).has_value(); });
}

Path read_area(const JsonValue& object, FileUnit unit) {
  std::optional<JsonValue> area;
  for (std::string_view name : area_fields) {
    const auto member = object.find(name);
    if (member && area) object.fail(fmt::format("'{}' and '{}' both give an area; keep one", area->key(), name));
    if (member) area = member;
  }
  if (!area) object.fail("the area is missing: give one of points, rect, circle or slot");
  Path path;
  if (area->key() == "points") {
    path = read_path(*area, unit, true);
  } else if (area->key() == "rect") {
    path = read_rect(*area, unit);
  } else if (area->key() == "circle") {
    area->allow_only({"at", "diameter"});
    const Nm diameter = read_positive(area->at("diameter"), unit);
    path = circle_path(read_point(area->at("at"), unit), diameter / 2);
  } else {
    path = read_slot(*area, unit);
  }
  const Ring ring = geometry::flatten(path, fine_chords);
  if (ring.size() < 3 || geometry::twice_area_nm2(ring) == 0) area->fail(ErrorCode::board_invalid, "encloses no area");
  return path;
}

Path cut_holes(Path outer, const std::vector<Hole>& holes, const JsonValue& value) {
  if (holes.empty()) return outer;
  const Ring outer_ring = geometry::flatten(outer, fine_chords);
  std::vector<FlatHole> flat;
  for (std::size_t i = 0; i < holes.size(); ++i) {
    Ring ring = geometry::flatten(holes[i].path, fine_chords);
    const geometry::Box box = geometry::bounds(ring);
    flat.push_back({std::move(ring), box, i});
  }
  require_holes_apart(outer_ring, flat, holes, value);

  const bool outer_turns_left = geometry::twice_area_nm2(outer_ring) > 0;
  const Contour rim = contour_of(outer);
  std::vector<std::vector<Contour>> slits(rim.size());  // holes by the corner of the rim they hang on
  for (std::size_t i = 0; i < holes.size(); ++i) {
    Contour hole = contour_of(holes[i].path);
    if ((geometry::twice_area_nm2(flat[i].ring) > 0) == outer_turns_left) reverse(hole);
    // The slit may cross anything: walked both ways it adds nothing to any winding number. Short ones cross less.
    double shortest = std::numeric_limits<double>::infinity();
    std::size_t on_rim = 0, on_hole = 0;
    for (std::size_t r = 0; r < rim.size(); ++r)
      for (std::size_t h = 0; h < hole.size(); ++h) {
        const double d =
            std::hypot(static_cast<double>(rim[r].at.x - hole[h].at.x), static_cast<double>(rim[r].at.y - hole[h].at.y));
        if (d < shortest) std::tie(shortest, on_rim, on_hole) = std::tuple(d, r, h);
      }
    std::rotate(hole.begin(), hole.begin() + static_cast<std::ptrdiff_t>(on_hole), hole.end());
    slits[on_rim].push_back(std::move(hole));
  }
  Path path;
  path.closed = true;
  for (std::size_t r = 0; r < rim.size(); ++r) {
    for (const Contour& hole : slits[r]) {
      append(path, {rim[r].at});
      for (const Corner& corner : hole) append(path, corner);
      append(path, {hole.front().at});
    }
    append(path, rim[r]);
  }
  return path;
}

}  // namespace pcbmesh::formats::native_json
