// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

#include "validation/checks/vector3.hpp"

namespace pcbmesh::validation::checks {

/// Sign of triple(b - a, c - a, d - a) by exact arithmetic: what rounding can't tell.
[[nodiscard]] int orientation_exact(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d);

/// 1 if d lies on the side of the plane from which a, b, c go counter-clockwise, -1 on the other, 0 in the plane. Exact:
/// doubles answer where their rounding is known to be smaller than the result.
[[nodiscard]] inline int orientation(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  // Shewchuk 1997, theorem 14 (orient3d, stage A): rounding is at most (7 + 56 e) e times the sum of all terms' magnitudes.
  constexpr double bound = 7.78e-16, least_safe = 1e-280;
  const Vector3 p = b - a, q = c - a, r = d - a;
  const double xy = p[0] * q[1], yx = p[1] * q[0], yz = p[1] * q[2], zy = p[2] * q[1], zx = p[2] * q[0], xz = p[0] * q[2];
  const double volume = (yz - zy) * r[0] + (zx - xz) * r[1] + (xy - yx) * r[2];
  const double magnitude = (std::abs(yz) + std::abs(zy)) * std::abs(r[0]) + (std::abs(zx) + std::abs(xz)) * std::abs(r[1]) +
                           (std::abs(xy) + std::abs(yx)) * std::abs(r[2]);
  // Not so for infinities, nor where terms may have vanished below the smallest double.
  if (magnitude > least_safe && std::abs(volume) > bound * magnitude && std::isfinite(magnitude)) return volume > 0 ? 1 : -1;
  return orientation_exact(a, b, c, d);
}

}  // namespace pcbmesh::validation::checks
