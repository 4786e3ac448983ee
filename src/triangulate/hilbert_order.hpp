// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace pcbmesh::triangulate {

/// Indices of the points in the order of a Hilbert curve over their bounding box (65536 x 65536 cells), ties by index.
/// Neighbours on the plane are then neighbours in memory. @cost O(n).
[[nodiscard]] std::vector<std::uint32_t> hilbert_order(std::span<const std::array<float, 2>> points);

}  // namespace pcbmesh::triangulate
