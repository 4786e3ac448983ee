// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pcbmesh/mesh/mesh_data.hpp"
#include "pcbmesh/mesh/mesh_source.hpp"

namespace pcbmesh::mesh {

/// Kind of the elements of a block; empty if no ElementKind has that many nodes.
[[nodiscard]] std::optional<ElementKind> element_kind(const CellBlock& block);
[[nodiscard]] std::optional<ElementKind> element_kind(const FaceBlock& block);

/// A mesh that was read from a file, as writers see it. Any kinds, mixed. Cells without a tag become a group of their own,
/// "untagged", whose tag is one above the greatest: no writer may lose a cell. Groups have the names of the file, else "volume
/// 7" or "surface 7"; layers, materials and nets are not known, nor which face groups lie inside.
///
/// @cost memory 24 bytes per run of equal tags; the mesh is referred to, not copied, and must outlive the source.
class MeshDataSource final : public MeshSource {
 public:
  /// @param unit_m  metres per unit of the mesh's coordinates.
  /// @throws Error file_syntax (202) if blocks have a number of nodes that no kind has.
  explicit MeshDataSource(const MeshData& mesh, double unit_m = 1.0);

  void fill_nodes(std::int64_t first, std::span<std::array<double, 3>> out) override;
  void visit(std::size_t block, const VisitNodes& visit) override;
  [[nodiscard]] Extent extent_of(std::size_t group) override;

  /// Cells that carried no tag.
  [[nodiscard]] std::int64_t num_untagged_cells() const { return num_untagged_cells_; }

 private:
  /// Neighbours of one tag in a block of the mesh.
  struct Run {
    std::int32_t tag = 0;
    ElementKind kind = ElementKind::wedge;
    std::int32_t block = 0;
    std::int64_t first = 0, count = 0;
  };
  template <class Block>
  void gather(const std::vector<Block>& blocks);
  void add_groups(int dimension);

  const MeshData& mesh_;
  std::vector<Run> runs_;               ///< sorted by (tag, kind), then as in the mesh
  std::vector<std::size_t> first_run_;  ///< per block of the source, plus one
  std::int64_t num_untagged_cells_ = 0;
};

/// Everything a source hands out, in memory: for judging and converting, not for writing. Faces and cells keep their order;
/// groups without elements keep their names.
[[nodiscard]] MeshData expand(MeshSource& source);

}  // namespace pcbmesh::mesh
