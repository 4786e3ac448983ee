// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "pcbmesh/mesh/mesh_source.hpp"

namespace pcbmesh::formats {

/// Looks over a writer's shoulder: hands a source on unchanged and adds up a signed fingerprint of every face of every element
/// that passes. A face between two cells cancels, seen from both sides; what is left must be the tagged faces of the hull.
///
/// One wrong, lost, doubled or flipped element leaves a difference: all but surely, about 2^-50 to miss it. Coordinates are not
/// looked at: nodes inside the mesh may change places in all elements alike.
/// @cost no memory; a hash per face, within the figures of benchmarks/write_bench.cpp.
/// @source Clarke et al., Asiacrypt 2003, for hashes of multisets. The functions here are antisymmetric: neither sorting nor
/// branching is needed.
class FaceBalance final : public mesh::MeshSource {
 public:
  /// @param file  named in the error.
  /// REQUIRES source.has_tagged_hull(), and `source` to outlive this.
  FaceBalance(mesh::MeshSource& source, std::filesystem::path file);

  void fill_nodes(std::int64_t first, std::span<std::array<double, 3>> out) override { source_.fill_nodes(first, out); }
  /// @throws Error internal (901) behind the last element of all blocks, if they don't balance: before the file appears.
  void visit(std::size_t block, const VisitNodes& visit) override;
  [[nodiscard]] mesh::Extent extent_of(std::size_t group) override { return source_.extent_of(group); }
  [[nodiscard]] bool has_field(mesh::CellField field) const override { return source_.has_field(field); }
  void visit_field(std::size_t block, mesh::CellField field, const VisitValues& visit) override {
    source_.visit_field(block, field, visit);
  }
  [[nodiscard]] const mesh::PrismMesh* prisms() const override { return source_.prisms(); }
  [[nodiscard]] bool has_tagged_hull() const override { return source_.has_tagged_hull(); }

  /// Every block passed: a format that leaves out faces, or computes cells by itself, says nothing about the balance.
  [[nodiscard]] bool is_complete() const { return num_unseen_ == 0; }

 private:
  mesh::MeshSource& source_;
  std::filesystem::path file_;
  std::vector<std::uint64_t> sums_;  ///< per block: what it adds to the difference
  std::vector<bool> is_seen_;
  std::size_t num_unseen_ = 0;
  std::uint64_t difference_ = 0;  ///< cells less hull
};

}  // namespace pcbmesh::formats
