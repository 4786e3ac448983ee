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
#include "src/compose/stack.hpp"

namespace pcbmesh::compose {
namespace {

using board::Board;
using study::Study;

/// Names of the study as indices of the board.
struct ResolvedNames {
  std::vector<std::int32_t> nets;
  std::vector<ResolvedRule> rules;
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

  void throw_if_unknown() const {
    std::string text;
    if (!unknown_nets_.empty())
      text = fmt::format("the board has no net called {}; `pcbmesh inspect` lists its {} nets", unknown_nets_,
                         board_.nets().size());
    if (!unknown_layers_.empty())
      text += fmt::format("{}no copper layer is called {}; copper layers are {}", text.empty() ? "" : "; ", unknown_layers_,
                          fmt::join(layers_, ", "));
    if (!text.empty()) throw Error(ErrorCode::name_unknown, text, {.file = board_.source()});
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
    resolved.hollow = rule.mode == study::ConductorMode::hollow;
    resolved.any_net = rule.net.empty();
    if (!resolved.any_net) resolved.net = resolver.net(rule.net);
    resolved.any_layer = rule.layer.empty();
    if (!resolved.any_layer) resolved.copper_layer = resolver.copper_layer(rule.layer);
    names.rules.push_back(resolved);
  }
  resolver.throw_if_unknown();
  return names;
}

}  // namespace

model::Model compose(const Board& board, const Study& study, Diagnostics& diagnostics) {
  study::check(study);
  const ResolvedNames names = resolve_names(board, study);
  Stack stack = build_stack(board, study, diagnostics);
  const Footprint footprint = build_footprint(board, study, names.nets, diagnostics);

  model::ModelParts parts;
  parts.source = board.source();
  parts.nets.assign(board.nets().begin(), board.nets().end());
  parts.nets_of_interest = names.nets;
  add_domain_and_board(footprint, stack, parts);
  add_copper(board, study, names.rules, footprint, stack, parts, diagnostics);
  add_holes(board, study, names.rules, footprint, stack, parts);
  measure_narrowest(board, footprint, parts);
  if (study.order == 2) add_circles(board, study, footprint, parts);
  if (std::none_of(parts.bodies.begin(), parts.bodies.end(), [](const model::Body& body) {
        return body.kind == model::BodyKind::copper || body.kind == model::BodyKind::barrel;
      }))
    diagnostics.warn("compose.no_copper", "the domain holds no copper", {.file = board.source()});
  parts.materials = std::move(stack.materials);
  parts.slabs = std::move(stack.slabs);
  return model::Model::from_parts(std::move(parts));
}

}  // namespace pcbmesh::compose
