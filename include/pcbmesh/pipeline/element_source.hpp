// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>

#include "pcbmesh/extrude/second_order_source.hpp"
#include "pcbmesh/mesh/mesh_source.hpp"
#include "pcbmesh/pipeline/mesh_board.hpp"

namespace pcbmesh::pipeline {

/// The elements that the study asks for, ready to be written: prisms or tetrahedra, of first or second order.
class ElementSource {
 public:
  explicit ElementSource(const MeshBoardResult& result);
  [[nodiscard]] mesh::MeshSource& source() { return tetrahedra_ ? *tetrahedra_ : *prisms_; }
  /// What became of the arcs; empty for first order.
  [[nodiscard]] const std::optional<extrude::SecondOrderStatistics>& second_order() const { return second_order_; }

 private:
  std::unique_ptr<mesh::MeshSource> prisms_, tetrahedra_;
  std::optional<extrude::SecondOrderStatistics> second_order_;
};

}  // namespace pcbmesh::pipeline
