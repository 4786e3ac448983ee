// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pcbmesh/board/board.hpp"
#include "pcbmesh/mesh/prism_mesh.hpp"

namespace pcbmesh::mesh {

/// Every element kind a file may hold. Corners first, in Gmsh order; the nodes of second order follow in Gmsh order too
/// (wedge: edges 01 02 03 12 14 25 34 35 45, then faces 0143 0253 1254).
enum class ElementKind : std::uint8_t {
  triangle,
  quadrangle,
  tetrahedron,
  pyramid,
  wedge,
  hexahedron,
  triangle6,
  quadrangle8,
  quadrangle9,
  tetrahedron10,
  wedge15,
  wedge18
};

[[nodiscard]] constexpr int nodes_of(ElementKind kind) {
  constexpr int nodes[] = {3, 4, 4, 5, 6, 8, 6, 8, 9, 10, 15, 18};
  return nodes[static_cast<int>(kind)];
}
[[nodiscard]] constexpr int corners_of(ElementKind kind) {
  constexpr int corners[] = {3, 4, 4, 5, 6, 8, 3, 4, 4, 4, 6, 6};
  return corners[static_cast<int>(kind)];
}
[[nodiscard]] constexpr int dimension_of(ElementKind kind) {
  constexpr int dimensions[] = {2, 2, 3, 3, 3, 3, 2, 2, 2, 3, 3, 3};
  return dimensions[static_cast<int>(kind)];
}
[[nodiscard]] constexpr int order_of(ElementKind kind) {
  return nodes_of(kind) == corners_of(kind) ? 1 : 2;
}
/// "wedge", "triangle6" ...
[[nodiscard]] std::string_view name_of(ElementKind kind);

struct Extent {
  std::array<double, 3> min{};
  std::array<double, 3> max{};
};

/// All elements of one dimension that carry one tag: a physical group, side set, material of a file.
struct ElementGroup {
  int dimension = 3;
  std::int32_t tag = 0;  ///< positive; volumes and faces have number spaces of their own
  std::string name;      ///< as group_names() spells it: unique within its dimension, at most 127 bytes
  std::int64_t num_elements = 0;
  std::int32_t layer = -1;     ///< index into layers(), volumes only
  std::int32_t material = -1;  ///< index into materials(), volumes only
  std::int32_t net = -1;       ///< index into nets()
  bool is_inner = false;       ///< faces: they lie between two cells
};

/// Elements of one kind in one group.
struct ElementBlock {
  ElementKind kind = ElementKind::wedge;
  std::int32_t group = 0;  ///< index into groups()
  std::int32_t tag = 0;    ///< of the group
  std::int64_t count = 0;  ///< > 0
};

/// Values that differ from cell to cell inside a group.
enum class CellField : std::uint8_t {
  region,    ///< region of the planar mesh: the column the cell stands in
  sublayer,  ///< sub-layer of the cell, from the bottom
  quality    ///< prism quality q_p of Ye and Daniels; of a tetrahedron that of the prism it was cut from
};
[[nodiscard]] std::string_view name_of(CellField field);

/// What every mesh writer sees: a mesh as groups of elements, handed out in pieces, never held. Prisms of an implicit mesh,
/// their tetrahedral twin, elements of second order, a mesh read from a file: all look alike from here.
///
/// One order for everything: faces before cells; groups ascending by tag; inside a group kind by kind. The k-th cell of a file
/// is the k-th cell of every other file of the same source.
///
/// Faces on the boundary are oriented outwards. Cells have positive Jacobians in Gmsh order if the mesh itself is sound.
/// A source keeps caches: one thread at a time.
class MeshSource {
 public:
  using VisitNodes = std::function<void(std::span<const std::int64_t> nodes)>;
  using VisitValues = std::function<void(std::span<const double> values)>;

  virtual ~MeshSource() = default;
  MeshSource(const MeshSource&) = delete;
  MeshSource& operator=(const MeshSource&) = delete;

  [[nodiscard]] std::int64_t num_nodes() const { return num_nodes_; }
  /// Elements of one dimension, 2 or 3.
  [[nodiscard]] std::int64_t num_elements(int dimension) const;
  /// Faces by tag, then volumes by tag; groups without elements are listed too.
  [[nodiscard]] std::span<const ElementGroup> groups() const { return groups_; }
  /// In file order; empty blocks are left out.
  [[nodiscard]] std::span<const ElementBlock> blocks() const { return blocks_; }
  /// Metres per unit of the coordinates.
  [[nodiscard]] double unit_m() const { return unit_m_; }
  [[nodiscard]] std::span<const std::string> layers() const { return layers_; }
  [[nodiscard]] std::span<const board::Material> materials() const { return materials_; }
  [[nodiscard]] std::span<const std::string> nets() const { return nets_; }

  /// Coordinates of nodes [first, first + out.size()). @cost O(out).
  virtual void fill_nodes(std::int64_t first, std::span<std::array<double, 3>> out) = 0;
  /// Node ids (from 0) of a block's elements, nodes_of(kind) each, at most `chunk` elements a call, in file order.
  virtual void visit(std::size_t block, const VisitNodes& visit) = 0;
  [[nodiscard]] virtual bool has_field(CellField) const { return false; }
  /// Box around all nodes of a group, in the source's unit; all zero if the group is empty. Elements of second order may make
  /// it wider than it need be, never narrower. @cost about one look at the group's elements: only formats that state it should
  /// ask.
  [[nodiscard]] virtual Extent extent_of(std::size_t group) = 0;
  /// One value per element of a block of cells, in the order of visit(). REQUIRES has_field().
  virtual void visit_field(std::size_t block, CellField field, const VisitValues& visit);
  /// The implicit mesh behind the source whose prisms, unaltered, are its cells; null for any other source.
  [[nodiscard]] virtual const PrismMesh* prisms() const { return nullptr; }
  /// Every face of the hull is an element of exactly one group that is not inner, turned outwards: writers check that it is so
  /// in the file as well. A mesh from elsewhere promises nothing.
  [[nodiscard]] virtual bool has_tagged_hull() const { return false; }

  static constexpr std::size_t chunk = 256;  ///< rows stay in the first-level cache

 protected:
  MeshSource() = default;
  /// Groups, blocks, names and numbers of another source, for one that hands its elements on in another shape.
  void announce_as(const MeshSource& source);
  std::vector<ElementGroup> groups_;
  std::vector<ElementBlock> blocks_;
  std::vector<std::string> layers_, nets_;
  std::vector<board::Material> materials_;
  std::int64_t num_nodes_ = 0;
  double unit_m_ = 1.0;
};

}  // namespace pcbmesh::mesh
