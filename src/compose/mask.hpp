// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pcbmesh/base/diagnostics.hpp"
#include "pcbmesh/board/board.hpp"
#include "pcbmesh/model/model.hpp"
#include "pcbmesh/study/study.hpp"
#include "src/compose/footprint.hpp"
#include "src/compose/stack.hpp"

namespace pcbmesh::compose {

/// Films of solder mask over outer copper, and their openings over pads. Boards do not say where the mask is open: pads are
/// taken as bare to their edge, everything else, vias too, as covered. The gaps beside copper are the slabs' own business.
void add_mask(const board::Board& board, const study::Study& study, const Footprint& footprint, const Stack& stack,
              model::ModelParts& parts, Diagnostics& diagnostics);

}  // namespace pcbmesh::compose
