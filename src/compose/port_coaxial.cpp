// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "src/compose/antipad.hpp"
#include "src/compose/port_placer.hpp"
#include "src/compose/port_words.hpp"

namespace pcbmesh::compose {
namespace {

using geometry::Point;
using geometry::Ring;

double perimeter_m(const Ring& ring) {
  double sum = 0;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++)
    sum += std::hypot(static_cast<double>(ring[i].x - ring[j].x), static_cast<double>(ring[i].y - ring[j].y));
  return sum * metres_per_nm;
}

/// Plated hole of the net nearest to a point, within its own diameter.
const board::Drill* hole_at(const board::Board& board, std::int32_t net, Point p) {
  const board::Drill* nearest = nullptr;
  double least = 0;
  for (const board::Drill& drill : board.drills()) {
    if (!drill.plated || drill.net != net || drill.figure.path.points.empty()) continue;
    const Point c = drill.figure.path.points.front();
    const double apart = std::hypot(static_cast<double>(c.x - p.x), static_cast<double>(c.y - p.y));
    if (apart > static_cast<double>(drill.figure.pen) || (nearest != nullptr && apart >= least)) continue;
    nearest = &drill;
    least = apart;
  }
  return nearest;
}

}  // namespace

Outcome PortPlacer::coaxial(const study::Port& wanted, const Terminals& nets, Point p) const {
  const board::Drill* hole = hole_at(board_, nets.positive, p);
  if (hole == nullptr)
    return failed(fmt::format("{} has no plated hole at {}; give a point on one of its vias, or a pin in a hole",
                              net_text(nets.positive), place_text(p)));
  const Point centre = hole->figure.path.points.front();
  if (hole->figure.path.points.size() != 1)
    return failed(fmt::format("the hole at {} is a slot; a coaxial port needs a round hole", place_text(centre)));
  std::vector<std::int32_t> layers;
  if (!wanted.at.layer.empty()) {
    layers.push_back(find_layer(wanted.at.layer).value_or(-1));
    if (layers.front() < hole->first_copper || layers.front() > hole->last_copper)
      return failed(fmt::format("the hole at {} does not reach {}; it passes {} to {}", place_text(centre), wanted.at.layer,
                                board_.copper_name(hole->first_copper), board_.copper_name(hole->last_copper)));
  } else {
    for (std::int32_t layer = hole->first_copper; layer <= hole->last_copper; ++layer) layers.push_back(layer);
  }
  std::vector<std::string> reasons, names;
  std::int32_t layer = -1;
  Antipad antipad;
  for (const std::int32_t candidate : layers) {
    Antipad here = find_antipad(board_, arcs_, *hole, candidate, nets.negative);
    if (!here.reason.empty()) {
      reasons.push_back(fmt::format("on {} {}", board_.copper_name(candidate), here.reason));
      continue;
    }
    names.emplace_back(board_.copper_name(candidate));
    layer = candidate;
    antipad = std::move(here);
  }
  if (names.empty())
    return failed(
        fmt::format("no round antipad is about the hole at {}: {}. Name another via, layer or reference, or take a "
                    "port on the track",
                    place_text(centre), fmt::join(reasons, "; ")));
  if (names.size() > 1)
    return failed(fmt::format("planes surround the hole at {} on {}; name the layer of one of them (at.layer)",
                              place_text(centre), fmt::join(names, ", ")));
  for (const Point corner : antipad.outer)
    if (!footprint_.box.contains(corner))
      return failed(
          fmt::format("its antipad at {} reaches beyond the domain; move the side or take another via", place_text(centre)));
  Placed placed;
  describe(placed, wanted, nets, antipad.net);
  model::Port& port = placed.port;
  port.is_coaxial = true;
  port.faces = model::PortFaces::cap;
  port.face = search_.gap_face(layer);
  placed.first_slab = placed.last_slab = std::min(port.face, search_.num_slabs() - 1);
  port.direction = {0, 0, 0};
  port.length_m = (antipad.outer_radius_nm - antipad.inner_radius_nm) * metres_per_nm;
  port.width_m = 2 * std::numbers::pi * port.length_m / std::log(antipad.outer_radius_nm / antipad.inner_radius_nm);
  constexpr double m2_per_mm2 = 1e-6;
  port.area_m2 = (geometry::area_mm2(antipad.outer) - geometry::area_mm2(antipad.inner)) * m2_per_mm2;
  port.positive_edge_m = perimeter_m(antipad.inner);
  port.negative_edge_m = perimeter_m(antipad.outer);
  port.at_m = {static_cast<double>(centre.x) * metres_per_nm, static_cast<double>(centre.y) * metres_per_nm,
               static_cast<double>(search_.z_nm(port.face)) * metres_per_nm};
  std::ranges::reverse(antipad.inner);
  placed.footprint = {std::move(antipad.outer), std::move(antipad.inner)};
  return {placed, ""};
}

}  // namespace pcbmesh::compose
