// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "pcbmesh/geometry/point.hpp"

namespace pcbmesh::geometry {

/// Sets of the plane as rings: covered where the winding number is not zero. Results are simple: outer rings
/// counter-clockwise, holes clockwise, on the nanometre grid; crossings are rounded to it.

/// What any ring covers. @cost O(n log n).
[[nodiscard]] std::vector<Ring> united(const std::vector<Ring>& rings);
/// What both cover.
[[nodiscard]] std::vector<Ring> intersected(const std::vector<Ring>& a, const std::vector<Ring>& b);
/// What `a` covers and `b` does not.
[[nodiscard]] std::vector<Ring> subtracted(const std::vector<Ring>& a, const std::vector<Ring>& b);
/// The union, every outline moved inwards by `by` > 0 with its corners kept sharp; parts narrower than 2 by vanish.
[[nodiscard]] std::vector<Ring> shrunk(const std::vector<Ring>& rings, Nm by);
/// Area covered, mm^2.
[[nodiscard]] double covered_mm2(const std::vector<Ring>& rings);

}  // namespace pcbmesh::geometry
