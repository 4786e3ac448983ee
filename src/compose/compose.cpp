// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/compose/compose.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/base/near_miss.hpp"
#include "src/compose/bodies.hpp"
#include "src/compose/footprint.hpp"
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
    case study::BoundaryKind::periodic:  // refused by study::check
      break;
  }
  return {};
}

/// Names of the study as indices of the board.
struct ResolvedNames {
  std::vector<std::int32_t> nets;
  std::vector<ResolvedRule> rules;
  std::string unknown;  ///< what was not found; empty = nothing
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

  /// What is unknown, in one sentence; empty = nothing.
  [[nodiscard]] std::string text() const {
    std::string text;
    if (!unknown_nets_.empty())
      text = fmt::format("the board has no net called {}; `pcbmesh inspect` lists its {} nets", unknown_nets_,
                         board_.nets().size());
    if (!unknown_layers_.empty())
      text += fmt::format("{}no copper layer is called {}; copper layers are {}", text.empty() ? "" : "; ", unknown_layers_,
                          fmt::join(layers_, ", "));
    return text;
  }

 private:
  static void add(std::string& list, const std::string& entry) {
    if (list.find(entry) == std::string::npos) list += (list.empty() ? "" : ", ") + entry;
  }
  const Board& board_;
  std::vector<std::string> layers_, user_layers_;
  std::string unknown_nets_, unknown_layers_;
};

ResolvedNames resolve_names(const Board& board, const Study& study) {
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
  names.unknown = resolver.text();
  return names;
}

}  // namespace

model::Model compose(const Board& board, const Study& study, Diagnostics& diagnostics) {
  study::check(study);
  const ResolvedNames names = resolve_names(board, study);
  // A region of unknown nets is nowhere; otherwise what is wrong with the ports is told in the same run.
  if (!names.unknown.empty() && (study.ports.empty() || std::ranges::count(names.nets, board::no_net) > 0))
    throw Error(ErrorCode::name_unknown, names.unknown, {.file = board.source()});
  const Footprint footprint = build_footprint(board, study, names.nets, diagnostics);
  Stack stack = build_stack(board, study, find_sheet_layers(board, study, names.rules, footprint), diagnostics);

  model::ModelParts parts;
  parts.source = board.source();
  parts.nets.assign(board.nets().begin(), board.nets().end());
  parts.nets_of_interest = names.nets;
  add_domain_and_board(footprint, stack, parts);
  add_copper(board, study, names.rules, footprint, stack, parts, diagnostics);
  add_holes(board, study, names.rules, footprint, stack, parts);
  measure_narrowest(board, footprint, parts);
  if (study.order == 2) add_circles(board, study, footprint, parts);
  std::vector<study::Fault> faults;
  add_ports(board, study, names.rules, footprint, stack, parts, faults);
  if (!names.unknown.empty() || !faults.empty()) {
    const std::string more = study::text_of(faults);
    const std::string gap = names.unknown.empty() || more.empty() ? "" : "\n  ";
    throw Error(names.unknown.empty() ? ErrorCode::port_invalid : ErrorCode::name_unknown, names.unknown + gap + more,
                {.file = board.source()});
  }
  for (std::size_t i = 0; i < study::num_hull_sides; ++i) parts.sides[i] = side_condition(study.boundaries[i]);
  parts.conductors_are_perfect = study.conductor_surface == study::ConductorSurface::pec;
  if (std::none_of(parts.bodies.begin(), parts.bodies.end(), [](const model::Body& body) {
        return body.kind == model::BodyKind::copper || body.kind == model::BodyKind::barrel;
      }))
    diagnostics.warn("compose.no_copper", "the domain holds no copper", {.file = board.source()});
  parts.materials = std::move(stack.materials);
  parts.slabs = std::move(stack.slabs);
  return model::Model::from_parts(std::move(parts));
}

}  // namespace pcbmesh::compose
