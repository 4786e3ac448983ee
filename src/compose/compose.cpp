// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/compose/compose.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
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
#include "src/compose/port_clearance.hpp"
#include "src/compose/ports.hpp"
#include "src/compose/shell.hpp"
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
    case study::BoundaryKind::periodic:
      return {model::SideKind::periodic, 0};
    case study::BoundaryKind::pml:
      return side_condition({.kind = boundary.backing});
    case study::BoundaryKind::none:
    case study::BoundaryKind::automatic:  // resolved before
      break;
  }
  return {};
}

/// Names of the study as indices of the board.
struct ResolvedNames {
  std::vector<std::int32_t> nets;
  std::vector<ResolvedRule> rules;
  HolePlan holes;
  std::vector<ResolvedFill> fills;   ///< per copper layer
  std::vector<study::Fault> faults;  ///< what was not found; names that are wrong
  bool must_stop = false;            ///< they concern the region or how the board is made: no port can be placed
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
void check_backdrills(const Board& board, const Study& study, const HolePlan& plan, std::vector<study::Fault>& faults) {
  const auto last = static_cast<std::int32_t>(board.copper_layers().size()) - 1;
  for (std::size_t i = 0; i < plan.backdrills.size(); ++i) {
    const ResolvedBackdrill& b = plan.backdrills[i];
    if ((b.first_copper == 0) != (b.last_copper == last)) continue;
    faults.push_back({fmt::format("/backdrill/{}", i),
                      fmt::format("from {} to {} {}; a backdrill starts at {} or {} and ends before the other",
                                  study.fabrication.backdrills[i].from, study.fabrication.backdrills[i].to,
                                  b.first_copper == 0 ? "goes through the whole board" : "starts inside the board",
                                  board.copper_name(0), board.copper_name(last))});
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
  const std::string known_so_far = resolver.text();
  names.holes = resolve_holes(study.fabrication, resolver, materials);
  names.fills = resolve_fills(board, study.fabrication, resolver, materials);
  const std::string unknown = resolver.text();
  if (!unknown.empty()) names.faults.push_back({"", unknown});
  for (std::size_t i = 0; i < study.ports.size(); ++i) {
    const study::Port& port = study.ports[i];
    NameResolver of_port(board);
    (void)of_port.net(port.net);
    if (!port.reference.empty()) (void)of_port.net(port.reference);
    if (!port.at.layer.empty()) (void)of_port.copper_layer(port.at.layer);
    if (const std::string text = of_port.text(); !text.empty())
      names.faults.push_back({fmt::format("/ports/{}", i), fmt::format("port '{}': {}", port.name, text)});
  }
  if (!materials.unknown().empty()) names.faults.push_back({"/materials/use", materials.unknown()});
  if (unknown == known_so_far) check_backdrills(board, study, names.holes, names.faults);
  // Where only terminals of ports are unknown, the other ports can be looked at.
  names.must_stop =
      unknown != known_so_far || !materials.unknown().empty() || std::ranges::count(names.nets, board::no_net) > 0;
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

/// Whether faults leave the geometry of the domain in doubt, so that ports can't be looked at.
bool is_about_geometry(const study::Fault& fault) {
  constexpr std::array harmless{"/ports", "/sweep", "/modes", "/mesh", "/limits", "/output", "/solver", "/materials"};
  return std::ranges::none_of(harmless, [&](std::string_view field) { return fault.field.starts_with(field); });
}

/// Code of an error that tells of several faults: the study's own first, then names, then the rest.
ErrorCode code_of(const std::vector<study::Fault>& of_study, const ResolvedNames& names) {
  if (!of_study.empty()) return ErrorCode::study_invalid;
  if (names.faults.empty()) return ErrorCode::port_invalid;
  return names.faults.front().field.starts_with("/backdrill") ? ErrorCode::study_invalid : ErrorCode::name_unknown;
}

/// Runs a step whose refusal is one fault among others.
template <class Step>
void gather(std::vector<study::Fault>& faults, Step&& step) {
  try {
    step();
  } catch (const Error& error) {
    const std::string place = error.spot().text();
    faults.push_back({"", place.empty() ? error.text() : fmt::format("{} ({})", error.text(), place)});
  }
}

/// Everything that is wrong with a study, by itself and on this board, before its domain is built.
struct KnownFaults {
  std::vector<study::Fault> of_study, of_layers;
  const ResolvedNames& names;

  KnownFaults(const Board& board, const Study& study, const ResolvedNames& resolved, const MaterialTable& materials)
      : of_study(study::faults_of(study)), names(resolved) {
    if (study.solver != study::Solver::none) of_layers = materials.layers_without_permittivity(board);
  }
  [[nodiscard]] bool is_empty() const { return of_study.empty() && of_layers.empty() && names.faults.empty(); }
  /// Whether the domain is in doubt, so that ports can't be looked at.
  [[nodiscard]] bool must_stop() const { return names.must_stop || std::ranges::any_of(of_study, is_about_geometry); }
  /// @throws Error that names these and `more`, of the code of the first.
  [[noreturn]] void refuse(const std::string& source, std::span<const study::Fault> more) const {
    std::vector<study::Fault> all = of_study;
    all.insert(all.end(), names.faults.begin(), names.faults.end());
    all.insert(all.end(), of_layers.begin(), of_layers.end());
    const bool only_layers = all.size() == of_layers.size() && !all.empty() && more.empty();
    all.insert(all.end(), more.begin(), more.end());
    throw Error(only_layers ? ErrorCode::stackup_invalid : code_of(of_study, names), study::text_of(all), {.file = source});
  }
};

/// Nets that the study names for their own sake: those of the region, and those with ports, whose faces no snapping may bend.
std::vector<std::int32_t> nets_of_interest(const Board& board, const Study& study, const ResolvedNames& names) {
  std::vector<std::int32_t> nets = names.nets;
  for (const study::Port& port : study.ports)
    if (const auto net = board.find_net(port.net); net && std::ranges::find(nets, *net) == nets.end()) nets.push_back(*net);
  return nets;
}

/// The domain, with those of its ports that can be placed. What is wrong with ports goes into `faults`.
model::Model build(const Board& board, const Study& study, const ResolvedNames& names, MaterialTable materials,
                   std::vector<study::Fault>& faults, Diagnostics& diagnostics) {
  const Footprint footprint = build_footprint(board, study, names.nets, diagnostics);
  Stack stack =
      build_stack(board, study, find_sheet_layers(board, study, names.rules, footprint), names.fills, materials, diagnostics);

  model::ModelParts parts;
  parts.source = board.source();
  parts.nets.assign(board.nets().begin(), board.nets().end());
  parts.nets_of_interest = nets_of_interest(board, study, names);
  add_domain_and_board(footprint, stack, parts);
  measure_narrowest(board, footprint, parts);
  add_copper(board, study, names.rules, footprint, stack, parts, diagnostics);
  add_holes(board, study, names.rules, names.holes, footprint, stack, parts, diagnostics);
  add_mask(board, study, footprint, stack, parts, diagnostics);
  if (study.paper_compat) keep_every_outline(parts);
  if (study.order == 2) add_circles(board, study, footprint, parts);
  add_shell(study, footprint, stack, parts);
  add_ports(board, study, names.rules, footprint, stack, parts, faults);
  const auto boundaries = study::resolved_boundaries(study);
  for (std::size_t i = 0; i < study::num_hull_sides; ++i) parts.sides[i] = side_condition(boundaries[i]);
  if (study.region == study::RegionKind::polygon) {
    parts.outline = study.polygon;
    for (const study::Boundary& boundary : study::resolved_polygon_boundaries(study))
      parts.outline_sides.push_back(side_condition(boundary));
  }
  parts.conductors_are_perfect = study.conductor_surface == study::ConductorSurface::pec;
  if (std::none_of(parts.bodies.begin(), parts.bodies.end(), [](const model::Body& body) {
        return body.kind == model::BodyKind::copper || body.kind == model::BodyKind::barrel;
      }))
    diagnostics.warn("compose.no_copper", "the domain holds no copper", {.file = board.source()});
  parts.materials = materials.take();
  parts.slabs = std::move(stack.slabs);
  model::Model model = model::Model::from_parts(std::move(parts));
  for (study::Fault& fault : port_faults(model))
    if (std::ranges::find(faults, fault.field, &study::Fault::field) == faults.end()) faults.push_back(std::move(fault));
  return model;
}

}  // namespace

model::Model compose(const Board& board, const Study& study, Diagnostics& diagnostics) {
  MaterialTable materials(board, study, diagnostics);
  const ResolvedNames names = resolve_names(board, study, materials);
  const KnownFaults known(board, study, names, materials);
  std::vector<study::Fault> faults;  // that only the domain shows
  std::optional<model::Model> model;
  if (known.is_empty()) {
    model = build(board, study, names, std::move(materials), faults, diagnostics);
  } else if (!known.must_stop()) {
    // All in one run. What is told here is told again by nobody: diagnostics of a domain that is not meshed are dropped.
    Diagnostics ignored;
    gather(faults, [&] { (void)build(board, study, names, std::move(materials), faults, ignored); });
  }
  if (!known.is_empty() || !faults.empty()) known.refuse(board.source(), faults);
  return std::move(*model);
}

std::vector<PortProposal> propose_ports(const Board& board, const Study& study, PortPlaces places, Diagnostics& diagnostics) {
  MaterialTable materials(board, study, diagnostics);
  const ResolvedNames names = resolve_names(board, study, materials);
  if (const KnownFaults known(board, study, names, materials); !known.is_empty()) known.refuse(board.source(), {});
  const Footprint footprint = build_footprint(board, study, names.nets, diagnostics);
  Diagnostics ignored;  // the domain is built again with the ports in it
  MaterialTable again(board, study, ignored);
  const Stack stack =
      build_stack(board, study, find_sheet_layers(board, study, names.rules, footprint), names.fills, materials, diagnostics);
  std::vector<PortProposal> proposals = find_ports(board, study, names.rules, footprint, stack, names.nets, places);
  // Held against the finished domain, so that what is proposed can be meshed.
  Study with = study;
  with.ports.clear();
  for (const PortProposal& proposal : proposals)
    if (proposal.why_not.empty()) with.ports.push_back(proposal.port);
  std::vector<study::Fault> faults;
  (void)build(board, with, names, std::move(again), faults, ignored);
  std::size_t number = 0;
  for (PortProposal& proposal : proposals) {
    if (!proposal.why_not.empty()) continue;
    const auto fault = std::ranges::find(faults, fmt::format("/ports/{}", number++), &study::Fault::field);
    if (fault != faults.end()) proposal.why_not = fault->text;
  }
  name_ports(proposals);
  return proposals;
}

}  // namespace pcbmesh::compose
