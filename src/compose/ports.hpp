// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "pcbmesh/board/board.hpp"
#include "pcbmesh/compose/compose.hpp"
#include "pcbmesh/model/model.hpp"
#include "pcbmesh/study/study.hpp"
#include "src/compose/bodies.hpp"
#include "src/compose/footprint.hpp"
#include "src/compose/stack.hpp"

namespace pcbmesh::compose {

/// Places the study's ports: appends their footprints as bodies, and the ports themselves. What cannot be placed goes into
/// `faults`, each with the port's name, its place and a way out.
/// @param stack  its slabs and materials are still there.
void add_ports(const board::Board& board, const study::Study& study, const std::vector<ResolvedRule>& rules,
               const Footprint& footprint, const Stack& stack, model::ModelParts& parts, std::vector<study::Fault>& faults);

/// Every place of the nets where a port may be, with the port found there or why there is none; those found first, end by end.
[[nodiscard]] std::vector<PortProposal> find_ports(const board::Board& board, const study::Study& study,
                                                   const std::vector<ResolvedRule>& rules, const Footprint& footprint,
                                                   const Stack& stack, std::span<const std::int32_t> nets, PortPlaces places);

/// Names those that can be placed, in their order.
void name_ports(std::vector<PortProposal>& proposals);

}  // namespace pcbmesh::compose
