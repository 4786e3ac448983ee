// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "pcbmesh/mesh/mesh_source.hpp"

namespace pcbmesh::formats {

/// Looks over a writer's shoulder: hands a source on unchanged and adds up a signed fingerprint of every face of every element
/// that passes. A face between two cells cancels, seen from both sides; what is left must be the tagged faces of the hull.
///
/// One wrong, lost, doubled or flipped element leaves a difference: all but surely, about 2^-50 to miss it.
/// @cost no memory; a hash per face, within the figures of benchmarks/write_bench.cpp.
/// @source Clarke et al., Asiacrypt 2003, for hashes of multisets. The polynomials here are antisymmetric: neither sorting nor
/// branching is needed.
class FaceBalance final : public mesh::MeshSource {
 public:
  /// REQUIRES `source` to tag every face of its hull once, outwards, and to outlive this.
  explicit FaceBalance(mesh::MeshSource& source);

  void fill_nodes(std::int64_t first, std::span<std::array<double, 3>> out) override { source_.fill_nodes(first, out); }
  void visit(std::size_t block, const VisitNodes& visit) override;
  [[nodiscard]] bool has_field(mesh::CellField field) const override { return source_.has_field(field); }
  void visit_field(std::size_t block, mesh::CellField field, const VisitValues& visit) override {
    source_.visit_field(block, field, visit);
  }
  [[nodiscard]] const mesh::PrismMesh* prisms() const override { return source_.prisms(); }

  /// Every block passed: a format that leaves out faces, or computes cells by itself, says nothing about the balance.
  [[nodiscard]] bool is_complete() const;
  /// Cells and hull agree. REQUIRES is_complete().
  [[nodiscard]] bool is_balanced() const;

 private:
  mesh::MeshSource& source_;
  std::vector<std::uint64_t> sums_;  ///< per block
  std::vector<bool> is_seen_;
};

}  // namespace pcbmesh::formats
