// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "pcbmesh/base/diagnostics.hpp"
#include "pcbmesh/board/board.hpp"
#include "pcbmesh/model/model.hpp"
#include "pcbmesh/study/study.hpp"
#include "src/compose/bodies.hpp"
#include "src/compose/footprint.hpp"
#include "src/compose/stack.hpp"

namespace pcbmesh::compose {

/// A study's rule for holes with its names resolved.
struct ResolvedHoleRule {
  bool any_net = true;
  std::int32_t net = board::no_net;
  study::HoleKind kind = study::HoleKind::any;
  study::HoleFill how{};
  std::int32_t plug = -1;  ///< material, if plugged
};

/// A study's backdrill with its names resolved.
struct ResolvedBackdrill {
  bool any_net = true;
  std::int32_t net = board::no_net;
  std::int32_t first_copper = 0, last_copper = 0;
  Nm oversize = 0;
};

struct HolePlan {
  std::vector<ResolvedHoleRule> rules;  ///< the first is about all holes; later ones win
  std::vector<ResolvedBackdrill> backdrills;
};

/// Unplated holes, one body per span; barrels, one per (span, net); what is inside tubes, one per (span, material); at last
/// backdrilled holes, one per span.
///
/// A tube is a barrel with a core. Hollow barrels stay whole: the bore of a via is a waveguide far below cut-off, and
/// meshing it would buy nothing. Plated holes that the board outline cuts (castellations) are tubes whatever the rules say.
/// Backdrilled holes run from the face of the board to the far one of their copper layers, and take all copper with them.
void add_holes(const board::Board& board, const study::Study& study, const std::vector<ResolvedRule>& rules,
               const HolePlan& plan, const Footprint& footprint, const Stack& stack, model::ModelParts& parts,
               Diagnostics& diagnostics);

}  // namespace pcbmesh::compose
