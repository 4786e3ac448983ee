// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/kicad/graphics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace pcbmesh::formats::kicad {
namespace {

using board::ShapeKind;
using syntax::Sexpr;

constexpr std::array<std::string_view, 6> graphic_kinds{"line", "arc", "circle", "rect", "poly", "curve"};
constexpr std::array<std::string_view, 19> graphic_words{"start",
                                                         "mid",
                                                         "end",
                                                         "center",
                                                         "pts",
                                                         "width",
                                                         "stroke",
                                                         "fill",
                                                         "layer",
                                                         "layers",
                                                         "net",
                                                         "net_name",
                                                         "uuid",
                                                         "tstamp",
                                                         "status",
                                                         "locked",
                                                         "angle",
                                                         "radius",
                                                         "solder_mask_margin"};

double pen_of(const Reading& reading, Sexpr item) {
  const Sexpr stroke = item.child("stroke");
  if (stroke) return std::max(0.0, reading.number_of(stroke, "width").value_or(0));
  return std::max(0.0, reading.number_of(item, "width").value_or(0));
}

/// (fill yes|solid|no|none|hatch..). Without the token polygons are filled, and so are rectangles and circles with width 0:
/// that is how old files say it.
bool filled_of(Reading& reading, Sexpr item, std::string_view kind, double pen) {
  const Sexpr fill = item.child("fill");
  if (!fill) return kind == "poly" || pen == 0;
  const Sexpr value = fill.arg(0).is_list() ? fill.arg(0).arg(0) : fill.arg(0);  // early 5.99: (fill (type solid))
  const std::string_view word = value.raw();
  if (word == "yes" || word == "solid") return true;
  if (word.find("hatch") != std::string_view::npos && reading.copper_of(item) != 0)
    reading.warn("kicad.hatched_graphic", "hatched fill of a drawing on copper is not read; only its outline is copper", item);
  return false;
}

Outlined arc_of(Reading& reading, Sexpr item) {
  const Sexpr mid = item.child("mid"), angle = item.child("angle");
  if (mid) return arc_by_points(reading.vec_of(item, "start"), reading.vec(mid), reading.vec_of(item, "end"));
  // Before 20210925: "start" is the centre and "end" the start of the arc.
  return arc_by_angle(reading.vec_of(item, "start"), reading.vec_of(item, "end"), angle ? reading.number(angle.arg(0)) : 0);
}

void add_edge(Reading& reading, const Outlined& drawn, const Placement& place, Sexpr item) {
  reading.edges.push_back({reading.path(drawn, place, item), item.line()});
}

}  // namespace

bool is_graphic(std::string_view head) {
  if (!head.starts_with("gr_") && !head.starts_with("fp_")) return false;
  return std::find(graphic_kinds.begin(), graphic_kinds.end(), head.substr(3)) != graphic_kinds.end();
}

void append_points(Reading& reading, Sexpr pts, Outlined& out) {
  for (const Sexpr part : pts) {
    if (!part.is_list()) continue;
    if (part.head() == "xy") {
      out.points.push_back(reading.vec(part));
    } else if (part.head() == "arc") {
      const Vec start = reading.vec_of(part, "start");
      if (out.points.empty() || !(out.points.back() == start)) out.points.push_back(start);
      out.arc_to(reading.vec_of(part, "mid"), reading.vec_of(part, "end"));
    } else {
      reading.count_unknown_list(part);
    }
  }
}

Outlined drawn_by(Reading& reading, Sexpr item) {
  const std::string_view kind = item.head().substr(3);
  const double pen = pen_of(reading, item);
  Outlined drawn;
  if (kind == "line") {
    drawn.points = {reading.vec_of(item, "start"), reading.vec_of(item, "end")};
    if (drawn.points[0] == drawn.points[1]) drawn.points.pop_back();
  } else if (kind == "arc") {
    drawn = arc_of(reading, item);
  } else if (kind == "circle") {
    const Vec centre = reading.vec_of(item, "center"), rim = reading.vec_of(item, "end");
    const double radius = std::hypot(rim.x - centre.x, rim.y - centre.y);
    if (radius > 0)
      drawn = circle(centre, radius);
    else
      drawn.points = {centre};
  } else if (kind == "rect") {
    drawn =
        rectangle(reading.vec_of(item, "start"), reading.vec_of(item, "end"), reading.number_of(item, "radius").value_or(0));
  } else if (kind == "poly") {
    append_points(reading, item.child("pts"), drawn);
    drawn.closed = drawn.points.size() > 2;
  } else {
    Outlined control;
    append_points(reading, item.child("pts"), control);
    if (control.points.size() == 4) {
      const Vec c[4] = {control.points[0], control.points[1], control.points[2], control.points[3]};
      append_bezier(drawn.points, c, curve_tolerance_mm);
    } else {
      reading.warn("kicad.curve_points", "curve without exactly four control points; skipped", item);
    }
  }
  drawn.pen = pen;
  drawn.filled = drawn.closed && filled_of(reading, item, kind, pen);
  return drawn;
}

void read_graphic(Reading& reading, const Placement& place, Sexpr item) {
  if (Reading::is_on(item, "Edge.Cuts")) {
    reading.count_unknown(item, graphic_words);
    const Outlined drawn = drawn_by(reading, item);
    if (drawn.points.size() > 1) add_edge(reading, drawn, place, item);
    return;
  }
  const LayerMask copper = reading.copper_of(item);
  if (copper == 0) return;
  reading.count_unknown(item, graphic_words);
  const Outlined drawn = drawn_by(reading, item);
  if (drawn.points.empty()) return;
  const std::size_t before = reading.parts.shapes.size();
  const std::int32_t net = reading.net_of(item);
  reading.add_copper(ShapeKind::graphic, copper, net, reading.figure(drawn, place, item), item);
  if (net == board::no_net && item.head().starts_with("gr_"))
    for (std::size_t i = before; i < reading.parts.shapes.size(); ++i) reading.loose_drawings.push_back(i);
}

void skip_annotation(Reading& reading, Sexpr item) {
  if (Reading::flag(item, "hide") || Reading::flag(item.child("effects"), "hide") || reading.copper_of(item) == 0) return;
  const Sexpr at = item.child("at");
  const std::string_view head = item.head();
  Spot spot = reading.spot(item);
  spot.layer = item.child("layer").arg(0).text();
  if (at && !head.starts_with("fp_") && head != "property") {
    const Vec place = reading.vec(at);
    spot.at_mm = {place.x, -place.y};
  }
  if (head.find("text") != std::string_view::npos || head == "property" || head == "table")
    reading.diagnostics.warn("kicad.text_on_copper", "text on a copper layer is not read; the copper of its letters is missing",
                             std::move(spot));
  else
    reading.diagnostics.warn("kicad.annotation_on_copper",
                             "dimension, target, barcode or image on a copper layer is not read; its copper is missing",
                             std::move(spot));
}

}  // namespace pcbmesh::formats::kicad
