// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pcbmesh/mesh/mesh_source.hpp"

namespace pcbmesh::formats::deck {

/// A mesh whose face groups are numbered after its volume groups, for readers that know one number space: in GetDP a region
/// number means every element that carries it, volume or face. Faces of tag f become `num_volume_tags` + f.
class OneNumberSpace final : public mesh::MeshSource {
 public:
  /// REQUIRES `source` to outlive this.
  explicit OneNumberSpace(mesh::MeshSource& source);
  void fill_nodes(std::int64_t first, std::span<std::array<double, 3>> out) override { source_.fill_nodes(first, out); }
  void visit(std::size_t block, const VisitNodes& visit) override { source_.visit(block, visit); }
  [[nodiscard]] mesh::Extent extent_of(std::size_t group) override { return source_.extent_of(group); }
  [[nodiscard]] bool has_field(mesh::CellField field) const override { return source_.has_field(field); }
  void visit_field(std::size_t block, mesh::CellField field, const VisitValues& visit) override {
    source_.visit_field(block, field, visit);
  }
  [[nodiscard]] const mesh::PrismMesh* prisms() const override { return source_.prisms(); }

 private:
  mesh::MeshSource& source_;
};

/// Largest volume tag of a source: what OneNumberSpace adds to face tags.
[[nodiscard]] std::int32_t first_face_tag(const mesh::MeshSource& source);

}  // namespace pcbmesh::formats::deck
