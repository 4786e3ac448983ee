// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/vtk/cells.hpp"

#include <algorithm>
#include <array>
#include <ranges>

#include "formats/elements/element_walk.hpp"

namespace pcbmesh::formats {

std::string_view name_of(VtkWedge order) {
  return order == VtkWedge::legacy ? "legacy" : "parametric";
}

namespace vtk {
namespace {

using mesh::ElementKind;

constexpr std::array<std::uint8_t, 12> types{5, 9, 10, 14, 13, 12, 22, 23, 28, 24, 26, 32};

constexpr std::array<std::uint8_t, 6> turned_wedge{0, 2, 1, 3, 5, 4};

}  // namespace

std::uint8_t cell_type(ElementKind kind) {
  return types[static_cast<std::size_t>(kind)];
}

std::optional<ElementKind> element_kind(int cell_type) {
  const auto found = std::ranges::find(types, cell_type, [](std::uint8_t type) { return int{type}; });
  if (found == types.end()) return std::nullopt;
  return static_cast<ElementKind>(found - types.begin());
}

std::span<const std::uint8_t> node_order(ElementKind kind, VtkWedge wedge) {
  if (kind == ElementKind::wedge && wedge == VtkWedge::legacy) return turned_wedge;
  return formats::node_order(kind, NodeOrder::vtk);
}

bool is_identity(std::span<const std::uint8_t> order) {
  return std::ranges::equal(order, std::views::iota(std::size_t{0}, order.size()));
}

}  // namespace vtk
}  // namespace pcbmesh::formats
