// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "validation/checks/cell_shapes.hpp"
#include "validation/checks/context.hpp"

namespace pcbmesh::validation::checks {

/// Volume as a sum over the faces, seen from the first corner to keep it exact for small cells far from the origin.
template <mesh::CellKind kind>
double volume_of(const std::array<Vector3, 8>& at) {
  double six_volumes = 0;
  for (const LocalFace& face : faces_of<kind>()) {
    const auto point = [&](std::size_t i) { return at[static_cast<std::size_t>(face.corners[i])] - at[0]; };
    six_volumes += face.num_corners == 3 ? flux(point(0), point(1), point(2)) : flux(point(0), point(1), point(2), point(3));
  }
  return six_volumes / 6;
}

/// Corners of cell `index` of a block.
template <mesh::CellKind kind>
std::array<Vector3, 8> points_of(const Context& context, const mesh::CellBlock& block, std::size_t index) {
  constexpr auto n = static_cast<std::size_t>(mesh::corners_of(kind));
  std::array<Vector3, 8> at{};
  for (std::size_t k = 0; k < n; ++k) at[k] = context.mesh.nodes[static_cast<std::size_t>(block.corners[index * n + k])];
  return at;
}

/// Vector of twice the area of a triangle, or of a quadrangle by its diagonals (exact for a flat one); outwards.
template <mesh::CellKind kind>
Vector3 twice_area_of(const std::array<Vector3, 8>& at, const LocalFace& face) {
  const auto point = [&](std::size_t i) -> const Vector3& { return at[static_cast<std::size_t>(face.corners[i])]; };
  return face.num_corners == 3 ? cross(point(1) - point(0), point(2) - point(0))
                               : cross(point(2) - point(0), point(3) - point(1));
}

}  // namespace pcbmesh::validation::checks
