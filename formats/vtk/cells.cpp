// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/vtk/cells.hpp"

#include <algorithm>
#include <array>

namespace pcbmesh::formats {

std::string_view name_of(VtkWedge order) {
  return order == VtkWedge::legacy ? "legacy" : "parametric";
}

namespace vtk {
namespace {

using mesh::ElementKind;

constexpr std::array<std::uint8_t, 12> types{5, 9, 10, 14, 13, 12, 22, 23, 28, 24, 26, 32};

constexpr std::array<std::uint8_t, 18> same{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17};
constexpr std::array<std::uint8_t, 6> turned_wedge{0, 2, 1, 3, 5, 4};
// Edges 23 and 13 stand the other way round in Gmsh.
constexpr std::array<std::uint8_t, 10> tetrahedron10{0, 1, 2, 3, 4, 5, 6, 7, 9, 8};
// Edges 01 12 20 34 45 53 03 14 25, then faces 0143 1254 2035; a wedge of 15 nodes is the first part of it.
constexpr std::array<std::uint8_t, 18> wedge18{0, 1, 2, 3, 4, 5, 6, 9, 7, 12, 14, 13, 8, 10, 11, 15, 17, 16};

}  // namespace

std::uint8_t cell_type(ElementKind kind) {
  return types[static_cast<std::size_t>(kind)];
}

std::optional<ElementKind> element_kind(int cell_type) {
  // Cells of any order, as dolfinx writes them; those of first order are the old ones under another number.
  constexpr ElementKind of_any_order[] = {ElementKind::triangle,   ElementKind::quadrangle, ElementKind::tetrahedron,
                                          ElementKind::hexahedron, ElementKind::wedge,      ElementKind::pyramid};
  if (cell_type >= 69 && cell_type <= 74) return of_any_order[cell_type - 69];
  const auto found = std::ranges::find(types, cell_type, [](std::uint8_t type) { return int{type}; });
  if (found == types.end()) return std::nullopt;
  return static_cast<ElementKind>(found - types.begin());
}

std::span<const std::uint8_t> node_order(ElementKind kind, VtkWedge wedge) {
  const auto count = static_cast<std::size_t>(mesh::nodes_of(kind));
  if (kind == ElementKind::wedge && wedge == VtkWedge::legacy) return turned_wedge;
  if (kind == ElementKind::tetrahedron10) return tetrahedron10;
  if (kind == ElementKind::wedge15 || kind == ElementKind::wedge18) return std::span(wedge18).first(count);
  return std::span(same).first(count);
}

bool is_identity(std::span<const std::uint8_t> order) {
  return std::ranges::equal(order, std::span(same).first(order.size()));
}

}  // namespace vtk
}  // namespace pcbmesh::formats
