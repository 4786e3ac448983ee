// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "pcbmesh/geometry/point.hpp"

namespace pcbmesh::mesh {

/// Change of winding number of one body across an edge.
struct Increment {
  std::int32_t body = 0;
  std::int32_t delta = 0;  ///< winding(left of u->v) = winding(right) + delta; never 0
  friend auto operator<=>(const Increment&, const Increment&) = default;
};

struct PlanarGraphParts {
  std::vector<geometry::Point> vertices;
  std::vector<std::array<std::int32_t, 2>> edges;  ///< u < v
  std::vector<std::int32_t> increment_offsets;     ///< edges.size() + 1
  std::vector<Increment> increments;               ///< per edge ascending by body
};

/// All feature edges of all slabs, projected to one plane and made clean.
///
/// @guarantee G1  vertices are distinct points of the nanometre grid; edges are distinct, u < v, no loops
/// @guarantee G2  edges meet at common end points only (checked by triangulate's exact predicates)
/// @guarantee G3  round every vertex the increments of each body cancel (winding is consistent); checked here
class PlanarGraph {
 public:
  /// @throws Error internal (901) on a broken invariant. @cost O(n log n).
  [[nodiscard]] static PlanarGraph from_parts(PlanarGraphParts parts);
  [[nodiscard]] std::span<const geometry::Point> vertices() const { return parts_->vertices; }
  [[nodiscard]] std::span<const std::array<std::int32_t, 2>> edges() const { return parts_->edges; }
  [[nodiscard]] std::span<const Increment> increments(std::size_t edge) const;

 private:
  std::shared_ptr<const PlanarGraphParts> parts_;
};

}  // namespace pcbmesh::mesh
