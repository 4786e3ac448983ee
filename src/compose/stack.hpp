// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "pcbmesh/base/diagnostics.hpp"
#include "pcbmesh/board/board.hpp"
#include "pcbmesh/model/model.hpp"
#include "pcbmesh/study/study.hpp"

namespace pcbmesh::compose {

/// Where a copper layer lies, in faces: face f is the bottom of slab f.
struct CopperPlace {
  std::int32_t low = 0;    ///< its bottom
  std::int32_t high = 0;   ///< its top; equal to low where the layer has no slab
  std::int32_t sheet = 0;  ///< where its sheets lie
  [[nodiscard]] bool has_slab() const { return high > low; }
};

/// The board's layers as slabs.
struct Stack {
  std::vector<board::Material> materials;  ///< the board's, and air
  std::int32_t air = -1;                   ///< index into materials
  std::int32_t outside = -1;               ///< air, or -1 where the study asks for no air at all
  std::vector<model::Slab> slabs;          ///< bottom to top
  std::vector<CopperPlace> copper;         ///< of copper layer i; i counts from the top
  std::int32_t first_board_slab = 0;       ///< lowest slab of the board itself
  std::int32_t last_board_slab = 0;        ///< highest
};

/// Solder mask is left out and noted. A gap in copper is filled by the neighbouring dielectric: the one called prepreg if
/// exactly one of the two is, else the one below; by air on the outer faces of the stack.
/// @param only_sheets  per copper layer: it has no slab, its sheets lie between its neighbours. Elsewhere sheets lie on the
/// face away from what fills the gaps: the core that the copper was etched on.
/// @throws Error stackup_invalid (303) if nothing has any height.
[[nodiscard]] Stack build_stack(const board::Board& board, const study::Study& study, const std::vector<char>& only_sheets,
                                Diagnostics& diagnostics);

}  // namespace pcbmesh::compose
