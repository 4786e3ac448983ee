// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "pcbmesh/mesh/mesh_source.hpp"

namespace pcbmesh::extrude {

/// The tetrahedral twin of a mesh: each wedge becomes three tetrahedra, each quadrangle two triangles, everything else stays.
/// For solvers that have no edge elements on prisms.
///
/// Every quadrangle is cut by the diagonal through its smallest node id, whoever looks at it: so neighbours agree, and tagged
/// faces with them. A wedge always has a corner where two diagonals meet, and then three tetrahedra fill it.
/// Source: Dompierre et al., "How to subdivide pyramids, prisms and hexahedra into tetrahedra", 1999.
///
/// @guarantee D1  conforming if the source is; same nodes, same tags, same names, same volumes
/// @guarantee D2  tetrahedra of a wedge with positive Jacobian have positive Jacobians, a third of its volume if its
/// quadrangles are parallelograms
/// @cost streamed: O(1) memory beyond the source.
class TetrahedralSource final : public mesh::MeshSource {
 public:
  /// @param whole  must outlive this. Wedges of 6 or 18 nodes, tetrahedra, triangles, quadrangles of 4 or 9 nodes.
  /// @throws Error format_limit (703) for other kinds.
  explicit TetrahedralSource(mesh::MeshSource& whole);

  void fill_nodes(std::int64_t first, std::span<std::array<double, 3>> out) override { whole_.fill_nodes(first, out); }
  void visit(std::size_t block, const VisitNodes& visit) override;
  [[nodiscard]] mesh::Extent extent_of(std::size_t group) override { return whole_.extent_of(group); }
  [[nodiscard]] bool has_field(mesh::CellField field) const override { return whole_.has_field(field); }
  [[nodiscard]] bool has_tagged_hull() const override { return whole_.has_tagged_hull(); }
  void visit_field(std::size_t block, mesh::CellField field, const VisitValues& visit) override;

 private:
  mesh::MeshSource& whole_;
  std::vector<std::size_t> first_part_;  ///< per block: its first block of the source, plus one
};

/// The three tetrahedra of a wedge as local corners, by the node ids of its six corners.
[[nodiscard]] std::array<std::array<std::uint8_t, 4>, 3> split_wedge(std::span<const std::int64_t, 6> nodes);

}  // namespace pcbmesh::extrude
