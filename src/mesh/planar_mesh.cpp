// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/mesh/planar_mesh.hpp"

#include <utility>

#include "pcbmesh/base/error.hpp"

namespace pcbmesh::mesh {

PlanarMesh PlanarMesh::from_parts(PlanarMeshParts parts) {
  PlanarMesh mesh;
  PCBMESH_ASSERT(parts.regions.size() == parts.triangles.size() && !parts.region_body_offsets.empty() &&
                 static_cast<std::size_t>(parts.region_body_offsets.back()) == parts.region_bodies.size());
  const auto num_regions = static_cast<std::int32_t>(parts.region_body_offsets.size()) - 1;
  std::vector<char> used(parts.points_m.size(), 0);
  for (std::size_t t = 0; t < parts.triangles.size(); ++t) {
    for (std::int32_t v : parts.triangles[t]) {
      PCBMESH_ASSERT(v >= 0 && static_cast<std::size_t>(v) < used.size());
      used[static_cast<std::size_t>(v)] = 1;
    }
    PCBMESH_ASSERT(parts.regions[t] >= 0 && parts.regions[t] < num_regions);
  }
  for (char is_used : used) PCBMESH_ASSERT(is_used != 0);
  mesh.parts_ = std::make_shared<const PlanarMeshParts>(std::move(parts));
  for (std::int32_t t = 0; t < mesh.num_triangles(); ++t) PCBMESH_ASSERT(mesh.area_m2(t) > 0);
  return mesh;
}

std::span<const std::int32_t> PlanarMesh::bodies_of_region(std::int32_t region) const {
  const auto r = static_cast<std::size_t>(region);
  const auto first = static_cast<std::size_t>(parts_->region_body_offsets[r]),
             last = static_cast<std::size_t>(parts_->region_body_offsets[r + 1]);
  return std::span(parts_->region_bodies).subspan(first, last - first);
}

double PlanarMesh::area_m2(std::int32_t t) const {
  const auto& [a, b, c] = parts_->triangles[static_cast<std::size_t>(t)];
  const auto &p = parts_->points_m[static_cast<std::size_t>(a)], &q = parts_->points_m[static_cast<std::size_t>(b)],
             &r = parts_->points_m[static_cast<std::size_t>(c)];
  return 0.5 * ((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]));
}

std::array<double, 3> PlanarMesh::squared_edges_m2(std::int32_t t) const {
  const auto& corners = parts_->triangles[static_cast<std::size_t>(t)];
  const auto squared = [&](int i, int j) {
    const auto &p = parts_->points_m[static_cast<std::size_t>(corners[static_cast<std::size_t>(i)])],
               &q = parts_->points_m[static_cast<std::size_t>(corners[static_cast<std::size_t>(j)])];
    const double dx = q[0] - p[0], dy = q[1] - p[1];
    return dx * dx + dy * dy;
  };
  return {squared(1, 2), squared(2, 0), squared(0, 1)};
}

}  // namespace pcbmesh::mesh
