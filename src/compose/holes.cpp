// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/compose/holes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>

#include "pcbmesh/geometry/polygon_sets.hpp"
#include "pcbmesh/geometry/ring_contact.hpp"
#include "src/compose/merge_vias.hpp"

namespace pcbmesh::compose {
namespace {

using board::Board;
using board::Drill;
using geometry::Ring;
using model::BodyKind;
using model::BodyShape;

/// Groups shapes by key in ascending order, so that bodies come out in one order whatever the file's.
template <class Key>
using Grouped = std::map<Key, std::vector<BodyShape>>;
using Span = std::pair<std::int32_t, std::int32_t>;

class HoleBuilder {
 public:
  HoleBuilder(const Board& board, const study::Study& study, const std::vector<ResolvedRule>& rules, const HolePlan& plan,
              const Footprint& footprint, const Stack& stack, model::ModelParts& parts, Diagnostics& diagnostics)
      : board_(board),
        study_(study),
        rules_(rules),
        plan_(plan),
        footprint_(footprint),
        stack_(stack),
        parts_(parts),
        diagnostics_(diagnostics) {}

  void run() {
    merge();
    for (const Drill& drill : board_.drills()) {
      if (!geometry::bounds(drill.figure).touches(footprint_.box)) continue;
      const BodyShape rings = shape_of(drill.figure, study_, footprint_, drill.line);
      if (rings.rings.empty()) continue;
      const Span span{drill.first_copper, drill.last_copper};
      if (drill.is_backdrill)
        backdrilled_[span].push_back(rings);
      else if (!drill.plated)
        unplated_[span].push_back(rings);
      else
        add_plated(drill, rings);
    }
    append_air(unplated_, "hole", BodyKind::hole, hole_priority);
    append_barrels();
    append_cores();
    append_backdrilled();
  }

 private:
  struct Core {
    std::int32_t first_slab, last_slab, material;
    friend auto operator<=>(const Core&, const Core&) = default;
  };

  void add_plated(const Drill& drill, const BodyShape& rings) {
    plated_[{drill.first_copper, drill.last_copper, drill.net}].push_back(rings);
    for (const ResolvedBackdrill& b : plan_.backdrills) {
      if (!b.any_net && b.net != drill.net) continue;
      if (drill.kind != board::ShapeKind::via && b.any_net) continue;  // component holes are drilled again when named only
      if (b.first_copper < drill.first_copper || b.last_copper > drill.last_copper) continue;
      geometry::Figure wider = drill.figure;
      wider.pen += b.oversize;
      BodyShape hole = shape_of(wider, study_, footprint_, drill.line);
      if (!hole.rings.empty()) backdrilled_[{b.first_copper, b.last_copper}].push_back(std::move(hole));
      ++num_backdrilled_;
    }
    const auto index = static_cast<std::size_t>(&drill - board_.drills().data());
    const bool is_merged = std::binary_search(merged_.members.begin(), merged_.members.end(), index);
    if (is_merged || mode_of(study_, rules_, drill.net, -1) == study::ConductorMode::hollow) return;
    const std::optional<ResolvedHoleRule> rule = rule_of(drill);
    if (rule) add_core(drill, rings, *rule);
  }

  /// How the hole is made; nullopt = solid copper.
  [[nodiscard]] std::optional<ResolvedHoleRule> rule_of(const Drill& drill) {
    ResolvedHoleRule rule = plan_.rules.front();
    for (const ResolvedHoleRule& r : plan_.rules) {
      if (!r.any_net && r.net != drill.net) continue;
      if (r.kind == study::HoleKind::via && drill.kind != board::ShapeKind::via) continue;
      if (r.kind == study::HoleKind::pad && drill.kind != board::ShapeKind::pad) continue;
      rule = r;
    }
    if (is_cut_by_outline(drill)) {
      diagnostics_.note("compose.castellation",
                        "a plated hole on the board outline is a castellation: half a tube, open inside",
                        {.file = board_.source(), .line = drill.line, .net = std::string(board_.net_name(drill.net))});
      rule.how.fill = study::ViaFill::plated;
      rule.how.capped = false;
    }
    if (rule.how.fill == study::ViaFill::copper) return std::nullopt;
    return rule;
  }

  [[nodiscard]] bool is_cut_by_outline(const Drill& drill) const {
    const geometry::Box box = geometry::bounds(drill.figure);
    bool simple = true;
    std::vector<Ring> rings;
    const auto crosses = [&](const Ring& edge) {
      geometry::Box edge_box;
      for (const geometry::Point p : edge) edge_box.add(p);
      if (!edge_box.touches(box)) return false;
      if (rings.empty()) rings = geometry::outline(drill.figure, study_.arcs, simple);
      // A corner of the hole may lie exactly on the outline, so what counts is whether there is hole on both sides.
      bool is_inside = false, is_outside = false;
      for (const Ring& ring : rings)
        for (const geometry::Point p : ring) {
          const int side = geometry::location(p, edge);
          is_inside = is_inside || side > 0;
          is_outside = is_outside || side < 0;
        }
      if (is_inside && is_outside) return true;
      return false;
    };
    for (const std::vector<Ring>& board : footprint_.boards)
      for (const Ring& edge : board)
        if (crosses(edge)) return true;
    for (const Ring& edge : footprint_.loose_cutouts)
      if (crosses(edge)) return true;
    return false;
  }

  void add_core(const Drill& drill, const BodyShape& rings, const ResolvedHoleRule& rule) {
    std::vector<Ring> inside = geometry::shrunk(rings.rings, rule.how.plating);
    if (inside.empty()) {
      diagnostics_.note(
          "compose.hole_plated_shut",
          fmt::format("a hole no wider than twice its plating of {} is solid copper", format_length(rule.how.plating)),
          {.file = board_.source(), .line = drill.line, .net = std::string(board_.net_name(drill.net))});
      return;
    }
    if (rule.how.fill == study::ViaFill::copper) return;
    if (plan_.rules.front().how.plating == study::HoleFill{}.plating)
      diagnostics_.assume(
          Severity::note, "compose.plating",
          fmt::format("the board does not state the plating of its holes; {} is taken", format_length(rule.how.plating)),
          {.file = board_.source()});
    SlabRange slabs{bottom_slab(drill.last_copper), top_slab(drill.first_copper)};
    if (rule.how.capped) slabs = {copper(drill.last_copper).high, copper(drill.first_copper).low - 1};
    if (slabs.last < slabs.first) return;
    const std::int32_t material = rule.how.fill == study::ViaFill::plugged ? rule.plug : stack_.air;
    cores_[{slabs.first, slabs.last, material}].push_back(
        {.rings = std::move(inside), .simple = rings.simple && rings.rings.size() == 1, .line = drill.line});
    keep_open(parts_, rule.how.plating);
  }

  /// Whole arrays of vias become solid blocks.
  void merge() {
    if (!study_.fabrication.merge_vias) return;
    merged_ = merge_vias(board_, study_, footprint_, *study_.fabrication.merge_vias);
    for (const MergedBlock& block : merged_.blocks) {
      BodyShape shape = shape_of(block.figure, study_, footprint_, block.line);
      if (!shape.rings.empty()) plated_[{block.first_copper, block.last_copper, block.net}].push_back(std::move(shape));
    }
    diagnostics_.note("compose.merged_vias",
                      fmt::format("{} vias are merged into {} blocks (pitch up to {}); {} vias stay alone, {} joints would "
                                  "have touched other copper and are left open",
                                  merged_.num_vias, merged_.num_blocks, format_length(*study_.fabrication.merge_vias),
                                  merged_.num_alone, merged_.num_refused),
                      {.file = board_.source()});
  }

  [[nodiscard]] const CopperPlace& copper(std::int32_t layer) const { return stack_.copper[static_cast<std::size_t>(layer)]; }
  [[nodiscard]] std::int32_t bottom_slab(std::int32_t layer) const { return copper(layer).low; }
  [[nodiscard]] std::int32_t top_slab(std::int32_t layer) const { return copper(layer).high - 1; }
  /// A hole from the outermost copper goes on through dielectric outside it.
  [[nodiscard]] SlabRange through(const Span& span) const {
    const auto last_copper = static_cast<std::int32_t>(board_.copper_layers().size()) - 1;
    return {span.second == last_copper ? stack_.first_board_slab : bottom_slab(span.second),
            span.first == 0 ? stack_.last_board_slab : top_slab(span.first)};
  }

  /// Air right through, one body per span.
  void append_air(Grouped<Span>& groups, std::string_view name, BodyKind kind, std::int32_t priority) {
    for (auto& [span, shapes] : groups) {
      const SlabRange slabs = through(span);
      if (slabs.last < slabs.first) continue;  // within one layer that has no slab
      append_body(parts_,
                  {.name = fmt::format("{} {} to {}", name, board_.copper_name(span.first), board_.copper_name(span.second)),
                   .kind = kind,
                   .material = stack_.air,
                   .first_slab = slabs.first,
                   .last_slab = slabs.last,
                   .priority = priority},
                  std::move(shapes));
    }
  }

  void append_barrels() {
    for (auto& [key, shapes] : plated_) {
      const auto [top, bottom, net] = key;
      if (top_slab(top) < bottom_slab(bottom)) continue;
      append_body(parts_,
                  {.name = fmt::format("barrel {} {} to {}", short_net_name(board_, net), board_.copper_name(top),
                                       board_.copper_name(bottom)),
                   .kind = BodyKind::barrel,
                   .material = material_of(board_, top),
                   .net = net,
                   .first_slab = bottom_slab(bottom),
                   .last_slab = top_slab(top),
                   .priority = barrel_priority,
                   .hollow = mode_of(study_, rules_, net, -1) == study::ConductorMode::hollow},
                  std::move(shapes));
    }
  }

  void append_cores() {
    for (auto& [core, shapes] : cores_)
      append_body(parts_,
                  {.name = fmt::format("inside of tubes, {}", core.material == stack_.air ? "air" : "plugged"),
                   .kind = BodyKind::filler,
                   .material = core.material,
                   .first_slab = core.first_slab,
                   .last_slab = core.last_slab,
                   .priority = core_priority},
                  std::move(shapes));
  }

  void append_backdrilled() {
    append_air(backdrilled_, "backdrill", BodyKind::filler, backdrill_priority);
    if (!plan_.backdrills.empty() && num_backdrilled_ == 0)
      diagnostics_.warn("compose.backdrill_unused", "no plated hole in the domain spans the layers of the study's backdrills",
                        {.file = board_.source()});
  }

  const Board& board_;
  const study::Study& study_;
  const std::vector<ResolvedRule>& rules_;
  const HolePlan& plan_;
  const Footprint& footprint_;
  const Stack& stack_;
  model::ModelParts& parts_;
  Diagnostics& diagnostics_;
  Grouped<Span> unplated_, backdrilled_;
  Grouped<std::array<std::int32_t, 3>> plated_;  ///< span, net
  Grouped<Core> cores_;
  MergedVias merged_;
  std::int64_t num_backdrilled_ = 0;
};

}  // namespace

void add_holes(const Board& board, const study::Study& study, const std::vector<ResolvedRule>& rules, const HolePlan& plan,
               const Footprint& footprint, const Stack& stack, model::ModelParts& parts, Diagnostics& diagnostics) {
  HoleBuilder(board, study, rules, plan, footprint, stack, parts, diagnostics).run();
}

}  // namespace pcbmesh::compose
