// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "pcbmesh/mesh/planar_graph.hpp"

namespace pcbmesh::triangulate {

/// Finds a graph edge by its end vertices.
class GraphEdgeIndex {
 public:
  explicit GraphEdgeIndex(const mesh::PlanarGraph& graph);
  /// Edge id, or -1 if u and v are not joined. @cost O(degree of the lower vertex).
  [[nodiscard]] std::int32_t find(std::int32_t u, std::int32_t v) const;

 private:
  struct Arm {
    std::int32_t upper;
    std::int32_t edge;
  };
  std::vector<std::int32_t> offsets_;  // by lower vertex
  std::vector<Arm> arms_;
};

}  // namespace pcbmesh::triangulate
