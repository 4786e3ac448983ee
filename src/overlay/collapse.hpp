// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "pcbmesh/base/progress.hpp"
#include "src/overlay/edge_graph.hpp"

namespace pcbmesh::overlay {

struct CollapseLimits {
  double deviation_nm = 0;  ///< largest distance between old and new outline
  double clearance_nm = 0;  ///< new edges keep this distance from everything else
};

/// Marks on points.
inline constexpr std::uint8_t free_point = 0;
inline constexpr std::uint8_t run_end = 1;      ///< where outlines shared with another sheet begin and end
inline constexpr std::uint8_t fixed_point = 2;  ///< never moved

/// Fewer vertices, same areas: a-b-c-d becomes a-e-d with e so placed that areas on both sides stay the same. Vertices where
/// more than two edges meet, and fixed ones, stay. Smallest deviation first; a collapse that would sweep over or come too
/// near to another vertex or edge is left out, so the topology cannot change.
///
/// @param graph  planar, normalised. @param marks  per point; runs between run ends are simplified first, so that
/// outlines two sheets have in common stay common.
/// @source Kronenfeld, Stanislawski, Buttenfield, Brockmeyer 2020, "Simplification of polylines by segment collapse:
/// minimizing areal displacement while preserving area".
/// @cost O(n log n).
[[nodiscard]] EdgeGraph collapse(const EdgeGraph& graph, const std::vector<std::uint8_t>& marks, const CollapseLimits& limits,
                                 LabelPool& labels, const Progress& progress);

}  // namespace pcbmesh::overlay
