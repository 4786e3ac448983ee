// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pcbmesh/base/diagnostics.hpp"
#include "pcbmesh/board/board.hpp"
#include "pcbmesh/geometry/point.hpp"
#include "pcbmesh/study/study.hpp"

namespace pcbmesh::compose {

/// The meshed part of the plane and the board in it.
struct Footprint {
  geometry::Box box;                   ///< bounding box of the domain
  geometry::Box clip;                  ///< a little larger: nothing outside it matters
  std::vector<geometry::Ring> domain;  ///< disjoint, counter-clockwise
  /// Per board: outer ring counter-clockwise, then the cut-outs inside it, clockwise, apart from one another and from it.
  std::vector<std::vector<geometry::Ring>> boards;
  std::vector<geometry::Ring> loose_cutouts;  ///< cut-outs that meet the outline or one another
};

/// @param nets  resolved study.nets.
/// @throws Error region_empty (305), outline_invalid (302), study_invalid (102) for a domain beyond 1 m.
[[nodiscard]] Footprint build_footprint(const board::Board& board, const study::Study& study,
                                        std::span<const std::int32_t> nets, Diagnostics& diagnostics);

/// The ring clipped to the box if it reaches out of it; empty if nothing is left.
[[nodiscard]] geometry::Ring clipped(geometry::Ring ring, const geometry::Box& box);

}  // namespace pcbmesh::compose
