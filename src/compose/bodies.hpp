// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pcbmesh/base/diagnostics.hpp"
#include "pcbmesh/board/board.hpp"
#include "pcbmesh/model/model.hpp"
#include "pcbmesh/study/study.hpp"
#include "src/compose/footprint.hpp"
#include "src/compose/stack.hpp"

namespace pcbmesh::compose {

/// Priorities of bodies where they overlap; the highest wins.
inline constexpr std::int32_t copper_priority = 2;
inline constexpr std::int32_t mask_priority = 1;  ///< in slabs of its own, below its openings
inline constexpr std::int32_t hole_priority = 3;  ///< unplated holes
inline constexpr std::int32_t barrel_priority = 4;
inline constexpr std::int32_t core_priority = 5;       ///< what is inside a barrel
inline constexpr std::int32_t backdrill_priority = 6;  ///< drilled when all else is done
inline constexpr std::int32_t cutout_priority = 7;

/// A study's conductor rule with its names resolved.
struct ResolvedRule {
  bool any_net = true;
  std::int32_t net = board::no_net;
  bool any_layer = true;
  std::int32_t copper_layer = -1;
  study::ConductorMode mode = study::ConductorMode::solid;
};

/// Mode of one net on one copper layer; copper_layer -1 = barrels, which are hollow where sheets are asked for.
[[nodiscard]] study::ConductorMode mode_of(const study::Study& study, const std::vector<ResolvedRule>& rules, std::int32_t net,
                                           std::int32_t copper_layer);

/// Copper layers whose conductors in the footprint are sheets, all of them; without any, those meant to have sheets.
[[nodiscard]] std::vector<char> find_sheet_layers(const board::Board& board, const study::Study& study,
                                                  const std::vector<ResolvedRule>& rules, const Footprint& footprint);

/// Bodies 0 and 1, and loose cut-outs as holes of what lies outside the board.
void add_domain_and_board(const Footprint& footprint, const Stack& stack, model::ModelParts& parts);

/// Rings of a figure, clipped; a convex ring stays simple when clipped, another keeps its mark.
[[nodiscard]] model::BodyShape shape_of(const geometry::Figure& figure, const study::Study& study, const Footprint& footprint,
                                        std::int64_t line);
/// Net name, or "none".
[[nodiscard]] std::string_view short_net_name(const board::Board& board, std::int32_t net);
void append_body(model::ModelParts& parts, model::Body body, std::vector<model::BodyShape> shapes);
/// Material of a copper layer.
[[nodiscard]] std::int32_t material_of(const board::Board& board, std::int32_t copper_layer);
/// Takes a width into account that the overlay must not close.
void keep_open(model::ModelParts& parts, Nm width);

/// One body per (copper layer, net, slice) with copper in the domain, top layer first, nets ascending, copper without net
/// first.
void add_copper(const board::Board& board, const study::Study& study, const std::vector<ResolvedRule>& rules,
                const Footprint& footprint, const Stack& stack, model::ModelParts& parts, Diagnostics& diagnostics);

/// Smallest track width, pad width and hole diameter in the domain, and the same among parts.nets_of_interest.
void measure_narrowest(const board::Board& board, const Footprint& footprint, model::ModelParts& parts);

/// Circles of everything drawn inside the footprint, for elements of second order. None unless arcs are inscribed: only then do
/// the corners of chords lie on them.
void add_circles(const board::Board& board, const study::Study& study, const Footprint& footprint, model::ModelParts& parts);

}  // namespace pcbmesh::compose
