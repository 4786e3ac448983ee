// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/compose/bodies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "pcbmesh/geometry/ring_contact.hpp"

namespace pcbmesh::compose {
namespace {

using board::Board;
using geometry::Ring;
using model::Body;
using model::BodyKind;
using model::BodyShape;
using model::ModelParts;

/// Rings of a figure, clipped; a convex ring stays simple when clipped, another keeps its mark.
BodyShape shape_of(const geometry::Figure& figure, const study::Study& study, const Footprint& footprint, std::int64_t line) {
  BodyShape shape;
  shape.line = line;
  for (Ring& ring : geometry::outline(figure, study.arcs, shape.simple))
    if (Ring kept = clipped(std::move(ring), footprint.clip); kept.size() >= 3) shape.rings.push_back(std::move(kept));
  return shape;
}

std::string_view short_net_name(const Board& board, std::int32_t net) {
  return net < 0 ? std::string_view("none") : board.net_name(net);
}

/// Groups shapes by key in ascending order, so that bodies come out in one order whatever the file's.
template <class Key>
using Grouped = std::map<Key, std::vector<BodyShape>>;

void append_body(ModelParts& parts, Body body, std::vector<BodyShape> shapes) {
  const auto index = static_cast<std::int32_t>(parts.bodies.size());
  parts.bodies.push_back(std::move(body));
  for (BodyShape& shape : shapes) {
    shape.body = index;
    parts.shapes.push_back(std::move(shape));
  }
}

/// Least width of a convex ring: over all edges, the farthest corner from the edge's line. 0 for others.
Nm convex_width(const Ring& ring) {
  constexpr std::size_t most_corners = 256;  // quadratic; anything rounder is no pad
  if (ring.size() < 3 || ring.size() > most_corners) return 0;
  double least = -1;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const geometry::Point a = ring[i], b = ring[(i + 1) % ring.size()];
    const double dx = static_cast<double>(b.x - a.x), dy = static_cast<double>(b.y - a.y);
    double farthest = 0;
    for (geometry::Point p : ring)
      farthest = std::max(farthest, std::abs(dx * static_cast<double>(p.y - a.y) - dy * static_cast<double>(p.x - a.x)));
    const double width = farthest / std::sqrt(dx * dx + dy * dy);
    if (least < 0 || width < least) least = width;
  }
  return static_cast<Nm>(std::llround(least));
}

/// Width that the copper of a figure has at its narrowest; 0 = not known.
Nm width_of(const geometry::Figure& figure) {
  if (!figure.filled) return figure.pen;
  bool simple = true;
  const std::vector<Ring> rings = geometry::outline({figure.path, 0, true}, {}, simple);
  if (!simple || rings.empty()) return 0;
  const Nm inner = convex_width(rings.front());
  return inner == 0 ? 0 : inner + figure.pen;
}

}  // namespace

study::ConductorMode mode_of(const study::Study& study, const std::vector<ResolvedRule>& rules, std::int32_t net,
                             std::int32_t copper_layer) {
  study::ConductorMode mode = study.conductors;
  for (const ResolvedRule& rule : rules) {
    if (!rule.any_net && rule.net != net) continue;
    if (!rule.any_layer && rule.copper_layer != copper_layer) continue;
    mode = rule.mode;
  }
  return copper_layer < 0 && mode == study::ConductorMode::sheet ? study::ConductorMode::hollow : mode;
}

std::vector<char> find_sheet_layers(const Board& board, const study::Study& study, const std::vector<ResolvedRule>& rules,
                                    const Footprint& footprint) {
  const std::size_t num_layers = board.copper_layers().size(), num_nets = board.nets().size() + 1;
  std::vector<char> has_copper(num_layers, 0), only_sheets(num_layers, 1), seen(num_layers * num_nets, 0);
  for (const board::Shape& shape : board.shapes()) {
    const auto layer = static_cast<std::size_t>(shape.copper_layer);
    char& met = seen[layer * num_nets + static_cast<std::size_t>(shape.net + 1)];
    if (met || !geometry::bounds(shape.figure).touches(footprint.box)) continue;
    met = has_copper[layer] = 1;
    if (mode_of(study, rules, shape.net, shape.copper_layer) != study::ConductorMode::sheet) only_sheets[layer] = 0;
  }
  constexpr std::int32_t some_net = -2;  // matched by rules for any net alone
  for (std::size_t layer = 0; layer < num_layers; ++layer)
    if (!has_copper[layer])
      only_sheets[layer] = mode_of(study, rules, some_net, static_cast<std::int32_t>(layer)) == study::ConductorMode::sheet;
  return only_sheets;
}

void add_domain_and_board(const Footprint& footprint, const Stack& stack, ModelParts& parts) {
  const auto last = static_cast<std::int32_t>(stack.slabs.size()) - 1;
  const auto body = [&](std::string name, BodyKind kind) {
    return Body{.name = std::move(name), .kind = kind, .first_slab = 0, .last_slab = last};
  };
  // Whether a ring is convex does not matter enough to find out: a few rings are normalised for nothing.
  std::vector<BodyShape> domain, boards, cutouts;
  for (const Ring& ring : footprint.domain) domain.push_back({.rings = {ring}, .simple = ring.size() == 4});
  for (const std::vector<Ring>& rings : footprint.boards)
    boards.push_back({.rings = rings, .simple = rings.size() == 1 && rings.front().size() == 4});
  append_body(parts, body("domain", BodyKind::domain), std::move(domain));
  append_body(parts, body("board", BodyKind::board), std::move(boards));
  for (const Ring& ring : footprint.loose_cutouts) cutouts.push_back({.rings = {ring}, .simple = false});
  if (cutouts.empty()) return;
  Body hole = body("cut-outs", BodyKind::hole);
  hole.material = stack.outside;
  hole.priority = cutout_priority;
  append_body(parts, std::move(hole), std::move(cutouts));
}

void add_copper(const Board& board, const study::Study& study, const std::vector<ResolvedRule>& rules,
                const Footprint& footprint, const Stack& stack, ModelParts& parts, Diagnostics& diagnostics) {
  Grouped<std::pair<std::int32_t, std::int32_t>> groups;  // (copper layer, net)
  for (const board::Shape& shape : board.shapes()) {
    const geometry::Box box = geometry::bounds(shape.figure);
    if (!box.touches(footprint.box)) {
      if (study.region == study::RegionKind::whole)
        diagnostics.note("compose.copper_outside_board", "copper beside the board outline is left out",
                         {.file = board.source(),
                          .line = shape.line,
                          .layer = board.copper_name(shape.copper_layer),
                          .net = std::string(board.net_name(shape.net))});
      continue;
    }
    BodyShape rings = shape_of(shape.figure, study, footprint, shape.line);
    if (!rings.rings.empty()) groups[{shape.copper_layer, shape.net}].push_back(std::move(rings));
  }
  for (auto& [key, shapes] : groups) {
    const auto [copper_layer, net] = key;
    const CopperPlace& place = stack.copper[static_cast<std::size_t>(copper_layer)];
    const board::StackupLayer& layer =
        board.stackup()[static_cast<std::size_t>(board.copper_layers()[static_cast<std::size_t>(copper_layer)])];
    Body body{.name = fmt::format("copper {} on {}", short_net_name(board, net), board.copper_name(copper_layer)),
              .kind = BodyKind::copper,
              .material = layer.material,
              .net = net,
              .first_slab = place.low,
              .last_slab = place.low,
              .priority = copper_priority};
    const study::ConductorMode mode = mode_of(study, rules, net, copper_layer);
    body.hollow = mode == study::ConductorMode::hollow;
    if (mode == study::ConductorMode::sheet) {
      body.sheet = model::SheetPlace{place.sheet, layer.name, layer.thickness_nm};
      body.first_slab = body.last_slab = std::min(place.low, static_cast<std::int32_t>(stack.slabs.size()) - 1);
    }
    append_body(parts, std::move(body), std::move(shapes));
  }
}

void add_holes(const Board& board, const study::Study& study, const std::vector<ResolvedRule>& rules,
               const Footprint& footprint, const Stack& stack, ModelParts& parts) {
  Grouped<std::pair<std::int32_t, std::int32_t>> unplated;  // span
  Grouped<std::array<std::int32_t, 3>> plated;              // span, net
  for (const board::Drill& drill : board.drills()) {
    if (!geometry::bounds(drill.figure).touches(footprint.box)) continue;
    BodyShape rings = shape_of(drill.figure, study, footprint, drill.line);
    if (rings.rings.empty()) continue;
    if (drill.plated)
      plated[{drill.first_copper, drill.last_copper, drill.net}].push_back(std::move(rings));
    else
      unplated[{drill.first_copper, drill.last_copper}].push_back(std::move(rings));
  }
  const auto last_copper = static_cast<std::int32_t>(board.copper_layers().size()) - 1;
  const auto first_slab = [&](std::int32_t copper) { return stack.copper[static_cast<std::size_t>(copper)].low; };
  const auto last_slab = [&](std::int32_t copper) { return stack.copper[static_cast<std::size_t>(copper)].high - 1; };
  // A span within one layer that has no slab holds nothing.
  for (auto& [span, shapes] : unplated) {
    const auto [top, bottom] = span;
    // A hole through all copper goes on through dielectric outside it.
    const std::int32_t first = bottom == last_copper ? stack.first_board_slab : first_slab(bottom);
    const std::int32_t last = top == 0 ? stack.last_board_slab : last_slab(top);
    if (first > last) continue;
    append_body(parts,
                {.name = fmt::format("hole {} to {}", board.copper_name(top), board.copper_name(bottom)),
                 .kind = BodyKind::hole,
                 .material = stack.air,
                 .first_slab = first,
                 .last_slab = last,
                 .priority = hole_priority},
                std::move(shapes));
  }
  for (auto& [key, shapes] : plated) {
    const auto [top, bottom, net] = key;
    if (first_slab(bottom) > last_slab(top)) continue;
    const auto stackup_index = static_cast<std::size_t>(board.copper_layers()[static_cast<std::size_t>(top)]);
    append_body(parts,
                {.name = fmt::format("barrel {} {} to {}", short_net_name(board, net), board.copper_name(top),
                                     board.copper_name(bottom)),
                 .kind = BodyKind::barrel,
                 .material = board.stackup()[stackup_index].material,
                 .net = net,
                 .first_slab = first_slab(bottom),
                 .last_slab = last_slab(top),
                 .priority = barrel_priority,
                 .hollow = mode_of(study, rules, net, -1) == study::ConductorMode::hollow},
                std::move(shapes));
  }
}

void add_circles(const Board& board, const study::Study& study, const Footprint& footprint, ModelParts& parts) {
  if (study.arcs.mode != geometry::ArcMode::inscribed) return;
  std::vector<geometry::OutlineCircle>& circles = parts.circles;
  const auto add = [&](const geometry::Figure& figure) {
    if (geometry::bounds(figure).touches(footprint.box)) geometry::append_circles(figure, circles);
  };
  for (const board::Shape& shape : board.shapes()) add(shape.figure);
  for (const board::Drill& drill : board.drills()) add(drill.figure);
  for (const board::Outline& outline : board.outlines()) {
    add({outline.outer, 0, true});
    for (const geometry::Path& cutout : outline.cutouts) add({cutout, 0, true});
  }
  std::sort(circles.begin(), circles.end());
  circles.erase(std::unique(circles.begin(), circles.end()), circles.end());
}

void measure_narrowest(const Board& board, const Footprint& footprint, ModelParts& parts) {
  std::vector<char> of_interest(board.nets().size(), 0);
  for (std::int32_t net : parts.nets_of_interest) of_interest[static_cast<std::size_t>(net)] = 1;
  const auto take = [&](const geometry::Figure& figure, std::int32_t net) {
    const Nm width = width_of(figure);
    if (width <= 0) return;
    const auto least = [&](Nm& into) { into = into == 0 ? width : std::min(into, width); };
    least(parts.narrowest_feature_nm);
    if (net >= 0 && of_interest[static_cast<std::size_t>(net)]) least(parts.narrowest_of_interest_nm);
  };
  for (const board::Shape& shape : board.shapes()) {
    // Fills and graphics have slivers of any width; they say nothing about what the designer drew on purpose.
    if (shape.kind == board::ShapeKind::fill || shape.kind == board::ShapeKind::graphic) continue;
    if (geometry::bounds(shape.figure).touches(footprint.box)) take(shape.figure, shape.net);
  }
  for (const board::Drill& drill : board.drills())
    if (geometry::bounds(drill.figure).touches(footprint.box)) take(drill.figure, drill.net);
}

}  // namespace pcbmesh::compose
