// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "pcbmesh/geometry/path.hpp"

namespace pcbmesh::formats::native_json {

struct Disc {
  geometry::Point centre;
  Nm radius = 0;
};

/// Outer boundary of discs that overlap.
struct DiscCluster {
  std::vector<std::size_t> members;    ///< ascending indices of the discs
  std::optional<geometry::Path> path;  ///< closed, arcs, counter-clockwise; nullopt where three circles meet in one point
};

/// Groups discs that overlap and joins each group's outline. What the outline encloses counts as covered: a scrap of copper
/// cut off all round is no copper. Corners are rounded to the nanometre. @cost O(n^2) in the size of one group.
[[nodiscard]] std::vector<DiscCluster> unite(const std::vector<Disc>& discs);

}  // namespace pcbmesh::formats::native_json
