// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "pcbmesh/base/diagnostics.hpp"
#include "pcbmesh/board/board.hpp"
#include "pcbmesh/model/model.hpp"
#include "pcbmesh/study/study.hpp"
#include "src/compose/materials.hpp"

namespace pcbmesh::compose {

/// Adjacent slabs, both included.
struct SlabRange {
  std::int32_t first = 0, last = 0;
};

/// Where a copper layer lies, in faces: face f is the bottom of slab f.
struct CopperPlace {
  std::int32_t low = 0;    ///< its bottom
  std::int32_t high = 0;   ///< its top; equal to low where the layer has no slab
  std::int32_t sheet = 0;  ///< where its sheets lie
  [[nodiscard]] bool has_slab() const { return high > low; }
};

/// Part of a copper layer's height in which its copper is equally wide.
struct CopperSlice {
  SlabRange slabs;
  Nm inset = 0;  ///< by which either edge is pulled in (etching); 0 = as drawn
};

/// Solder mask on one side of the board: slabs outside the copper.
struct MaskSlabs {
  SlabRange slabs;                ///< outside the outer copper
  std::int32_t film = -1;         ///< the one of them that holds mask over copper only, if any; the other holds it everywhere
  std::int32_t copper_layer = 0;  ///< the outer copper it lies on
  std::int32_t material = -1;     ///< of the mask
};

/// The board's layers as slabs.
struct Stack {
  std::int32_t air = -1;                                ///< index into materials
  std::int32_t outside = -1;                            ///< air, or -1 where the study asks for no air at all
  std::vector<model::Slab> slabs;                       ///< bottom to top
  std::vector<CopperPlace> copper;                      ///< of copper layer i; i counts from the top
  std::vector<std::vector<CopperSlice>> copper_slices;  ///< of copper layer i, bottom to top; together its slabs, if it has any
  std::vector<MaskSlabs> masks;
  std::int32_t first_board_slab = 0;  ///< lowest slab of the board itself
  std::int32_t last_board_slab = 0;   ///< highest
};

/// Which side the gaps of a copper layer are filled from.
enum class FillSide { automatic, above, below, material };

struct ResolvedFill {
  FillSide side = FillSide::automatic;
  std::int32_t material = -1;  ///< side material
};

/// Solder mask is meshed if the study asks for it, else left out and noted. A gap in copper is filled as `fills` says (one
/// per copper layer); automatic = by the neighbouring dielectric: the one called prepreg if exactly one of the two is, else
/// the one below; by air, or mask as high as it lies, on the outer faces of the stack.
///
/// Etched copper is narrow on the side that its gaps are filled from: foil is laid on the core and etched from the other side.
///
/// @param only_sheets  per copper layer: it has no slab, its sheets lie between its neighbours. Elsewhere sheets lie on the
/// face away from what fills the gaps: the core that the copper was etched on.
/// @throws Error stackup_invalid (303) if nothing has any height.
[[nodiscard]] Stack build_stack(const board::Board& board, const study::Study& study, const std::vector<char>& only_sheets,
                                const std::vector<ResolvedFill>& fills, MaterialTable& materials, Diagnostics& diagnostics);

}  // namespace pcbmesh::compose
