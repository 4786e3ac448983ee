// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "pcbmesh/extrude/second_order_source.hpp"
#include "pcbmesh/mesh/planar_mesh.hpp"

namespace pcbmesh::extrude {

/// Edges of the planar mesh, as the caller numbers them, with their middles.
struct EdgeMiddles {
  std::span<const std::array<std::int32_t, 2>> edges;
  std::span<const std::array<std::int32_t, 3>> edges_of_triangle;  ///< over corners 01, 02, 12
  std::vector<std::array<double, 2>>& middles_m;                   ///< in: straight
};

/// Moves the middles of constrained edges that stand on circles onto them, and back where an element would fold.
[[nodiscard]] SecondOrderStatistics curve(const mesh::PlanarMesh& planar, const SecondOrderOptions& options,
                                          const EdgeMiddles& edges);

}  // namespace pcbmesh::extrude
