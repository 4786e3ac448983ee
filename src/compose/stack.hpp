// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "pcbmesh/base/diagnostics.hpp"
#include "pcbmesh/board/board.hpp"
#include "pcbmesh/model/model.hpp"
#include "pcbmesh/study/study.hpp"

namespace pcbmesh::compose {

/// The board's layers as slabs.
struct Stack {
  std::vector<board::Material> materials;  ///< the board's, and air
  std::int32_t air = -1;                   ///< index into materials
  std::int32_t outside = -1;               ///< air, or -1 where the study asks for no air at all
  std::vector<model::Slab> slabs;          ///< bottom to top
  std::vector<std::int32_t> copper_slab;   ///< slab of copper layer i; i counts from the top
  std::int32_t first_board_slab = 0;       ///< lowest slab of the board itself
  std::int32_t last_board_slab = 0;        ///< highest
};

/// Solder mask is left out and noted. A gap in copper is filled by the neighbouring dielectric: the one called prepreg if
/// exactly one of the two is, else the one below; by air on the outer faces of the stack.
[[nodiscard]] Stack build_stack(const board::Board& board, const study::Study& study, Diagnostics& diagnostics);

}  // namespace pcbmesh::compose
