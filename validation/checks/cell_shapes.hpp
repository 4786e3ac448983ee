// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "pcbmesh/mesh/mesh_data.hpp"

namespace pcbmesh::validation::checks {

/// One face of a cell: local corners, counter-clockwise seen from outside the cell.
struct LocalFace {
  int num_corners = 0;
  std::array<int, 4> corners{};
};

/// Edges at one corner whose triple product is positive in a right-handed cell.
struct CornerFrame {
  int at = 0, e1 = 0, e2 = 0, e3 = 0;
};

// Written from the definition of Gmsh's corner order (first face counter-clockwise seen from the opposite side), not
// taken over from the code that builds meshes.
inline constexpr std::array<LocalFace, 4> tetrahedron_faces{{{3, {0, 2, 1}}, {3, {0, 1, 3}}, {3, {1, 2, 3}}, {3, {2, 0, 3}}}};
inline constexpr std::array<LocalFace, 5> pyramid_faces{
    {{4, {0, 3, 2, 1}}, {3, {0, 1, 4}}, {3, {1, 2, 4}}, {3, {2, 3, 4}}, {3, {3, 0, 4}}}};
inline constexpr std::array<LocalFace, 5> wedge_faces{
    {{3, {0, 2, 1}}, {3, {3, 4, 5}}, {4, {0, 1, 4, 3}}, {4, {1, 2, 5, 4}}, {4, {2, 0, 3, 5}}}};
inline constexpr std::array<LocalFace, 6> hexahedron_faces{
    {{4, {0, 3, 2, 1}}, {4, {4, 5, 6, 7}}, {4, {0, 1, 5, 4}}, {4, {1, 2, 6, 5}}, {4, {2, 3, 7, 6}}, {4, {3, 0, 4, 7}}}};

inline constexpr std::array<CornerFrame, 1> tetrahedron_frames{{{0, 1, 2, 3}}};
// The apex of a pyramid has four edges and no Jacobian of its own.
inline constexpr std::array<CornerFrame, 4> pyramid_frames{{{0, 1, 3, 4}, {1, 2, 0, 4}, {2, 3, 1, 4}, {3, 0, 2, 4}}};
inline constexpr std::array<CornerFrame, 6> wedge_frames{
    {{0, 1, 2, 3}, {1, 2, 0, 4}, {2, 0, 1, 5}, {3, 5, 4, 0}, {4, 3, 5, 1}, {5, 4, 3, 2}}};
inline constexpr std::array<CornerFrame, 8> hexahedron_frames{
    {{0, 1, 3, 4}, {1, 2, 0, 5}, {2, 3, 1, 6}, {3, 0, 2, 7}, {4, 7, 5, 0}, {5, 4, 6, 1}, {6, 5, 7, 2}, {7, 6, 4, 3}}};

template <mesh::CellKind kind>
constexpr const auto& faces_of() {
  if constexpr (kind == mesh::CellKind::tetrahedron) {
    return tetrahedron_faces;
  } else if constexpr (kind == mesh::CellKind::pyramid) {
    return pyramid_faces;
  } else if constexpr (kind == mesh::CellKind::wedge) {
    return wedge_faces;
  } else {
    return hexahedron_faces;
  }
}

template <mesh::CellKind kind>
constexpr const auto& frames_of() {
  if constexpr (kind == mesh::CellKind::tetrahedron) {
    return tetrahedron_frames;
  } else if constexpr (kind == mesh::CellKind::pyramid) {
    return pyramid_frames;
  } else if constexpr (kind == mesh::CellKind::wedge) {
    return wedge_frames;
  } else {
    return hexahedron_frames;
  }
}

[[nodiscard]] inline std::span<const LocalFace> faces_of(mesh::CellKind kind) {
  switch (kind) {
    case mesh::CellKind::tetrahedron:
      return tetrahedron_faces;
    case mesh::CellKind::pyramid:
      return pyramid_faces;
    case mesh::CellKind::wedge:
      return wedge_faces;
    default:
      return hexahedron_faces;
  }
}

/// Calls visit.template operator()<kind>() for a kind known at run time only, so that inner loops are unrolled per kind.
template <class Visit>
decltype(auto) with_kind(mesh::CellKind kind, Visit&& visit) {
  switch (kind) {
    case mesh::CellKind::tetrahedron:
      return visit.template operator()<mesh::CellKind::tetrahedron>();
    case mesh::CellKind::pyramid:
      return visit.template operator()<mesh::CellKind::pyramid>();
    case mesh::CellKind::wedge:
      return visit.template operator()<mesh::CellKind::wedge>();
    default:
      return visit.template operator()<mesh::CellKind::hexahedron>();
  }
}

}  // namespace pcbmesh::validation::checks
