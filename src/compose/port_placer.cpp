// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/compose/port_placer.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "src/compose/port_words.hpp"

namespace pcbmesh::compose {
namespace {

using geometry::Point;
using geometry::Ring;
using study::HullSide;

constexpr double nm_to_mm = 1e-6;
/// How far along the tracks that leave a pin a place is looked for.
constexpr double pin_reach_nm = 5e6;

Section with_width(Section section, const study::Port& wanted) {
  if (wanted.width) section.width_nm = static_cast<double>(*wanted.width);
  return section;
}

}  // namespace

std::string place_text(Point p) {
  return fmt::format("({:.6g}, {:.6g}) mm", static_cast<double>(p.x) * nm_to_mm, static_cast<double>(p.y) * nm_to_mm);
}

Outcome failed(std::string fault) {
  return {std::nullopt, std::move(fault)};
}

void describe(Placed& placed, const study::Port& wanted, const Terminals& nets, std::int32_t reference) {
  placed.port.name = wanted.name;
  placed.port.impedance_ohm = wanted.impedance_ohm;
  placed.port.is_excited = wanted.excited;
  placed.port.positive_net = nets.positive;
  placed.port.negative_net = reference;
  if (wanted.max_edge) placed.port.longest_edge_m = static_cast<double>(*wanted.max_edge) * metres_per_nm;
}

namespace {

/// Faces of a rectangle between two conductors, and its edges on them.
void measure_rectangle(model::Port& port) {
  port.area_m2 = port.length_m * port.width_m;
  port.positive_edge_m = port.negative_edge_m = port.width_m;
}

}  // namespace

Outcome PortPlacer::place(const study::Port& wanted) const {
  const Terminals nets{*board_.find_net(wanted.net),
                       wanted.reference.empty() ? std::nullopt : board_.find_net(wanted.reference)};
  if (wanted.at.side) return on_side(wanted, nets);
  return wanted.at.pin.empty() ? at_point(wanted, nets) : at_pin(wanted, nets);
}

std::optional<std::int32_t> PortPlacer::find_layer(const std::string& name) const {
  for (std::size_t i = 0; i < board_.copper_layers().size(); ++i) {
    const board::StackupLayer& layer = board_.stackup()[static_cast<std::size_t>(board_.copper_layers()[i])];
    if (layer.name == name || layer.user_name == name) return static_cast<std::int32_t>(i);
  }
  return std::nullopt;
}

std::string PortPlacer::net_text(std::int32_t net) const {
  return fmt::format("net '{}'", board_.net_name(net));
}

Outcome PortPlacer::at_pin(const study::Port& wanted, const Terminals& nets) const {
  const std::size_t dot = wanted.at.pin.rfind('.');
  const std::string component = wanted.at.pin.substr(0, dot);
  const std::string number = dot == std::string::npos ? "" : wanted.at.pin.substr(dot + 1);
  const board::Pin* pin = nullptr;
  const board::Pin* other = nullptr;
  std::vector<std::string> on_net;
  for (const board::Pin& candidate : board_.pins()) {
    if (candidate.net == nets.positive && on_net.size() < 6) on_net.push_back(candidate.component + "." + candidate.number);
    if (candidate.component != component || candidate.number != number) continue;
    (candidate.net == nets.positive ? pin : other) = &candidate;
  }
  const std::string hint = on_net.empty() ? std::string("the net has no pin; give a point")
                                          : fmt::format("pins of the net are {}", fmt::join(on_net, ", "));
  if (pin == nullptr && other != nullptr)
    return failed(fmt::format("pin {} at {} belongs to {}, not to {}; {}", wanted.at.pin, place_text(other->at),
                              net_text(other->net), net_text(nets.positive), hint));
  if (pin == nullptr) return failed(fmt::format("the board has no pin '{}'; {}", wanted.at.pin, hint));
  if (!footprint_.contains(pin->at))
    return failed(fmt::format("pin {} at {} lies outside the domain; grow the region's margin, or take another pin",
                              wanted.at.pin, place_text(pin->at)));
  if (wanted.shape == study::PortShape::coaxial) return coaxial(wanted, nets, pin->at);
  if (wanted.shape == study::PortShape::gap) return across_gap(wanted, nets, pin->copper_layer, pin->at);
  // In the middle of the pad; where a hole is in the way, on the track that leaves it.
  std::vector<Section> sections;
  if (const auto section = copper_.pad_section(pin->copper_layer, nets.positive, pin->at))
    sections.push_back(with_width(*section, wanted));
  for (std::int32_t layer = 0; layer < search_.num_layers(); ++layer) {
    if (layer != pin->copper_layer &&
        copper_.drill_in({{static_cast<double>(pin->at.x), static_cast<double>(pin->at.y)}, {1, 0}, 2}) == nullptr)
      continue;
    std::vector<Section> try_here = layer == pin->copper_layer ? sections : std::vector<Section>{};
    for (const Section& section : copper_.sections_away_from(layer, nets.positive, pin->at, pin_reach_nm))
      try_here.push_back(with_width(section, wanted));
    for (const Section& section : try_here)
      if (Outcome outcome = vertical(wanted, nets, layer, section); outcome.placed) return outcome;
  }
  if (sections.empty())
    return failed(fmt::format("pin {} at {} has no copper of {} on {}", wanted.at.pin, place_text(pin->at),
                              net_text(nets.positive), board_.copper_name(pin->copper_layer)));
  Outcome outcome = vertical(wanted, nets, pin->copper_layer, sections.front());
  if (wanted.shape == study::PortShape::automatic)
    if (Outcome gap = across_gap(wanted, nets, pin->copper_layer, pin->at); gap.placed) return gap;
  return outcome;
}

Outcome PortPlacer::at_point(const study::Port& wanted, const Terminals& nets) const {
  const Point p = *wanted.at.point;
  if (!footprint_.contains(p))
    return failed(fmt::format("{} lies outside the domain, {} to {}; move the port or grow the region", place_text(p),
                              place_text(footprint_.box.min), place_text(footprint_.box.max)));
  if (wanted.shape == study::PortShape::coaxial) return coaxial(wanted, nets, p);
  std::optional<std::int32_t> layer;
  if (!wanted.at.layer.empty()) {
    layer = find_layer(wanted.at.layer);
    if (!layer) return failed(fmt::format("no copper layer is called '{}'", wanted.at.layer));
  }
  std::vector<std::string> with_copper;
  for (std::int32_t i = 0; i < search_.num_layers(); ++i)
    if (copper_.covers(i, nets.positive, p)) with_copper.push_back(board_.copper_name(i));
  if (!layer && !with_copper.empty()) layer = find_layer(with_copper.front());
  if (!layer || !copper_.covers(*layer, nets.positive, p)) {
    return failed(with_copper.empty()
                      ? fmt::format("{} has no copper at {}; move the port onto it", net_text(nets.positive), place_text(p))
                      : fmt::format("{} has no copper on {} at {}, but on {}; name that layer", net_text(nets.positive),
                                    board_.copper_name(*layer), place_text(p), fmt::join(with_copper, ", ")));
  }
  if (wanted.shape == study::PortShape::gap) return across_gap(wanted, nets, *layer, p);
  const auto section = copper_.section_at(*layer, nets.positive, p);
  if (!section)
    return failed(fmt::format("the copper of {} at {} has no measurable width", net_text(nets.positive), place_text(p)));
  Outcome outcome = vertical(wanted, nets, *layer, with_width(*section, wanted));
  if (!outcome.placed && wanted.shape == study::PortShape::automatic)
    if (Outcome gap = across_gap(wanted, nets, *layer, p); gap.placed) return gap;
  return outcome;
}

Outcome PortPlacer::on_side(const study::Port& wanted, const Terminals& nets) const {
  if (footprint_.domain.size() != 1 || footprint_.domain.front().size() != 4)
    return failed("a port on a side needs a straight side: mesh a region, or give the board some air");
  const HullSide side = *wanted.at.side;
  const int axis = side == HullSide::xmin || side == HullSide::xmax ? 0 : 1;
  const geometry::Box& box = footprint_.box;
  const bool at_min = side == HullSide::xmin || side == HullSide::ymin;
  const Nm at = axis == 0 ? (at_min ? box.min.x : box.max.x) : (at_min ? box.min.y : box.max.y);
  const double low = static_cast<double>(axis == 0 ? box.min.y : box.min.x),
               high = static_cast<double>(axis == 0 ? box.max.y : box.max.x);
  struct Cut {
    std::int32_t layer;
    double from, to;
  };
  std::vector<Cut> cuts;
  for (std::int32_t layer = 0; layer < search_.num_layers(); ++layer) {
    if (!wanted.at.layer.empty() && find_layer(wanted.at.layer) != layer) continue;
    // Ten nanometres inside: an outline may run along the side itself.
    for (const auto& [from, to] : copper_.cuts(layer, nets.positive, axis, at + (at_min ? 10 : -10)))
      if (to > low && from < high) cuts.push_back({layer, std::max(from, low), std::min(to, high)});
  }
  const auto point_of = [&](double along) {
    return axis == 0 ? Point{at, std::llround(along)} : Point{std::llround(along), at};
  };
  if (cuts.empty())
    return failed(
        fmt::format("{} is not cut at {} ({} = {:.6g} mm), so the port would hang in the air; take a side that cuts the "
                    "net, a smaller margin, or a pin",
                    net_text(nets.positive), study::name_of(side), axis == 0 ? "x" : "y", static_cast<double>(at) * nm_to_mm));
  if (cuts.size() > 1) {
    std::string list;
    for (const Cut& cut : cuts)
      list += fmt::format("{}{} on {}", list.empty() ? "" : ", ", place_text(point_of(0.5 * (cut.from + cut.to))),
                          board_.copper_name(cut.layer));
    return failed(fmt::format("{} is cut {} times at {}: {}; name the layer, move the side, or give a point inside",
                              net_text(nets.positive), cuts.size(), study::name_of(side), list));
  }
  const Cut& cut = cuts.front();
  const double middle = 0.5 * (cut.from + cut.to);
  Section section{{static_cast<double>(point_of(middle).x), static_cast<double>(point_of(middle).y)},
                  axis == 0 ? std::array{0.0, 1.0} : std::array{1.0, 0.0},
                  cut.to - cut.from};
  return wanted.kind == study::PortKind::wave ? wave(wanted, nets, cut.layer, section, side)
                                              : vertical(wanted, nets, cut.layer, with_width(section, wanted));
}

/// Upright, between the net and the reference found above or below.
Outcome PortPlacer::vertical(const study::Port& wanted, const Terminals& nets, std::int32_t layer,
                             const Section& section) const {
  const Point middle = section.at(0);
  for (const Point p : {section.at(-0.5), section.at(0.5)})
    if (!footprint_.contains(p))
      return failed(fmt::format("its edge at {} lies outside the domain; move it inside or make it narrower", place_text(p)));
  for (int k = -16; k <= 16; ++k)
    if (!copper_.covers(layer, nets.positive, section.at(k * 0.499 / 16)))
      return failed(
          fmt::format("its rectangle, {:.4g} um wide at {}, leaves the copper of {} on {}; make it narrower or move it",
                      section.width_nm * 1e-3, place_text(middle), net_text(nets.positive), board_.copper_name(layer)));
  const Reference found = search_.find_reference(nets, layer, section);
  if (found.layer < 0)
    return failed(fmt::format("at {} on {}: {}", place_text(middle), board_.copper_name(layer), found.reason));
  const Faces net_faces = search_.faces_of(nets.positive, layer), reference_faces = search_.faces_of(found.net, found.layer);
  const bool is_above = net_faces.low >= reference_faces.high;
  Placed placed;
  describe(placed, wanted, nets, found.net);
  placed.first_slab = is_above ? reference_faces.high : net_faces.high;
  placed.last_slab = (is_above ? net_faces.low : reference_faces.low) - 1;
  const Nm bottom = search_.z_nm(placed.first_slab), top = search_.z_nm(placed.last_slab + 1);
  if (placed.last_slab < placed.first_slab || top <= bottom)
    return failed(fmt::format("nothing lies between {} and {} at {}; a port needs some height", board_.copper_name(layer),
                              board_.copper_name(found.layer), place_text(middle)));
  const Point a = section.at(-0.5), b = section.at(0.5);
  placed.port.line = {a, b};
  placed.footprint = {triangle_beside(a, b, section)};
  placed.port.direction = {0, 0, is_above ? 1.0 : -1.0};
  placed.port.length_m = static_cast<double>(top - bottom) * metres_per_nm;
  placed.port.width_m = std::hypot(static_cast<double>(b.x - a.x), static_cast<double>(b.y - a.y)) * metres_per_nm;
  placed.port.at_m = {section.middle_nm[0] * metres_per_nm, section.middle_nm[1] * metres_per_nm,
                      static_cast<double>(bottom + top) * 0.5 * metres_per_nm};
  measure_rectangle(placed.port);
  return {placed, ""};
}

/// Isosceles and flat, its base the port's line: two short edges more, at 45 degrees to the conductor's own. It lies inside
/// the domain where the line is on the hull.
Ring PortPlacer::triangle_beside(Point a, Point b, const Section& section) const {
  for (const double sign : {1.0, -1.0}) {
    const Point tip{std::llround(section.middle_nm[0] - sign * 0.5 * section.width_nm * section.along[1]),
                    std::llround(section.middle_nm[1] + sign * 0.5 * section.width_nm * section.along[0])};
    Ring ring{a, b, tip};
    geometry::make_counter_clockwise(ring);
    if (footprint_.contains(tip) || sign < 0) return ring;
  }
  return {};
}

/// Rectangle of the hull round the conductor that is cut there.
Outcome PortPlacer::wave(const study::Port& wanted, const Terminals& nets, std::int32_t layer, const Section& conductor,
                         HullSide side) const {
  const Point middle = conductor.at(0);
  const References found = search_.find_references(nets, layer, conductor);
  if (found.below.layer < 0 && found.above.layer < 0)
    return failed(fmt::format("at {} on {}: {}", place_text(middle), board_.copper_name(layer), found.below.reason));
  Placed placed;
  placed.port.is_wave = true;
  placed.first_slab = found.below.layer >= 0 ? search_.faces_of(found.below.net, found.below.layer).high : 0;
  placed.last_slab =
      (found.above.layer >= 0 ? search_.faces_of(found.above.net, found.above.layer).low : search_.num_slabs()) - 1;
  const Reference& nearest = found.nearest();
  const Faces net_faces = search_.faces_of(nets.positive, layer), reference = search_.faces_of(nearest.net, nearest.layer);
  const bool is_above = net_faces.low >= reference.high;
  const Nm spacing = is_above ? search_.z_nm(net_faces.low) - search_.z_nm(reference.high)
                              : search_.z_nm(reference.low) - search_.z_nm(net_faces.high);
  if (wanted.height && is_above)
    while (placed.last_slab > placed.first_slab &&
           search_.z_nm(placed.last_slab) >= search_.z_nm(placed.first_slab) + *wanted.height &&
           placed.last_slab > net_faces.high)
      --placed.last_slab;
  if (wanted.height && !is_above)
    while (placed.first_slab < placed.last_slab &&
           search_.z_nm(placed.first_slab + 1) <= search_.z_nm(placed.last_slab + 1) - *wanted.height &&
           placed.first_slab + 1 < net_faces.low)
      ++placed.first_slab;
  Section section = conductor;
  section.width_nm = wanted.width ? static_cast<double>(*wanted.width) : conductor.width_nm + 6 * static_cast<double>(spacing);
  const int axis = side == HullSide::xmin || side == HullSide::xmax ? 0 : 1;
  const double low = static_cast<double>(axis == 0 ? footprint_.box.min.y : footprint_.box.min.x),
               high = static_cast<double>(axis == 0 ? footprint_.box.max.y : footprint_.box.max.x);
  double& centre = section.middle_nm[axis == 0 ? 1 : 0];
  const double from = centre - 0.5 * section.width_nm, to = centre + 0.5 * section.width_nm;
  if (wanted.width && (from < low || to > high))
    return failed(
        fmt::format("its rectangle, {:.4g} mm wide at {}, reaches beyond the side; make it narrower or the region wider",
                    section.width_nm * nm_to_mm, place_text(middle)));
  const double kept_from = std::max(from, low), kept_to = std::min(to, high);
  centre = 0.5 * (kept_from + kept_to);
  section.width_nm = kept_to - kept_from;
  describe(placed, wanted, nets, nearest.net);
  const Point a = section.at(-0.5), b = section.at(0.5);
  placed.port.line = {a, b};
  const double depth = std::min(0.5 * section.width_nm, std::max(conductor.width_nm, 100.0 * nm_per_um));
  const double inwards = side == HullSide::xmin || side == HullSide::ymin ? depth : -depth;
  const auto moved = [&](Point p) {
    return axis == 0 ? Point{p.x + std::llround(inwards), p.y} : Point{p.x, p.y + std::llround(inwards)};
  };
  // An outline may run along the side itself.
  const auto inside = [&](Point p) {
    const Nm step = inwards > 0 ? 10 : -10;
    return axis == 0 ? Point{p.x + step, p.y} : Point{p.x, p.y + step};
  };
  Ring rectangle{a, b, moved(b), moved(a)};
  geometry::make_counter_clockwise(rectangle);
  placed.footprint = {std::move(rectangle)};
  const Nm bottom = search_.z_nm(placed.first_slab), top = search_.z_nm(placed.last_slab + 1);
  for (std::int32_t i = 0; i < search_.num_layers(); ++i) {
    if (search_.z_nm(search_.gap_face(i)) < bottom || search_.z_nm(search_.gap_face(i)) > top) continue;
    for (const Point end : {a, b})
      for (const std::int32_t net : copper_.nets_at(i, inside(end)))
        if (net != found.below.net && net != found.above.net)
          return failed(
              fmt::format("its edge at {} cuts the copper of {} on {}; choose its width so that it goes round each "
                          "conductor or leaves it out",
                          place_text(end), net_text(net), board_.copper_name(i)));
  }
  placed.port.direction = {0, 0, is_above ? 1.0 : -1.0};
  placed.port.length_m = static_cast<double>(top - bottom) * metres_per_nm;
  placed.port.width_m = section.width_nm * metres_per_nm;
  placed.port.at_m = {section.middle_nm[0] * metres_per_nm, section.middle_nm[1] * metres_per_nm,
                      static_cast<double>(bottom + top) * 0.5 * metres_per_nm};
  return {placed, ""};
}

/// Flat, across the gap to the reference on the same layer.
Outcome PortPlacer::across_gap(const study::Port& wanted, const Terminals& nets, std::int32_t layer, Point p) const {
  const GapPlace gap = search_.find_gap(nets, layer, p, wanted.width);
  if (gap.net == board::no_net)
    return failed(fmt::format("at {} on {}: {}", place_text(p), board_.copper_name(layer), gap.reason));
  Placed placed;
  describe(placed, wanted, nets, gap.net);
  placed.port.faces = model::PortFaces::cap;
  placed.port.face = search_.gap_face(layer);
  placed.first_slab = placed.last_slab = std::min(placed.port.face, search_.num_slabs() - 1);
  placed.footprint = {gap.rectangle};
  placed.port.direction = gap.direction;
  placed.port.length_m = gap.length_nm * metres_per_nm;
  placed.port.width_m = gap.width_nm * metres_per_nm;
  placed.port.line = {gap.rectangle[0], gap.rectangle[1]};
  placed.port.at_m = {gap.middle_nm[0] * metres_per_nm, gap.middle_nm[1] * metres_per_nm,
                      static_cast<double>(search_.z_nm(placed.port.face)) * metres_per_nm};
  measure_rectangle(placed.port);
  return {placed, ""};
}

bool overlap(const Placed& a, const Placed& b) {
  if (a.port.faces != b.port.faces) return false;
  if (a.port.faces == model::PortFaces::cap && a.port.face != b.port.face) return false;
  if (a.last_slab < b.first_slab || b.last_slab < a.first_slab) return false;
  geometry::Box first, second;
  const bool by_line = a.port.faces == model::PortFaces::wall;
  for (const Point p : by_line ? Ring(a.port.line.begin(), a.port.line.end()) : a.footprint.front()) first.add(p);
  for (const Point p : by_line ? Ring(b.port.line.begin(), b.port.line.end()) : b.footprint.front()) second.add(p);
  if (!by_line) return first.touches(second);
  // Lines of two ports touch where they cross or lie in one another.
  const auto side = [](const std::array<Point, 2>& line, Point p) { return geometry::orientation(line[0], line[1], p); };
  if (!first.touches(second)) return false;
  const int a0 = side(b.port.line, a.port.line[0]), a1 = side(b.port.line, a.port.line[1]);
  const int b0 = side(a.port.line, b.port.line[0]), b1 = side(a.port.line, b.port.line[1]);
  return a0 * a1 <= 0 && b0 * b1 <= 0;
}

}  // namespace pcbmesh::compose
