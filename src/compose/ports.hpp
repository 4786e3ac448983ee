// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "pcbmesh/board/board.hpp"
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

}  // namespace pcbmesh::compose
