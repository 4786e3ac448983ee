// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pcbmesh/mesh/prism_mesh.hpp"

namespace pcbmesh::mesh {

/// What a mesh holds of one net.
struct NetMeasure {
  std::int64_t num_prisms = 0;  ///< of solid copper
  double volume_m3 = 0;         ///< of solid copper
  double area_m2 = 0;           ///< surface towards everything that is not the net: of copper cells, and skins of hollow ones
  std::vector<std::int32_t> ports;  ///< indices into ports() whose terminal it is
};

/// One per net of the mesh. @cost O(planar edges x slabs).
[[nodiscard]] std::vector<NetMeasure> measure_nets(const PrismMesh& mesh);

}  // namespace pcbmesh::mesh
