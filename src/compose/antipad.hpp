// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "pcbmesh/board/board.hpp"

namespace pcbmesh::compose {

/// The round gap between a plane and the hole that passes it, or why there is none.
struct Antipad {
  std::int32_t net = board::no_net;                 ///< of the plane
  geometry::Ring outer, inner;                      ///< counter-clockwise: edge of the plane; edge of the barrel or of its pad
  double outer_radius_nm = 0, inner_radius_nm = 0;  ///< of discs of the same area
  std::string reason{};                             ///< empty: it is there
};

/// @param reference  the plane's net; empty = the net whose copper is nearest all round.
/// @cost O(n log n) of the shapes within a few millimetres.
[[nodiscard]] Antipad find_antipad(const board::Board& board, const geometry::ArcOptions& arcs, const board::Drill& hole,
                                   std::int32_t layer, std::optional<std::int32_t> reference);

}  // namespace pcbmesh::compose
