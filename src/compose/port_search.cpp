// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/compose/port_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pcbmesh::compose {
namespace {

using geometry::Point;

/// A plane is at least this many times as wide as the conductor over it.
constexpr double plane_over_conductor = 3;
/// Gaps wider than this are no gaps.
constexpr double widest_gap_nm = 3e6;
constexpr int samples_each_side = 8;

}  // namespace

Nm PortSearch::z_nm(std::int32_t face) const {
  return face < num_slabs() ? stack_.slabs[static_cast<std::size_t>(face)].z_bottom_nm : stack_.slabs.back().z_top_nm;
}

Faces PortSearch::faces_of(std::int32_t net, std::int32_t layer) const {
  const CopperPlace& place = stack_.copper[static_cast<std::size_t>(layer)];
  if (mode_of(study_, rules_, net, layer) == study::ConductorMode::sheet) return {place.sheet, place.sheet};
  return {place.low, place.high};
}

Reference PortSearch::look(const Terminals& nets, std::int32_t layer, const Section& section, int step) const {
  Reference found;
  const std::string where = step > 0 ? "below" : "above";
  if (const board::Drill* drill = copper_.drill_in(section)) {
    found.reason = fmt::format("a hole of net '{}' stands in its rectangle", board_.net_name(drill->net));
    return found;
  }
  for (std::int32_t other = layer + step; other >= 0 && other < num_layers(); other += step) {
    std::vector<std::int32_t> common, any;
    for (int k = -samples_each_side; k <= samples_each_side; ++k) {
      // A little beyond its ends: an edge of a port that runs along the edge of its plane ends in the air.
      const std::vector<std::int32_t> here = copper_.nets_at(other, section.at(k * 0.505 / samples_each_side));
      any.insert(any.end(), here.begin(), here.end());
      if (k == -samples_each_side)
        common = here;
      else
        std::erase_if(common, [&](std::int32_t net) { return !std::ranges::binary_search(here, net); });
    }
    std::erase(common, nets.positive);
    std::erase_if(common, [&](std::int32_t net) {
      if (nets.negative) return net != *nets.negative;
      return net < 0 || !copper_.has_plane(other, net, section.at(0), plane_over_conductor * section.width_nm);
    });
    if (!common.empty()) {
      const Faces mine = faces_of(nets.positive, layer), its = faces_of(common.front(), other);
      found.layer = other;
      found.net = common.front();
      found.distance_nm = step > 0 ? z_nm(mine.low) - z_nm(its.high) : z_nm(its.low) - z_nm(mine.high);
      return found;
    }
    if (!any.empty()) {
      found.reason = fmt::format("copper of net '{}' on {} {} it {}", board_.net_name(any.front()), board_.copper_name(other),
                                 where, nets.negative ? "is in between" : "covers its rectangle in part or is no plane");
      return found;
    }
  }
  found.reason = fmt::format("nothing lies {} it", where);
  return found;
}

References PortSearch::find_references(const Terminals& nets, std::int32_t layer, const Section& section) const {
  References found{look(nets, layer, section, +1), look(nets, layer, section, -1)};
  if (found.below.layer >= 0 || found.above.layer >= 0) return found;
  const std::string wanted = nets.negative ? fmt::format("net '{}'", board_.net_name(*nets.negative)) : std::string("a plane");
  found.below.reason = found.above.reason =
      fmt::format("no reference was found, {} that covers it: {}; {}. Move the port, name its reference, or take shape gap",
                  wanted, found.below.reason, found.above.reason);
  return found;
}

Reference PortSearch::find_reference(const Terminals& nets, std::int32_t layer, const Section& section) const {
  return find_references(nets, layer, section).nearest();
}

bool PortSearch::has_fills(std::int32_t net) const {
  return std::ranges::any_of(
      board_.shapes(), [&](const board::Shape& shape) { return shape.net == net && shape.kind == board::ShapeKind::fill; });
}

std::optional<GapPlace> PortSearch::gap_towards(const Terminals& nets, std::int32_t layer, Point p,
                                                std::array<double, 2> direction, double width_nm) const {
  const std::array<double, 2> across{-direction[1], direction[0]};
  double leave = 0, meet = 0;
  std::int32_t net = board::no_net;
  // Both edges must be straight over the whole width, or the port would be no rectangle.
  for (int k = -samples_each_side; k <= samples_each_side; ++k) {
    const double shift = k * 0.5 * width_nm / samples_each_side;
    const Point from{p.x + std::llround(across[0] * shift), p.y + std::llround(across[1] * shift)};
    if (!copper_.covers(layer, nets.positive, from)) return std::nullopt;
    const auto gap = copper_.gap_from(layer, nets.positive, from, direction, widest_gap_nm);
    // A line beside this one is no reference unless somebody says so.
    if (!gap || gap->net < 0 || (nets.negative ? gap->net != *nets.negative : !has_fills(gap->net))) return std::nullopt;
    if (k == -samples_each_side)
      leave = gap->leave_nm, meet = gap->meet_nm, net = gap->net;
    else if (gap->net != net || std::abs(gap->leave_nm - leave) > 2 || std::abs(gap->meet_nm - meet) > 2)
      return std::nullopt;
  }
  GapPlace place;
  place.net = net;
  const auto corner = [&](double along, double side) {
    return Point{p.x + std::llround(direction[0] * along + across[0] * side),
                 p.y + std::llround(direction[1] * along + across[1] * side)};
  };
  const double from = std::round(leave), to = std::round(meet), half = std::round(0.5 * width_nm);
  place.rectangle = {corner(from, -half), corner(to, -half), corner(to, half), corner(from, half)};
  geometry::make_counter_clockwise(place.rectangle);
  place.direction = {-direction[0], -direction[1], 0};
  place.length_nm = to - from;
  place.width_nm = 2 * half;
  const Point middle = corner(0.5 * (from + to), 0);
  place.middle_nm = {static_cast<double>(middle.x), static_cast<double>(middle.y)};
  return place;
}

GapPlace PortSearch::find_gap(const Terminals& nets, std::int32_t layer, Point p, const std::optional<Nm>& width) const {
  constexpr double least_width_nm = 20e3;
  constexpr std::array<std::array<double, 2>, 4> directions{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
  GapPlace best;
  for (const auto& direction : directions) {
    const auto section = copper_.pad_section(layer, nets.positive, p, std::array{-direction[1], direction[0]});
    double tried = width ? static_cast<double>(*width) : section ? section->width_nm : 0;
    for (; tried >= least_width_nm; tried *= width ? 0 : 0.7) {
      auto place = gap_towards(nets, layer, p, direction, tried);
      if (!place) continue;
      if (best.net == board::no_net || place->length_nm < best.length_nm) best = std::move(*place);
      break;
    }
  }
  if (best.net == board::no_net)
    best.reason = fmt::format(
        "no gap with two straight edges leads to {} on the same layer; give a point opposite the reference, or "
        "a smaller width",
        nets.negative ? fmt::format("net '{}'", board_.net_name(*nets.negative)) : "a net with filled areas");
  return best;
}

}  // namespace pcbmesh::compose
