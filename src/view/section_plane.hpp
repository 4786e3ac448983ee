// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>

#include "pcbmesh/view/skin.hpp"

namespace pcbmesh::view {

/// Section planes are moved by so much, so that none runs through the corners and edges of a board drawn on the nanometre grid:
/// a plane that lies in a wall would have to choose between two answers. No picture shows it.
inline constexpr double off_grid_m = 3.7e-11;

/// Depth of a coordinate above the plane.
inline double above(const SectionPlane& plane, double coordinate_m) {
  return coordinate_m - (plane.at_m + off_grid_m);
}

/// What the plane leaves of a convex polygon.
inline SkinPolygon cut(const SkinPolygon& whole, const SectionPlane& plane) {
  const auto axis = static_cast<std::size_t>(plane.axis);
  const auto index = [](int i) { return static_cast<std::size_t>(i); };
  const auto inside = [&](const std::array<double, 3>& p) {
    return plane.keep_above ? above(plane, p[axis]) : -above(plane, p[axis]);
  };
  SkinPolygon out;
  for (int i = 0; i < whole.size; ++i) {
    const auto &p = whole.corners[index(i)], &q = whole.corners[index((i + 1) % whole.size)];
    const double dp = inside(p), dq = inside(q);
    if (dp >= 0) out.corners[index(out.size++)] = p;
    if ((dp > 0 && dq < 0) || (dp < 0 && dq > 0)) {
      const double s = dp / (dp - dq);
      for (std::size_t k = 0; k < 3; ++k) out.corners[index(out.size)][k] = p[k] + s * (q[k] - p[k]);
      out.corners[index(out.size++)][axis] = plane.at_m;
    }
  }
  if (out.size < 3) out.size = 0;
  return out;
}

}  // namespace pcbmesh::view
