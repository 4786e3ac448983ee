// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/balance/face_balance.hpp"

#include <algorithm>

namespace pcbmesh::formats {
namespace {

/// A random number for each node, the same every time (splitmix's finaliser, halved).
std::uint64_t mark_of(std::int64_t node) {
  std::uint64_t x = (static_cast<std::uint64_t>(node) + 1) * 0x9E3779B97F4A7C15u;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
  return x ^ (x >> 31);
}

/// The same for every turn of the corners, the negative when they run the other way round.
std::uint64_t triangle(std::uint64_t a, std::uint64_t b, std::uint64_t c) {
  return (a - b) * (b - c) * (c - a);
}
std::uint64_t quadrangle(std::uint64_t a, std::uint64_t b, std::uint64_t c, std::uint64_t d) {
  return (a - c) * (b - d) * (a + c - b - d);
}

/// Sum over the faces of one element, outwards for cells; a face counts as itself.
template <mesh::ElementKind kind>
std::uint64_t sum_of(const std::uint64_t* m) {
  using mesh::ElementKind;
  if constexpr (kind == ElementKind::triangle) return triangle(m[0], m[1], m[2]);
  if constexpr (kind == ElementKind::quadrangle) return quadrangle(m[0], m[1], m[2], m[3]);
  if constexpr (kind == ElementKind::tetrahedron)
    return triangle(m[0], m[2], m[1]) + triangle(m[0], m[1], m[3]) + triangle(m[1], m[2], m[3]) + triangle(m[2], m[0], m[3]);
  if constexpr (kind == ElementKind::pyramid)
    return quadrangle(m[0], m[3], m[2], m[1]) + triangle(m[0], m[1], m[4]) + triangle(m[1], m[2], m[4]) +
           triangle(m[2], m[3], m[4]) + triangle(m[3], m[0], m[4]);
  if constexpr (kind == ElementKind::wedge)
    return triangle(m[0], m[2], m[1]) + triangle(m[3], m[4], m[5]) + quadrangle(m[0], m[1], m[4], m[3]) +
           quadrangle(m[1], m[2], m[5], m[4]) + quadrangle(m[2], m[0], m[3], m[5]);
  if constexpr (kind == ElementKind::hexahedron)
    return quadrangle(m[0], m[3], m[2], m[1]) + quadrangle(m[4], m[5], m[6], m[7]) + quadrangle(m[0], m[1], m[5], m[4]) +
           quadrangle(m[1], m[2], m[6], m[5]) + quadrangle(m[2], m[3], m[7], m[6]) + quadrangle(m[3], m[0], m[4], m[7]);
}

template <mesh::ElementKind kind>
std::uint64_t sum_rows(std::span<const std::int64_t> nodes, std::size_t width) {
  constexpr auto corners = static_cast<std::size_t>(mesh::corners_of(kind));
  std::uint64_t sum = 0;
  std::uint64_t marks[8];
  for (std::size_t row = 0; row + width <= nodes.size(); row += width) {
    for (std::size_t i = 0; i < corners; ++i) marks[i] = mark_of(nodes[row + i]);
    sum += sum_of<kind>(marks);
  }
  return sum;
}

/// Middle nodes of second order follow the corners and are left out: corners alone decide who shares a face.
std::uint64_t sum_rows(mesh::ElementKind kind, std::span<const std::int64_t> nodes) {
  using mesh::ElementKind;
  const auto width = static_cast<std::size_t>(mesh::nodes_of(kind));
  switch (kind) {
    case ElementKind::triangle:
    case ElementKind::triangle6:
      return sum_rows<ElementKind::triangle>(nodes, width);
    case ElementKind::quadrangle:
    case ElementKind::quadrangle8:
    case ElementKind::quadrangle9:
      return sum_rows<ElementKind::quadrangle>(nodes, width);
    case ElementKind::tetrahedron:
    case ElementKind::tetrahedron10:
      return sum_rows<ElementKind::tetrahedron>(nodes, width);
    case ElementKind::pyramid:
      return sum_rows<ElementKind::pyramid>(nodes, width);
    case ElementKind::hexahedron:
      return sum_rows<ElementKind::hexahedron>(nodes, width);
    case ElementKind::wedge:
    case ElementKind::wedge15:
    case ElementKind::wedge18:
      break;
  }
  return sum_rows<ElementKind::wedge>(nodes, width);
}

}  // namespace

FaceBalance::FaceBalance(mesh::MeshSource& source) : source_(source) {
  groups_.assign(source.groups().begin(), source.groups().end());
  blocks_.assign(source.blocks().begin(), source.blocks().end());
  layers_.assign(source.layers().begin(), source.layers().end());
  nets_.assign(source.nets().begin(), source.nets().end());
  materials_.assign(source.materials().begin(), source.materials().end());
  num_nodes_ = source.num_nodes();
  unit_m_ = source.unit_m();
  sums_.assign(blocks_.size(), 0);
  is_seen_.assign(blocks_.size(), false);
}

void FaceBalance::visit(std::size_t block, const VisitNodes& visit) {
  std::uint64_t sum = 0;
  const mesh::ElementKind kind = blocks_[block].kind;
  source_.visit(block, [&](std::span<const std::int64_t> nodes) {
    sum += sum_rows(kind, nodes);
    visit(nodes);
  });
  // A writer may look at a block more than once.
  sums_[block] = sum;
  is_seen_[block] = true;
}

bool FaceBalance::is_complete() const {
  return std::ranges::all_of(is_seen_, [](bool seen) { return seen; });
}

bool FaceBalance::is_balanced() const {
  std::uint64_t difference = 0;
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    const bool is_cell = mesh::dimension_of(blocks_[i].kind) == 3;
    if (is_cell) difference += sums_[i];
    if (!is_cell && !groups_[static_cast<std::size_t>(blocks_[i].group)].is_inner) difference -= sums_[i];
  }
  return difference == 0;
}

}  // namespace pcbmesh::formats
