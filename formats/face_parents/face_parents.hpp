// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "pcbmesh/base/progress.hpp"
#include "pcbmesh/mesh/mesh_source.hpp"

namespace pcbmesh::formats {

/// Side of a cell: its corners in Gmsh's local numbering, outward.
struct CellSide {
  int num_corners = 0;
  std::array<std::uint8_t, 4> corners{};
};
/// Sides of a kind of cell. Tetrahedron: 021 013 123 032; pyramid: 0321 014 124 234 304; wedge: 021 345 0143 1254 2035;
/// hexahedron: 0321 4567 0154 1265 2376 3047.
[[nodiscard]] std::span<const CellSide> sides_of(mesh::ElementKind kind);

/// The cells beside every tagged face of a mesh, found in one pass over the cells.
/// @cost 80 bytes per tagged face, whatever the number of cells; any source.
class FaceParents {
 public:
  struct Parent {
    std::int64_t cell = -1;  ///< index of the cell in file order, from 0; -1 = none
    std::int32_t side = -1;  ///< index into sides_of its kind
    mesh::ElementKind kind = mesh::ElementKind::wedge;
  };
  FaceParents(mesh::MeshSource& source, const Progress& progress);

  /// Parents of a face, by its index in file order from 0; the cell that comes first in the file first.
  [[nodiscard]] std::array<Parent, 2> of(std::int64_t face) const;
  /// Faces that are a side of no cell.
  [[nodiscard]] std::int64_t num_loose() const { return num_loose_; }
  /// @throws Error format_limit (703) if there are loose faces, for formats that store faces as sides of cells.
  void require_no_loose(std::string_view format, const std::filesystem::path& file) const;

 private:
  using Key = std::array<std::int64_t, 4>;  ///< sorted corners; a triangle's last is -1 and comes first
  void enter_faces(mesh::MeshSource& source);
  void match_cells(mesh::MeshSource& source, const Progress& progress);

  std::vector<Key> keys_;
  std::vector<std::array<std::int64_t, 2>> parents_;  ///< (cell * 8 + side) * 16 + kind, or -1
  std::vector<std::int64_t> slots_;                   ///< open addressing: face or -1
  std::int64_t num_loose_ = 0;
};

}  // namespace pcbmesh::formats
