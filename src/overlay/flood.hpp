// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "pcbmesh/base/progress.hpp"
#include "src/overlay/edge_graph.hpp"

namespace pcbmesh::overlay {

/// Faces of a planar edge graph and the windings in them.
struct Faces {
  std::vector<std::int32_t> left, right;  ///< per edge: face beside u -> v
  std::vector<std::int32_t> state;        ///< per face: label id of the windings; face 0 is the outside, with none
};

/// Walks the faces and sums the labels from the outside in. Islands are placed by a ray to the edge below them, so the
/// graph need not be connected.
///
/// @param graph  planar: edges meet at common ends only; normalised.
/// @throws Error internal (901) if windings do not close.
/// @cost O(n log n).
[[nodiscard]] Faces flood(const EdgeGraph& graph, LabelPool& labels, const Progress& progress);

/// Turns windings into memberships: positive becomes 1, the rest goes. @return faces that had another value than 0 or 1.
std::int64_t keep_positive(Faces& faces, LabelPool& labels);

}  // namespace pcbmesh::overlay
