// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/compose/bodies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "pcbmesh/geometry/ring_contact.hpp"
#include "src/compose/etch.hpp"

namespace pcbmesh::compose {
namespace {

using board::Board;
using geometry::Ring;
using model::Body;
using model::BodyKind;
using model::BodyShape;
using model::ModelParts;

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

BodyShape shape_of(const geometry::Figure& figure, const study::Study& study, const Footprint& footprint, std::int64_t line) {
  BodyShape shape;
  shape.line = line;
  for (Ring& ring : geometry::outline(figure, study.arcs, shape.simple))
    if (Ring kept = footprint.cut(std::move(ring)); kept.size() >= 3) shape.rings.push_back(std::move(kept));
  return shape;
}

std::string_view short_net_name(const Board& board, std::int32_t net) {
  return net < 0 ? std::string_view("none") : board.net_name(net);
}

void append_body(ModelParts& parts, Body body, std::vector<BodyShape> shapes) {
  const auto index = static_cast<std::int32_t>(parts.bodies.size());
  parts.bodies.push_back(std::move(body));
  for (BodyShape& shape : shapes) {
    shape.body = index;
    parts.shapes.push_back(std::move(shape));
  }
}

std::int32_t material_of(const Board& board, std::int32_t copper_layer) {
  const auto index = static_cast<std::size_t>(board.copper_layers()[static_cast<std::size_t>(copper_layer)]);
  return board.stackup()[index].material;
}

void keep_open(ModelParts& parts, Nm width) {
  parts.narrowest_feature_nm = parts.narrowest_feature_nm == 0 ? width : std::min(parts.narrowest_feature_nm, width);
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
  std::map<std::pair<std::int32_t, std::int32_t>, std::vector<BodyShape>> groups;  // (copper layer, net)
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
  for (std::int32_t layer = 0; layer < static_cast<std::int32_t>(stack.copper_slices.size()); ++layer) {
    std::map<std::int32_t, std::vector<BodyShape>> by_net;
    for (auto it = groups.lower_bound({layer, board::no_net}); it != groups.end() && it->first.first == layer; ++it)
      by_net.emplace(it->first.second, std::move(it->second));
    const CopperPlace& place = stack.copper[static_cast<std::size_t>(layer)];
    for (auto& [net, shapes] : by_net) {
      if (mode_of(study, rules, net, layer) != study::ConductorMode::sheet) continue;
      const board::StackupLayer& copper =
          board.stackup()[static_cast<std::size_t>(board.copper_layers()[static_cast<std::size_t>(layer)])];
      Body body{.name = fmt::format("copper {} on {}", short_net_name(board, net), board.copper_name(layer)),
                .kind = BodyKind::copper,
                .material = copper.material,
                .net = net,
                .priority = copper_priority};
      body.sheet = model::SheetPlace{place.sheet, copper.name, copper.thickness_nm};
      body.first_slab = body.last_slab = std::min(place.low, static_cast<std::int32_t>(stack.slabs.size()) - 1);
      append_body(parts, std::move(body), shapes);
    }
    std::erase_if(by_net,
                  [&](const auto& item) { return mode_of(study, rules, item.first, layer) == study::ConductorMode::sheet; });
    for (const CopperSlice& slice : stack.copper_slices[static_cast<std::size_t>(layer)])
      for (auto& [net, shapes] : etched(by_net, slice.inset))
        append_body(parts,
                    {.name = fmt::format("copper {} on {}{}", short_net_name(board, net), board.copper_name(layer),
                                         slice.inset > 0 ? fmt::format(" less {}", format_length(slice.inset)) : ""),
                     .kind = BodyKind::copper,
                     .material = material_of(board, layer),
                     .net = net,
                     .first_slab = slice.slabs.first,
                     .last_slab = slice.slabs.last,
                     .priority = copper_priority,
                     .hollow = mode_of(study, rules, net, layer) == study::ConductorMode::hollow},
                    std::move(shapes));
  }
  for (const std::vector<CopperSlice>& slices : stack.copper_slices)
    for (const CopperSlice& slice : slices)
      // Several tolerances must fit between one stair and the next.
      if (slice.inset > 0) keep_open(parts, 4 * slice.inset);
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
