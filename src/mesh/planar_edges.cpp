// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/mesh/planar_edges.hpp"

#include <algorithm>
#include <tuple>

namespace pcbmesh::mesh {

std::vector<PlanarEdge> edges_of(const PlanarMesh& planar) {
  std::vector<PlanarEdge> edges;
  edges.reserve(3 * static_cast<std::size_t>(planar.num_triangles()));
  for (std::int32_t t = 0; t < planar.num_triangles(); ++t) {
    const auto& corners = planar.triangles()[static_cast<std::size_t>(t)];
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t a = corners[i], b = corners[i == 2 ? 0 : i + 1];
      edges.push_back({std::min(a, b), std::max(a, b), t, -1});
    }
  }
  std::sort(edges.begin(), edges.end(),
            [](const PlanarEdge& p, const PlanarEdge& q) { return std::tie(p.a, p.b, p.one) < std::tie(q.a, q.b, q.one); });
  std::size_t kept = 0;
  for (const PlanarEdge& edge : edges) {
    if (kept > 0 && edges[kept - 1].a == edge.a && edges[kept - 1].b == edge.b)
      edges[kept - 1].other = edge.one;
    else
      edges[kept++] = edge;
  }
  edges.resize(kept);
  return edges;
}

}  // namespace pcbmesh::mesh
