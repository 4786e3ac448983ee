// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/mesh/planar_graph.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "pcbmesh/base/error.hpp"

namespace pcbmesh::mesh {

PlanarGraph PlanarGraph::from_parts(PlanarGraphParts parts) {
  const auto num_vertices = static_cast<std::int32_t>(parts.vertices.size());
  PCBMESH_ASSERT(parts.increment_offsets.size() == parts.edges.size() + 1 && parts.increment_offsets.front() == 0 &&
                 static_cast<std::size_t>(parts.increment_offsets.back()) == parts.increments.size());
  for (const auto& [u, v] : parts.edges) PCBMESH_ASSERT(u >= 0 && u < v && v < num_vertices);
  {
    std::vector<geometry::Point> sorted = parts.vertices;
    std::sort(sorted.begin(), sorted.end());
    PCBMESH_ASSERT(std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end());
    auto edges = parts.edges;
    std::sort(edges.begin(), edges.end());
    PCBMESH_ASSERT(std::adjacent_find(edges.begin(), edges.end()) == edges.end());
  }
  // Winding is consistent where, round every vertex, what leaves equals what arrives, body by body.
  std::vector<std::tuple<std::int32_t, std::int32_t, std::int32_t>> flow;  // vertex, body, delta
  flow.reserve(parts.increments.size() * 2);
  for (std::size_t e = 0; e < parts.edges.size(); ++e) {
    const auto first = static_cast<std::size_t>(parts.increment_offsets[e]),
               last = static_cast<std::size_t>(parts.increment_offsets[e + 1]);
    PCBMESH_ASSERT(first < last);
    for (std::size_t k = first; k < last; ++k) {
      const Increment& inc = parts.increments[k];
      PCBMESH_ASSERT(inc.delta != 0 && (k == first || parts.increments[k - 1].body < inc.body));
      flow.emplace_back(parts.edges[e][0], inc.body, inc.delta);
      flow.emplace_back(parts.edges[e][1], inc.body, -inc.delta);
    }
  }
  std::sort(flow.begin(), flow.end());
  for (std::size_t i = 0; i < flow.size();) {
    std::int64_t sum = 0;
    std::size_t j = i;
    for (; j < flow.size() && std::get<0>(flow[j]) == std::get<0>(flow[i]) && std::get<1>(flow[j]) == std::get<1>(flow[i]); ++j)
      sum += std::get<2>(flow[j]);
    PCBMESH_ASSERT(sum == 0);
    i = j;
  }
  PlanarGraph graph;
  graph.parts_ = std::make_shared<const PlanarGraphParts>(std::move(parts));
  return graph;
}

std::span<const Increment> PlanarGraph::increments(std::size_t edge) const {
  const auto first = static_cast<std::size_t>(parts_->increment_offsets[edge]),
             last = static_cast<std::size_t>(parts_->increment_offsets[edge + 1]);
  return std::span(parts_->increments).subspan(first, last - first);
}

}  // namespace pcbmesh::mesh
