// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace pcbmesh::mesh {

struct PlanarMeshParts {
  std::vector<std::array<double, 2>> points_m;           ///< metres
  std::vector<std::array<std::int32_t, 3>> triangles;    ///< counter-clockwise
  std::vector<std::int32_t> regions;                     ///< per triangle: region id
  std::vector<std::array<std::int32_t, 2>> constrained;  ///< constrained edges, u < v, sorted
  std::vector<std::int32_t> region_body_offsets;         ///< num_regions + 1
  std::vector<std::int32_t> region_bodies;               ///< bodies present, ascending per region
};

/// Constrained Delaunay triangulation of the projected board. Triangles outside the domain body are absent.
///
/// @guarantee P1  every graph edge inside the domain is a union of constrained mesh edges
/// @guarantee P2  triangles are counter-clockwise with positive area and every point is used (checked)
/// @guarantee P3  regions are dense 0..num_regions-1; two triangles joined by an unconstrained edge share their region
class PlanarMesh {
 public:
  /// @throws Error internal (901). @cost O(triangles).
  [[nodiscard]] static PlanarMesh from_parts(PlanarMeshParts parts);
  [[nodiscard]] std::int32_t num_points() const { return static_cast<std::int32_t>(parts_->points_m.size()); }
  [[nodiscard]] std::int32_t num_triangles() const { return static_cast<std::int32_t>(parts_->triangles.size()); }
  [[nodiscard]] std::int32_t num_regions() const { return static_cast<std::int32_t>(parts_->region_body_offsets.size()) - 1; }
  [[nodiscard]] std::span<const std::array<double, 2>> points_m() const { return parts_->points_m; }
  [[nodiscard]] std::span<const std::array<std::int32_t, 3>> triangles() const { return parts_->triangles; }
  [[nodiscard]] std::span<const std::int32_t> regions() const { return parts_->regions; }
  [[nodiscard]] std::span<const std::array<std::int32_t, 2>> constrained() const { return parts_->constrained; }
  [[nodiscard]] std::span<const std::int32_t> bodies_of_region(std::int32_t region) const;
  /// Signed area of triangle t, m^2.
  [[nodiscard]] double area_m2(std::int32_t t) const;
  /// Squared edge lengths of triangle t, m^2, opposite to corner 0, 1, 2.
  [[nodiscard]] std::array<double, 3> squared_edges_m2(std::int32_t t) const;

 private:
  std::shared_ptr<const PlanarMeshParts> parts_;
};

}  // namespace pcbmesh::mesh
