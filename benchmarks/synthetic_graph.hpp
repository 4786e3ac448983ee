// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "pcbmesh/mesh/planar_graph.hpp"
#include "pcbmesh/model/model.hpp"

namespace pcbmesh::benchmarks {

/// A board drawn by seed: outline, vias (drill in pad, 24-gons) on a 1 mm grid, tracks of 0.1 mm with 45 degree bends on a
/// 0.25 mm grid that touch neither each other nor a via. Bodies: 0 domain, 1 board, 2 copper, 3 barrel.
[[nodiscard]] mesh::PlanarGraph synthetic_graph(int width_mm, int height_mm, std::uint32_t seed);

/// The model that belongs to every synthetic graph.
[[nodiscard]] model::Model synthetic_model();

}  // namespace pcbmesh::benchmarks
