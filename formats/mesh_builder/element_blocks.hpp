// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "pcbmesh/mesh/mesh_data.hpp"
#include "pcbmesh/mesh/mesh_source.hpp"

namespace pcbmesh::formats {

/// Elements of a mesh that is being read, sorted by kind as they come.
class ElementBlocks {
 public:
  ElementBlocks();
  /// Makes room for `count` more.
  void reserve(mesh::ElementKind kind, std::int64_t count);
  /// @param nodes  indices in Gmsh order, as many as the kind has.
  void add(mesh::ElementKind kind, std::int32_t tag, std::span<const std::int64_t> nodes);
  /// Corners of all elements of a kind of cells. REQUIRES that the kind is one of cells.
  [[nodiscard]] std::span<std::int64_t> cell_corners(mesh::ElementKind kind) {
    return cells_[static_cast<std::size_t>(kind)].corners;
  }
  /// Moves all that is not empty into the mesh.
  void move_to(mesh::MeshData& mesh);

 private:
  static constexpr std::size_t num_kinds = static_cast<std::size_t>(mesh::ElementKind::wedge18) + 1;
  std::array<mesh::CellBlock, num_kinds> cells_;  ///< by ElementKind, as faces_
  std::array<mesh::FaceBlock, num_kinds> faces_;
};

}  // namespace pcbmesh::formats
