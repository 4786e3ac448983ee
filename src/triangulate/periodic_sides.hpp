// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pcbmesh/model/model.hpp"
#include "src/triangulate/cdt.hpp"
#include "src/triangulate/flood.hpp"
#include "src/triangulate/graph_edges.hpp"

namespace pcbmesh::triangulate {

/// Keeps the vertices of opposite sides alike where the model calls them periodic. The domain is a box then.
class PeriodicSides {
 public:
  PeriodicSides(const model::Model& model, double unit_nm);
  [[nodiscard]] bool is_empty() const { return !is_periodic_[0] && !is_periodic_[1]; }

  /// Splits edges of one side where the other has a vertex. @return number of vertices added.
  /// @throws Error triangulation_limit (404) where an edge can't be split.
  [[nodiscard]] std::int64_t mirror(Cdt& cdt, const GraphEdgeIndex& graph_edges) const;

  /// @throws Error study_invalid (102), with the place, where the two sides do not show the same: copper that crosses one must
  /// cross the other. REQUIRES mirror() and the faces' tickets from the flood.
  void require_same(const Cdt& cdt, const Regions& regions, const model::Model& model) const;

  /// Vertices of periodic sides in an order that is the same along a side and its partner: so whatever is decided by the order
  /// of vertices, like the diagonals of split quadrangles, is decided alike.
  [[nodiscard]] std::vector<Cdt::Vertex_handle> in_order(const Cdt& cdt) const;

 private:
  /// Vertices of one side, by their place along it.
  [[nodiscard]] std::vector<Cdt::Vertex_handle> side(const Cdt& cdt, int axis, bool is_high) const;
  [[nodiscard]] bool is_on(Cdt::Vertex_handle v, int axis, bool is_high) const;
  [[nodiscard]] std::vector<std::int32_t> bodies_inside(const Cdt& cdt, const Regions& regions, Cdt::Vertex_handle a,
                                                        Cdt::Vertex_handle b) const;

  std::array<bool, 2> is_periodic_{};
  std::array<double, 2> low_{}, high_{};
  double unit_nm_ = 1;
};

}  // namespace pcbmesh::triangulate
