// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pcbmesh/mesh/planar_graph.hpp"
#include "src/triangulate/cdt.hpp"
#include "src/triangulate/graph_edges.hpp"

namespace pcbmesh::triangulate {

/// Faces of the graph as the flood finds them: region 0 is the outside, the rest in order of discovery.
struct Regions {
  std::vector<std::int32_t> offsets{0};    ///< num_regions + 1
  std::vector<mesh::Increment> winding{};  ///< per region: body and winding number (not 0), ascending by body
  [[nodiscard]] std::size_t size() const { return offsets.size() - 1; }
  [[nodiscard]] std::span<const mesh::Increment> of(std::size_t region) const {
    return std::span(winding).subspan(static_cast<std::size_t>(offsets[region]),
                                      static_cast<std::size_t>(offsets[region + 1] - offsets[region]));
  }
  /// Is body 0 (the domain) present?
  [[nodiscard]] bool is_in_domain(std::size_t region) const {
    return !of(region).empty() && of(region)[0].body == 0 && of(region)[0].delta > 0;
  }
};

/// One flood from the infinite face: faces joined by an unconstrained edge share a region; crossing a constrained edge adds
/// the increments of its graph edge. Each face's ticket becomes 1 + region.
/// @throws Error internal (901) naming the place if a region is reached with two different windings. @cost O(faces).
[[nodiscard]] Regions flood(Cdt& cdt, const mesh::PlanarGraph& graph, const GraphEdgeIndex& graph_edges);

}  // namespace pcbmesh::triangulate
