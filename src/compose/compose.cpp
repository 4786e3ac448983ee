// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/compose/compose.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/base/near_miss.hpp"
#include "src/compose/bodies.hpp"
#include "src/compose/footprint.hpp"
#include "src/compose/holes.hpp"
#include "src/compose/mask.hpp"
#include "src/compose/materials.hpp"
#include "src/compose/ports.hpp"
#include "src/compose/stack.hpp"

namespace pcbmesh::compose {
namespace {

using board::Board;
using study::Study;

model::SideCondition side_condition(const study::Boundary& boundary) {
  switch (boundary.kind) {
    case study::BoundaryKind::absorbing:
      return {model::SideKind::absorbing, 0};
    case study::BoundaryKind::pec:
      return {model::SideKind::pec, 0};
    case study::BoundaryKind::pmc:
      return {model::SideKind::pmc, 0};
    case study::BoundaryKind::impedance:
      return {model::SideKind::impedance, boundary.ohms};
    case study::BoundaryKind::none:
    case study::BoundaryKind::automatic:  // resolved before
    case study::BoundaryKind::periodic:   // refused by study::check
      break;
  }
  return {};
}

/// Names of the study as indices of the board.
struct ResolvedNames {
  std::vector<std::int32_t> nets;
  std::vector<ResolvedRule> rules;
  HolePlan holes;
  std::vector<ResolvedFill> fills;  ///< per copper layer
  std::string unknown;              ///< what was not found; empty = nothing
  bool must_stop = false;           ///< what is unknown concerns how the board is made
};

/// Looks names up and collects every unknown one, so that one run tells them all.
class NameResolver {
 public:
  explicit NameResolver(const Board& board) : board_(board) {
    for (std::int32_t stackup_index : board.copper_layers()) {
      const board::StackupLayer& layer = board.stackup()[static_cast<std::size_t>(stackup_index)];
      layers_.push_back(layer.name);
      user_layers_.push_back(layer.user_name);
    }
  }

  std::int32_t net(const std::string& name) {
    if (const auto found = board_.find_net(name)) return *found;
    std::string near;
    for (const std::string& candidate : board_.similar_nets(name))
      near += fmt::format("{}'{}'", near.empty() ? " (did you mean " : ", ", candidate);
    add(unknown_nets_, fmt::format("'{}'{}", name, near.empty() ? "" : near + "?)"));
    return board::no_net;
  }

  /// By canonical name, else by the designer's.
  std::int32_t copper_layer(const std::string& name) {
    for (const std::vector<std::string>* names : {&layers_, &user_layers_}) {
      const auto found = std::find(names->begin(), names->end(), name);
      if (found != names->end()) return static_cast<std::int32_t>(found - names->begin());
    }
    add(unknown_layers_, fmt::format("'{}'{}", name, did_you_mean(name, layers_)));
    return -1;
  }

  /// Of the board or the library.
  std::int32_t material(const std::string& name, MaterialTable& materials) {
    const std::int32_t found = materials.named(name);
    if (found < 0) add(unknown_materials_, fmt::format("'{}'{}", name, materials.near(name)));
    return found;
  }

  /// What is unknown, in one sentence; empty = nothing.
  [[nodiscard]] std::string text() const {
    std::string text;
    if (!unknown_nets_.empty())
      text = fmt::format("the board has no net called {}; `pcbmesh inspect` lists its {} nets", unknown_nets_,
                         board_.nets().size());
    if (!unknown_layers_.empty())
      text += fmt::format("{}no copper layer is called {}; copper layers are {}", text.empty() ? "" : "; ", unknown_layers_,
                          fmt::join(layers_, ", "));
    if (!unknown_materials_.empty())
      text += fmt::format("{}neither board nor library has a material called {}", text.empty() ? "" : "; ", unknown_materials_);
    return text;
  }

 private:
  static void add(std::string& list, const std::string& entry) {
    if (list.find(entry) == std::string::npos) list += (list.empty() ? "" : ", ") + entry;
  }
  const Board& board_;
  std::vector<std::string> layers_, user_layers_;
  std::string unknown_nets_, unknown_layers_, unknown_materials_;
};

HolePlan resolve_holes(const study::Fabrication& fabrication, NameResolver& resolver, MaterialTable& materials) {
  HolePlan plan;
  const auto add_rule = [&](const study::HoleRule& rule) {
    ResolvedHoleRule resolved{.any_net = rule.net.empty(), .kind = rule.kind, .how = rule.how};
    if (!resolved.any_net) resolved.net = resolver.net(rule.net);
    if (rule.how.fill == study::ViaFill::plugged) resolved.plug = resolver.material(rule.how.plug, materials);
    plan.rules.push_back(std::move(resolved));
  };
  add_rule({.how = fabrication.vias});
  for (const study::HoleRule& rule : fabrication.hole_rules) add_rule(rule);
  for (const study::Backdrill& backdrill : fabrication.backdrills) {
    ResolvedBackdrill resolved{.any_net = backdrill.net.empty(), .oversize = backdrill.oversize};
    if (!resolved.any_net) resolved.net = resolver.net(backdrill.net);
    const std::int32_t a = resolver.copper_layer(backdrill.from), b = resolver.copper_layer(backdrill.to);
    std::tie(resolved.first_copper, resolved.last_copper) = std::minmax(a, b);
    plan.backdrills.push_back(resolved);
  }
  return plan;
}

/// Drills start at a face of the board.
void require_backdrills_from_outside(const Board& board, const Study& study, const HolePlan& plan) {
  const auto last = static_cast<std::int32_t>(board.copper_layers().size()) - 1;
  for (std::size_t i = 0; i < plan.backdrills.size(); ++i) {
    const ResolvedBackdrill& b = plan.backdrills[i];
    if ((b.first_copper == 0) != (b.last_copper == last)) continue;
    throw Error(ErrorCode::study_invalid,
                fmt::format("/backdrill/{}: from {} to {} {}; a backdrill starts at {} or {} and ends before the other", i,
                            study.fabrication.backdrills[i].from, study.fabrication.backdrills[i].to,
                            b.first_copper == 0 ? "goes through the whole board" : "starts inside the board",
                            board.copper_name(0), board.copper_name(last)));
  }
}

std::vector<ResolvedFill> resolve_fills(const Board& board, const study::Fabrication& fabrication, NameResolver& resolver,
                                        MaterialTable& materials) {
  std::vector<ResolvedFill> fills(board.copper_layers().size());
  for (const study::GapFill& fill : fabrication.gap_fills) {
    const std::int32_t layer = resolver.copper_layer(fill.layer);
    ResolvedFill resolved;
    if (fill.from == "above")
      resolved.side = FillSide::above;
    else if (fill.from == "below")
      resolved.side = FillSide::below;
    else
      resolved = {FillSide::material, resolver.material(fill.from, materials)};
    if (layer >= 0) fills[static_cast<std::size_t>(layer)] = resolved;
  }
  return fills;
}

ResolvedNames resolve_names(const Board& board, const Study& study, MaterialTable& materials) {
  NameResolver resolver(board);
  ResolvedNames names;
  for (const std::string& net : study.nets) names.nets.push_back(resolver.net(net));
  for (const study::ConductorRule& rule : study.conductor_rules) {
    ResolvedRule resolved;
    resolved.mode = rule.mode;
    resolved.any_net = rule.net.empty();
    if (!resolved.any_net) resolved.net = resolver.net(rule.net);
    resolved.any_layer = rule.layer.empty();
    if (!resolved.any_layer) resolved.copper_layer = resolver.copper_layer(rule.layer);
    names.rules.push_back(resolved);
  }
  for (const study::Port& port : study.ports) {
    (void)resolver.net(port.net);
    if (!port.reference.empty()) (void)resolver.net(port.reference);
    if (!port.at.layer.empty()) (void)resolver.copper_layer(port.at.layer);
  }
  const std::string known_so_far = resolver.text();
  names.holes = resolve_holes(study.fabrication, resolver, materials);
  names.fills = resolve_fills(board, study.fabrication, resolver, materials);
  names.unknown = resolver.text();
  names.must_stop = names.unknown != known_so_far;
  if (!names.must_stop) require_backdrills_from_outside(board, study, names.holes);
  return names;
}

/// The paper projects the outline of every feature, those inside other copper too; here copper of a net is united before. Each
/// shape as a body of its own keeps its outline.
void keep_every_outline(model::ModelParts& parts) {
  std::vector<bool> is_taken(parts.bodies.size(), false);
  for (model::BodyShape& shape : parts.shapes) {
    const auto body = static_cast<std::size_t>(shape.body);
    if (is_taken[body]) {
      shape.body = static_cast<std::int32_t>(parts.bodies.size());
      parts.bodies.push_back(model::Body(parts.bodies[body]));
    } else {
      is_taken[body] = true;
    }
  }
}

}  // namespace

model::Model compose(const Board& board, const Study& study, Diagnostics& diagnostics) {
  study::check(study);
  MaterialTable materials(board, study, diagnostics);
  const ResolvedNames names = resolve_names(board, study, materials);
  // A region of unknown nets is nowhere; otherwise what is wrong with the ports is told in the same run.
  if (!names.unknown.empty() && (study.ports.empty() || names.must_stop || std::ranges::count(names.nets, board::no_net) > 0))
    throw Error(ErrorCode::name_unknown, names.unknown, {.file = board.source()});
  const Footprint footprint = build_footprint(board, study, names.nets, diagnostics);
  Stack stack =
      build_stack(board, study, find_sheet_layers(board, study, names.rules, footprint), names.fills, materials, diagnostics);

  model::ModelParts parts;
  parts.source = board.source();
  parts.nets.assign(board.nets().begin(), board.nets().end());
  parts.nets_of_interest = names.nets;
  add_domain_and_board(footprint, stack, parts);
  measure_narrowest(board, footprint, parts);
  add_copper(board, study, names.rules, footprint, stack, parts, diagnostics);
  add_holes(board, study, names.rules, names.holes, footprint, stack, parts, diagnostics);
  add_mask(board, study, footprint, stack, parts, diagnostics);
  if (study.paper_compat) keep_every_outline(parts);
  if (study.order == 2) add_circles(board, study, footprint, parts);
  std::vector<study::Fault> faults;
  add_ports(board, study, names.rules, footprint, stack, parts, faults);
  if (!names.unknown.empty() || !faults.empty()) {
    const std::string more = study::text_of(faults);
    const std::string gap = names.unknown.empty() || more.empty() ? "" : "\n  ";
    throw Error(names.unknown.empty() ? ErrorCode::port_invalid : ErrorCode::name_unknown, names.unknown + gap + more,
                {.file = board.source()});
  }
  const auto boundaries = study::resolved_boundaries(study);
  for (std::size_t i = 0; i < study::num_hull_sides; ++i) parts.sides[i] = side_condition(boundaries[i]);
  parts.conductors_are_perfect = study.conductor_surface == study::ConductorSurface::pec;
  if (std::none_of(parts.bodies.begin(), parts.bodies.end(), [](const model::Body& body) {
        return body.kind == model::BodyKind::copper || body.kind == model::BodyKind::barrel;
      }))
    diagnostics.warn("compose.no_copper", "the domain holds no copper", {.file = board.source()});
  parts.materials = materials.take();
  parts.slabs = std::move(stack.slabs);
  return model::Model::from_parts(std::move(parts));
}

std::vector<PortProposal> propose_ports(const Board& board, const Study& study, Diagnostics& diagnostics) {
  study::check(study);
  MaterialTable materials(board, study, diagnostics);
  const ResolvedNames names = resolve_names(board, study, materials);
  if (!names.unknown.empty()) throw Error(ErrorCode::name_unknown, names.unknown, {.file = board.source()});
  const Footprint footprint = build_footprint(board, study, names.nets, diagnostics);
  const Stack stack =
      build_stack(board, study, find_sheet_layers(board, study, names.rules, footprint), names.fills, materials, diagnostics);
  return find_ports(board, study, names.rules, footprint, stack, names.nets);
}

}  // namespace pcbmesh::compose
