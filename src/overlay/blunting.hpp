// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "src/overlay/census.hpp"
#include "src/overlay/noding.hpp"

namespace pcbmesh::overlay {

struct BluntLimits {
  double angle_deg = 30;
  double width_nm = 0;
  std::vector<std::int32_t> spared;  ///< bodies whose outlines are left alone, ascending
};

/// Two edges that leave a vertex at a smaller angle run together until they are `width` apart; needle tips of one body cancel
/// that way. Not done where the edge that gives way faces a neck of the same body narrower than about three widths, where
/// two nets would come to share an edge, or where the edge is domain or board outline.
///
/// @return number of angles blunted; the noder must settle afterwards.
[[nodiscard]] std::int64_t blunt(Noder& noder, const BluntLimits& limits, const Conductors& conductors);

}  // namespace pcbmesh::overlay
