// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/triangulate/graph_edges.hpp"

#include <cstddef>
#include <utility>

namespace pcbmesh::triangulate {

GraphEdgeIndex::GraphEdgeIndex(const mesh::PlanarGraph& graph) {
  const auto edges = graph.edges();
  offsets_.assign(graph.vertices().size() + 1, 0);
  for (const auto& [u, v] : edges) ++offsets_[static_cast<std::size_t>(u) + 1];
  for (std::size_t i = 1; i < offsets_.size(); ++i) offsets_[i] += offsets_[i - 1];
  arms_.resize(edges.size());
  std::vector<std::int32_t> next(offsets_.begin(), offsets_.end() - 1);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto slot = static_cast<std::size_t>(next[static_cast<std::size_t>(edges[e][0])]++);
    arms_[slot] = {edges[e][1], static_cast<std::int32_t>(e)};
  }
}

std::int32_t GraphEdgeIndex::find(std::int32_t u, std::int32_t v) const {
  if (v < u) std::swap(u, v);
  const auto first = static_cast<std::size_t>(offsets_[static_cast<std::size_t>(u)]);
  const auto last = static_cast<std::size_t>(offsets_[static_cast<std::size_t>(u) + 1]);
  for (std::size_t k = first; k < last; ++k) {
    if (arms_[k].upper == v) return arms_[k].edge;
  }
  return -1;
}

}  // namespace pcbmesh::triangulate
