// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pcbmesh/mesh/planar_edges.hpp"
#include "pcbmesh/mesh/prism_mesh.hpp"
#include "pcbmesh/model/model.hpp"
#include "src/extrude/columns.hpp"

namespace pcbmesh::extrude {

/// Whether a vertex lies on a segment, as nearly as vertices rounded to the nanometre grid can.
[[nodiscard]] bool is_on_segment(const std::array<double, 2>& p, geometry::Point from, geometry::Point to);

/// Where ports lie in the plane.
class PortFootprints {
 public:
  PortFootprints(const mesh::PlanarMesh& planar, const model::Model& model);
  /// Port whose wall stands on the edge, or -1.
  [[nodiscard]] std::int32_t on_line(const mesh::PlanarEdge& edge) const;
  /// Port whose cap covers the region at a face, or -1.
  [[nodiscard]] std::int32_t cap_at(std::int32_t region, std::int32_t face) const;
  [[nodiscard]] bool has_slab(std::int32_t port, std::int32_t slab) const;
  [[nodiscard]] bool covers(std::int32_t port, std::int32_t region) const;

 private:
  [[nodiscard]] bool is_on_line(std::int32_t port, std::int32_t vertex) const;
  const mesh::PlanarMesh& planar_;
  const model::Model& model_;
  std::vector<std::vector<std::int32_t>> ports_of_region_;  ///< empty if there are no ports
};

/// Fills parts.ports and is_inner of their tags, and holds every port to its promise: its faces are the rectangle that was
/// asked for, apart from conductors, inside or outside altogether, and its edges lie on its two conductors.
/// @throws Error port_invalid (306) naming every port at fault.
void add_ports(mesh::PrismMeshParts& parts, const Columns& columns, const model::Model& model, const PortFootprints& ports,
               const std::vector<mesh::PlanarEdge>& edges);

}  // namespace pcbmesh::extrude
