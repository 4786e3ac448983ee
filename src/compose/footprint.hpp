// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
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
  geometry::Box box;    ///< bounding box of the domain without perfectly matched layers
  geometry::Box outer;  ///< with them
  /// Sides xmin, xmax, ymin, ymax where what is at the side goes straight on beyond it: those with layers, and periodic ones.
  std::array<bool, 4> goes_on{};
  std::vector<geometry::Ring> domain;  ///< disjoint, counter-clockwise
  /// Per board: outer ring counter-clockwise, then the cut-outs inside it, clockwise, apart from one another and from it.
  std::vector<std::vector<geometry::Ring>> boards;
  std::vector<geometry::Ring> loose_cutouts;  ///< cut-outs that meet the outline or one another

  /// What of a ring matters: clipped a little outside the domain. Where `goes_on` says so it is clipped at the side, and what
  /// is there goes straight on: through matched layers; and across periodic sides, so that nothing beyond them matters. Empty
  /// if nothing is left.
  [[nodiscard]] geometry::Ring cut(geometry::Ring ring) const;
  /// Whether a point lies in the domain without matched layers, its edge included.
  [[nodiscard]] bool contains(geometry::Point p) const;
};

/// @param nets  resolved study.nets.
/// @throws Error region_empty (305), outline_invalid (302), study_invalid (102) for a domain beyond 1 m.
[[nodiscard]] Footprint build_footprint(const board::Board& board, const study::Study& study,
                                        std::span<const std::int32_t> nets, Diagnostics& diagnostics);

}  // namespace pcbmesh::compose
