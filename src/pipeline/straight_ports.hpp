// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "pcbmesh/mesh/planar_graph.hpp"
#include "pcbmesh/model/model.hpp"

namespace pcbmesh::pipeline {

/// Ports whose outline the overlay has moved: an upright one does not stand on one straight line any more, a flat one covers
/// another area. Their indices in model.ports(), ascending. @cost O(increments x ports).
[[nodiscard]] std::vector<std::size_t> bent_ports(const mesh::PlanarGraph& graph, const model::Model& model);

}  // namespace pcbmesh::pipeline
