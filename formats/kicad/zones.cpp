// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/kicad/zones.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "formats/kicad/graphics.hpp"

namespace pcbmesh::formats::kicad {
namespace {

using board::ShapeKind;
using syntax::Sexpr;

constexpr std::int64_t fills_not_stroked = 20220211;
constexpr double default_min_thickness_mm = 0.254;
constexpr std::array<std::string_view, 22> zone_words{"net",
                                                      "net_name",
                                                      "layer",
                                                      "layers",
                                                      "uuid",
                                                      "tstamp",
                                                      "name",
                                                      "hatch",
                                                      "priority",
                                                      "attr",
                                                      "connect_pads",
                                                      "min_thickness",
                                                      "filled_areas_thickness",
                                                      "fill",
                                                      "polygon",
                                                      "filled_polygon",
                                                      "fill_segments",
                                                      "keepout",
                                                      "placement",
                                                      "locked",
                                                      "property",
                                                      "status"};

/// Layers of a fill: its own, or the zone's.
LayerMask layers_of(Reading& reading, Sexpr fill, LayerMask zone_layers) {
  return fill.child("layer") || fill.child("layers") ? reading.copper_of(fill) : zone_layers;
}

void add_fill_segments(Reading& reading, Sexpr list, LayerMask copper, std::int32_t net, double width) {
  for (const Sexpr pts : list) {
    if (!pts.is_list() || pts.head() == "layer") continue;
    Outlined drawn;
    append_points(reading, pts, drawn);
    drawn.pen = width;
    if (drawn.points.size() == 2 && drawn.points[0] == drawn.points[1]) drawn.points.pop_back();
    if (!drawn.points.empty()) reading.add_copper(ShapeKind::fill, copper, net, reading.figure(drawn, Placement{}, pts), pts);
  }
}

void report_unfilled(Reading& reading, Sexpr zone, LayerMask copper, std::int32_t net, bool was_filled) {
  Spot spot = reading.spot(zone);
  for (int i = 0; i < reading.layers.num_copper() && spot.layer.empty(); ++i)
    if ((copper >> i & 1) != 0) spot.layer = reading.layers.copper(i).name;
  if (net >= 0) spot.net = reading.parts.nets[static_cast<std::size_t>(net)];
  const Sexpr corner = zone.child("polygon").child("pts").child("xy");
  if (corner) {
    const Vec place = reading.vec(corner);
    spot.at_mm = {place.x, -place.y};
  }
  if (was_filled)
    reading.diagnostics.note("kicad.empty_zone", "zone whose fill came out empty; it gives no copper", std::move(spot));
  else
    reading.diagnostics.warn(
        "kicad.unfilled_zone",
        "zone was never filled: its copper is missing. Fill all zones in KiCad (key B), save and read again", std::move(spot));
}

}  // namespace

void read_zone(Reading& reading, Sexpr zone) {
  reading.count_unknown(zone, zone_words);
  if (zone.child("keepout")) return;
  const LayerMask copper = reading.copper_of(zone);
  if (copper == 0) return;
  const std::int32_t net = reading.net_of(zone);
  const double min_thickness = std::max(0.0, reading.number_of(zone, "min_thickness").value_or(default_min_thickness_mm));
  const bool stroked = reading.version < fills_not_stroked &&
                       (!zone.child("filled_areas_thickness") || Reading::flag(zone, "filled_areas_thickness"));
  bool has_fill = false;
  for (const Sexpr part : zone) {
    if (!part.is_list()) continue;
    if (part.head() == "filled_polygon") {
      Outlined drawn;
      append_points(reading, part.child("pts"), drawn);
      has_fill = true;
      if (drawn.points.size() < 3) {
        reading.warn("kicad.no_area", "fill of fewer than three points; skipped", part);
        continue;
      }
      drawn.closed = drawn.filled = true;
      drawn.pen = stroked ? min_thickness : 0;
      reading.add_copper(ShapeKind::fill, layers_of(reading, part, copper), net, reading.figure(drawn, Placement{}, part),
                         part);
    } else if (part.head() == "fill_segments") {
      has_fill = true;
      add_fill_segments(reading, part, layers_of(reading, part, copper), net, min_thickness);
    }
  }
  if (!has_fill) report_unfilled(reading, zone, copper, net, zone.child("fill").has_word("yes"));
}

}  // namespace pcbmesh::formats::kicad
