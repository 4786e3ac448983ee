// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "pcbmesh/mesh/prism_mesh.hpp"

namespace pcbmesh::mesh {

/// How finely the faces of one port are meshed.
struct PortMeasure {
  std::int64_t num_faces = 0;
  int least_along = 0;   ///< lumped: no way from one terminal to the other crosses fewer faces; 0 = not known
  int least_across = 0;  ///< lumped, not coaxial: the same across; 0 = not known
  double shortest_edge_m = 0, longest_edge_m = 0;
  double worst_aspect = 0;  ///< longest over shortest edge of one face
};

/// One per port of the mesh. @cost O(caps + walls x sub-layers of ports).
[[nodiscard]] std::vector<PortMeasure> measure_ports(const PrismMesh& mesh);

}  // namespace pcbmesh::mesh
