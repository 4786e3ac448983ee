// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "pcbmesh/mesh/prism_mesh.hpp"

namespace pcbmesh::view {

/// Between which cells a face shows. Faces between a shown cell and nothing, void or a hidden cell always do.
enum class SkinMode {
  outer,      ///< nothing else: the closed surface of all that is shown
  materials,  ///< cells of different materials: each material is closed
  groups,     ///< cells of different volume groups: each group is closed
  layers,     ///< cells of different layers: each layer is closed, for exploded views
};

/// Plane square to an axis. What lies beyond it is cut away, and the cut shows.
struct SectionPlane {
  int axis = 0;  ///< 0 x, 1 y, 2 z
  double at_m = 0;
  bool keep_above = false;  ///< keep the side of greater coordinates instead of the lower one
};

/// What is to be seen.
struct Visibility {
  SkinMode mode = SkinMode::outer;
  std::vector<char> hidden_groups;               ///< per volume tag: not 0 = hidden; empty = all shown
  std::optional<std::array<double, 4>> box_m{};  ///< xmin, ymin, xmax, ymax: only triangles whose centre is inside
  std::optional<SectionPlane> section{};
};

enum class SkinFaceKind : std::uint8_t { up, down, wall, section };

/// One visible face: a triangle facing up or down, a wall over one planar edge through a whole slab, or what a section plane
/// lays open of one triangle in one slab.
struct SkinFace {
  SkinFaceKind kind = SkinFaceKind::up;
  std::int32_t slab = 0;      ///< of the cell whose face it is
  std::int32_t triangle = 0;  ///< of that cell
  std::int32_t a = -1;        ///< wall: planar edge a -> b, the cell to its left
  std::int32_t b = -1;
  std::int32_t group = 0;       ///< index into volume_tags
  std::int32_t neighbour = -1;  ///< group on the other side if shown, else -1
};

using SkinVisitor = std::function<void(std::span<const SkinFace>)>;

/// Calls `visit` with the visible faces, in blocks: caps by level and triangle, walls by edge and slab, then the section.
/// Faces are those of whole slabs; a wall stands for one quadrilateral per sub-layer.
///
/// @guarantee V1  outer, no section: the faces used by exactly one shown prism, each once
/// @guarantee V2  materials, groups, layers: the same of every material, group or layer on its own
/// @guarantee V3  memory O(planar mesh + regions x slabs), never O(prisms); the same faces in the same order every time
/// @cost O(triangles x slabs) byte comparisons, one pass over the planar edges.
void visit_skin(const mesh::PrismMesh& mesh, const Visibility& visibility, const SkinVisitor& visit);

/// Visible faces as a solver's file would count them: a wall counts once per sub-layer.
struct SkinCount {
  std::int64_t num_triangles = 0, num_quads = 0;
};
[[nodiscard]] SkinCount count_skin(const mesh::PrismMesh& mesh, const Visibility& visibility);

/// Corners of a visible face in metres, counter-clockwise seen from outside, cut off at the section plane.
struct SkinPolygon {
  std::array<std::array<double, 3>, 6> corners{};
  int size = 0;  ///< 0 = wholly cut away
};
[[nodiscard]] SkinPolygon polygon_of(const mesh::PrismMesh& mesh, const Visibility& visibility, const SkinFace& face);

/// z of the bottom and the top of a slab, metres.
[[nodiscard]] std::array<double, 2> slab_z_m(const mesh::PrismMesh& mesh, std::int32_t slab);

/// Volume groups of air: material without loss or conductivity, relative constants 1, and no net. The usual thing to hide.
[[nodiscard]] std::vector<char> air_groups(const mesh::PrismMesh& mesh);

}  // namespace pcbmesh::view
