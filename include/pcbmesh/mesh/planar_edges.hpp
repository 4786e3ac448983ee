// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/mesh/planar_mesh.hpp"

namespace pcbmesh::mesh {

/// Edge of the planar mesh, directed so that there is a triangle to its left.
struct PlanarEdge {
  std::int32_t a = 0, b = 0;
  std::int32_t left = 0;
  std::int32_t right = -1;  ///< the triangle on its other side, or -1 on the outline
};

/// Calls visit(PlanarEdge) for every edge once, ordered by lower, then by higher vertex.
/// @cost O(triangles x log of the degree) time, 36 bytes per triangle.
template <class Visit>
void visit_planar_edges(const PlanarMesh& planar, Visit&& visit) {
  struct HalfEdge {
    std::int32_t high = 0, triangle = 0;
    bool ascends = false;  ///< runs from the lower to the higher vertex
  };
  const auto at = [](std::int64_t i) { return static_cast<std::size_t>(i); };
  std::vector<std::int64_t> starts(at(planar.num_points()) + 1, 0);
  const auto visit_sides = [&](auto&& side) {
    for (std::int32_t t = 0; t < planar.num_triangles(); ++t) {
      const auto& c = planar.triangles()[at(t)];
      side(t, c[0], c[1]);
      side(t, c[1], c[2]);
      side(t, c[2], c[0]);
    }
  };
  visit_sides([&](std::int32_t, std::int32_t a, std::int32_t b) { ++starts[at(std::min(a, b)) + 1]; });
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  std::vector<HalfEdge> half_edges(at(starts.back()));
  std::vector<std::int64_t> next(starts.begin(), starts.end() - 1);
  visit_sides([&](std::int32_t t, std::int32_t a, std::int32_t b) {
    half_edges[at(next[at(std::min(a, b))]++)] = {std::max(a, b), t, a < b};
  });
  for (std::int32_t low = 0; low < planar.num_points(); ++low) {
    const auto first = half_edges.begin() + starts[at(low)], last = half_edges.begin() + starts[at(low) + 1];
    std::sort(first, last, [](const HalfEdge& p, const HalfEdge& q) {
      return p.high != q.high ? p.high < q.high : p.triangle < q.triangle;
    });
    for (auto here = first; here != last;) {
      const auto mate = here + 1;
      const bool has_mate = mate != last && mate->high == here->high;
      PCBMESH_ASSERT(!has_mate || (mate->ascends != here->ascends && (mate + 1 == last || (mate + 1)->high != here->high)));
      visit(PlanarEdge{here->ascends ? low : here->high, here->ascends ? here->high : low, here->triangle,
                       has_mate ? mate->triangle : -1});
      here = has_mate ? mate + 1 : mate;
    }
  }
}

/// All of them.
[[nodiscard]] inline std::vector<PlanarEdge> edges_of(const PlanarMesh& planar) {
  std::vector<PlanarEdge> edges;
  visit_planar_edges(planar, [&](const PlanarEdge& edge) { edges.push_back(edge); });
  return edges;
}

}  // namespace pcbmesh::mesh
