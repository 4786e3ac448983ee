// SPDX-License-Identifier: GPL-3.0-or-later
// Pads, vias, holes, and the antipads they cut into planes.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "formats/native_json/board_reader.hpp"
#include "formats/native_json/disc_union.hpp"
#include "pcbmesh/base/error.hpp"
#include "pcbmesh/geometry/ring_contact.hpp"

namespace pcbmesh::formats::native_json {
namespace {

using geometry::Point;
using syntax::JsonKind;
using syntax::JsonValue;

/// Cosine and sine, exact for quarter turns.
std::array<double, 2> direction(double degrees) {
  const double quarters = degrees / 90;
  if (quarters == std::floor(quarters)) {
    constexpr std::array<std::array<double, 2>, 4> exact{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
    const double turn = std::fmod(quarters, 4);
    return exact[static_cast<std::size_t>(turn < 0 ? turn + 4 : turn)];
  }
  const double radians = degrees * std::numbers::pi / 180;
  return {std::cos(radians), std::sin(radians)};
}

geometry::Figure pad_figure(Point at, Nm width, Nm height, std::size_t form, double degrees) {
  const auto [c, s] = direction(degrees);
  const auto placed = [&, c = c, s = s](double x, double y) {
    return Point{at.x + std::llround(x * c - y * s), at.y + std::llround(x * s + y * c)};
  };
  const double w = static_cast<double>(width) / 2, h = static_cast<double>(height) / 2;
  if (form == 1) return geometry::polygon({placed(-w, -h), placed(w, -h), placed(w, h), placed(-w, h)});
  if (width == height) return geometry::disc(at, width);
  if (width > height) return geometry::segment(placed(h - w, 0), placed(w - h, 0), height);
  return geometry::segment(placed(0, w - h), placed(0, h - w), width);
}

/// Largest distance of a figure's edge from a point.
Nm reach(const geometry::Figure& figure, Point from) {
  double farthest = 0;
  for (Point p : geometry::flatten(figure.path, {nm_per_um, geometry::ArcMode::inscribed}))
    farthest = std::max(farthest, std::hypot(static_cast<double>(p.x - from.x), static_cast<double>(p.y - from.y)));
  return static_cast<Nm>(std::ceil(farthest)) + (figure.pen + 1) / 2;
}

Point middle(const geometry::Figure& figure) {
  const geometry::Box box = geometry::bounds(figure);
  return {box.min.x + (box.max.x - box.min.x) / 2, box.min.y + (box.max.y - box.min.y) / 2};
}

}  // namespace

void BoardReader::read_pad(const JsonValue& object) {
  object.allow_only({"layer", "net", "at", "size", "shape", "rotation", "component", "pin", "note"});
  board::Shape shape{.copper_layer = copper_layer(object.at("layer")),
                     .net = net_of(object),
                     .kind = board::ShapeKind::pad,
                     .figure = {},
                     .line = object.line()};
  const Point at = read_point(object.at("at"), unit_);
  const JsonValue size = object.at("size");
  const bool is_pair = size.is(JsonKind::array);
  if (is_pair && size.size() != 2) size.fail("expected a diameter, or [width, height]");
  Nm width = 0, height = 0;
  if (is_pair) {
    auto it = size.begin();
    width = read_positive(*it, unit_);
    height = read_positive(*++it, unit_);
  } else {
    width = height = read_positive(size, unit_);
  }
  enum : std::size_t { circle, rect, oval };
  std::size_t form = is_pair ? rect : circle;
  if (const auto word = object.find("shape")) {
    constexpr std::array<std::string_view, 3> forms{"circle", "rect", "oval"};
    const auto found = std::find(forms.begin(), forms.end(), word->as_string());
    if (found == forms.end())
      word->fail(fmt::format("unknown pad shape '{}'; choices are circle, rect, oval", word->as_string().substr(0, 60)));
    form = static_cast<std::size_t>(found - forms.begin());
    if (form == circle && width != height) word->fail("a circle has one diameter; take oval for two sizes");
  }
  double degrees = 0;
  if (const auto rotation = object.find("rotation")) {
    degrees = rotation->as_number();
    if (std::abs(degrees) > 360) rotation->fail(ErrorCode::input_number, "expected an angle from -360 to 360 degrees");
  }
  shape.figure = pad_figure(at, width, height, form, degrees);
  const auto component = object.find("component"), pin = object.find("pin");
  if (component.has_value() != pin.has_value()) object.fail("component and pin belong together; give both or neither");
  if (component)
    parts_.pins.push_back(
        {std::string(component->as_string()), std::string(pin->as_string()), shape.net, at, shape.copper_layer});
  parts_.shapes.push_back(std::move(shape));
}

void BoardReader::read_via_pads(const JsonValue& pad, Piercing& piercing, Point at, std::int64_t line) {
  const auto add = [&](std::int32_t layer, Nm diameter, const JsonValue& value) {
    if (layer < piercing.first_copper || layer > piercing.last_copper)
      value.fail(ErrorCode::board_invalid, "this layer is outside the via's span");
    piercing.pads[layer] = diameter;
    parts_.shapes.push_back({.copper_layer = layer,
                             .net = piercing.net,
                             .kind = board::ShapeKind::via,
                             .figure = geometry::disc(at, diameter),
                             .line = line});
  };
  if (pad.is(JsonKind::object)) {
    for (JsonValue entry : pad) {
      const auto layer = std::find(copper_names_.begin(), copper_names_.end(), entry.key());
      if (layer == copper_names_.end()) entry.fail(ErrorCode::board_invalid, "no copper layer has this name");
      add(static_cast<std::int32_t>(layer - copper_names_.begin()), read_positive(entry, unit_), entry);
    }
    return;
  }
  const Nm diameter = read_positive(pad, unit_);
  for (std::int32_t layer = piercing.first_copper; layer <= piercing.last_copper; ++layer) add(layer, diameter, pad);
}

void BoardReader::read_via(const JsonValue& object) {
  object.allow_only({"at", "drill", "pad", "layers", "net", "antipad", "note"});
  Piercing piercing;
  piercing.what = fmt::format("the antipad of {}", object.pointer());
  piercing.line = object.line();
  piercing.net = net_of(object);
  std::tie(piercing.first_copper, piercing.last_copper) = span_of(object);
  const JsonValue drill = object.at("drill");
  const auto at = object.find("at");
  if (drill.is(JsonKind::object)) {
    drill.allow_only({"points", "rect", "circle", "slot", "note"});
    piercing.drill = {read_area(drill, unit_), 0, true};
  } else {
    piercing.drill = geometry::disc(read_point(object.at("at"), unit_), read_positive(drill, unit_));
  }
  const Point centre = at ? read_point(*at, unit_) : middle(piercing.drill);
  if (const auto antipad = object.find_set("antipad")) {
    piercing.antipad = antipad->as_length(unit_.mm);
    if (*piercing.antipad < 0) antipad->fail(ErrorCode::input_number, "an antipad's diameter can't be negative; 0 means none");
  }
  if (const auto pad = object.find_set("pad")) read_via_pads(*pad, piercing, centre, object.line());
  parts_.drills.push_back({.figure = piercing.drill,
                           .first_copper = piercing.first_copper,
                           .last_copper = piercing.last_copper,
                           .plated = true,
                           .net = piercing.net,
                           .kind = board::ShapeKind::via,
                           .line = object.line()});
  piercings_.push_back(std::move(piercing));
}

void BoardReader::read_hole(const JsonValue& object) {
  object.allow_only({"at", "to", "diameter", "layers", "antipad", "note"});
  Piercing piercing;
  piercing.what = fmt::format("the antipad of {}", object.pointer());
  piercing.line = object.line();
  std::tie(piercing.first_copper, piercing.last_copper) = span_of(object);
  const Point at = read_point(object.at("at"), unit_);
  const Nm diameter = read_positive(object.at("diameter"), unit_);
  const auto to = object.find_set("to");
  piercing.drill = to ? geometry::segment(at, read_point(*to, unit_), diameter) : geometry::disc(at, diameter);
  if (const auto antipad = object.find_set("antipad")) {
    piercing.antipad = antipad->as_length(unit_.mm);
    if (*piercing.antipad < 0) antipad->fail(ErrorCode::input_number, "an antipad's diameter can't be negative; 0 means none");
  }
  parts_.drills.push_back({.figure = piercing.drill,
                           .first_copper = piercing.first_copper,
                           .last_copper = piercing.last_copper,
                           .plated = false,
                           .net = board::no_net,
                           .kind = board::ShapeKind::pad,
                           .line = object.line()});
  piercings_.push_back(std::move(piercing));
}

void BoardReader::add_antipads(const JsonValue& plane, std::int32_t layer, std::int32_t net, Nm clearance,
                               const geometry::Path& area, std::vector<Hole>& holes) const {
  constexpr geometry::ArcOptions fine_chords{nm_per_um, geometry::ArcMode::inscribed};
  const geometry::Ring rim = geometry::flatten(area, fine_chords);
  std::vector<geometry::Ring> drawn;
  for (const Hole& hole : holes) drawn.push_back(geometry::flatten(hole.path, fine_chords));
  const auto lies_in = [](const geometry::Ring& ring, const geometry::Ring& hole) {
    return geometry::contact(ring, hole).kind == geometry::ContactKind::none && geometry::is_inside(ring, hole);
  };

  std::vector<Disc> discs;
  std::vector<const Piercing*> owners;
  for (const Piercing& piercing : piercings_) {
    if (layer < piercing.first_copper || layer > piercing.last_copper) continue;
    if ((piercing.net == net && net != board::no_net) || piercing.antipad == 0) continue;
    const Point centre = middle(piercing.drill);
    Nm radius = reach(piercing.drill, centre);
    if (const auto pad = piercing.pads.find(layer); pad != piercing.pads.end())
      radius = std::max(radius, (pad->second + 1) / 2);
    // A hole drawn round the via is its antipad.
    const geometry::Ring metal = geometry::flatten(circle_path(centre, radius), fine_chords);
    if (std::any_of(drawn.begin(), drawn.end(), [&](const geometry::Ring& hole) { return lies_in(metal, hole); })) continue;
    radius = piercing.antipad ? *piercing.antipad / 2 : radius + clearance;
    const geometry::Ring ring = geometry::flatten(circle_path(centre, radius), fine_chords);
    // Beside the plane there is nothing to cut.
    if (geometry::contact(ring, rim).kind == geometry::ContactKind::none && !geometry::is_inside(ring, rim) &&
        !geometry::is_inside(rim, ring))
      continue;
    discs.push_back({centre, radius});
    owners.push_back(&piercing);
  }
  for (DiscCluster& cluster : unite(discs)) {
    const Piercing& first = *owners[cluster.members.front()];
    if (!cluster.path)
      plane.fail(
          ErrorCode::board_invalid,
          fmt::format(
              "{} and its neighbours overlap so that three circles meet in one point; change one diameter a little, or draw "
              "one hole round them",
              first.what));
    holes.push_back({std::move(*cluster.path), first.what, first.line});
  }
}

}  // namespace pcbmesh::formats::native_json
