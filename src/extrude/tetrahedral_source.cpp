// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/extrude/tetrahedral_source.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "pcbmesh/base/error.hpp"

namespace pcbmesh::extrude {
namespace {

using mesh::ElementKind;
using Nodes = std::span<const std::int64_t>;

/// Turns of a wedge onto itself that bring corner c to the front.
constexpr std::uint8_t turns[6][6] = {{0, 1, 2, 3, 4, 5}, {1, 2, 0, 4, 5, 3}, {2, 0, 1, 5, 3, 4},
                                      {3, 5, 4, 0, 2, 1}, {4, 3, 5, 1, 0, 2}, {5, 4, 3, 2, 1, 0}};

/// Nodes of second order between two corners: edges, and diagonals of quadrangles, whose middle is that of the face.
constexpr std::uint8_t no = 255;
constexpr std::uint8_t wedge_mid[6][6] = {{no, 6, 7, 8, 15, 16},   {6, no, 9, 15, 10, 17},   {7, 9, no, 16, 17, 11},
                                          {8, 15, 16, no, 12, 13}, {15, 10, 17, 12, no, 14}, {16, 17, 11, 13, 14, no}};
constexpr std::uint8_t quadrangle_mid[4][4] = {{no, 4, 8, 7}, {4, no, 5, 8}, {8, 5, no, 6}, {7, 8, 6, no}};
/// Corners of the edges of a tetrahedron and a triangle, in the order of their nodes of second order.
constexpr std::uint8_t tetrahedron_edges[6][2] = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {2, 3}, {1, 3}};
constexpr std::uint8_t triangle_edges[3][2] = {{0, 1}, {1, 2}, {2, 0}};

ElementKind kind_after(ElementKind kind) {
  switch (kind) {
    case ElementKind::wedge:
      return ElementKind::tetrahedron;
    case ElementKind::wedge18:
      return ElementKind::tetrahedron10;
    case ElementKind::quadrangle:
      return ElementKind::triangle;
    case ElementKind::quadrangle9:
      return ElementKind::triangle6;
    case ElementKind::triangle:
    case ElementKind::triangle6:
    case ElementKind::tetrahedron:
    case ElementKind::tetrahedron10:
      return kind;
    default:
      throw Error(ErrorCode::format_limit,
                  fmt::format("elements of kind {} are not split into tetrahedra; wedges and quadrangles are (of second order: "
                              "those with 18 and 9 nodes)",
                              mesh::name_of(kind)));
  }
}

int parts_of(ElementKind kind) {
  return kind == ElementKind::wedge || kind == ElementKind::wedge18            ? 3
         : kind == ElementKind::quadrangle || kind == ElementKind::quadrangle9 ? 2
                                                                               : 1;
}

/// Appends the pieces of one element.
void append_pieces(ElementKind kind, Nodes row, std::vector<std::int64_t>& out) {
  if (kind == ElementKind::wedge || kind == ElementKind::wedge18) {
    for (const auto& piece : split_wedge(row.first<6>())) {
      for (const std::uint8_t corner : piece) out.push_back(row[corner]);
      if (kind == ElementKind::wedge18)
        for (const auto& [a, b] : tetrahedron_edges) out.push_back(row[wedge_mid[piece[a]][piece[b]]]);
    }
  } else if (kind == ElementKind::quadrangle || kind == ElementKind::quadrangle9) {
    constexpr std::uint8_t pieces[2][2][3] = {{{0, 1, 2}, {0, 2, 3}}, {{0, 1, 3}, {1, 2, 3}}};
    const bool through_1 = std::min(row[1], row[3]) < std::min(row[0], row[2]);
    for (const auto& piece : pieces[through_1 ? 1 : 0]) {
      for (const std::uint8_t corner : piece) out.push_back(row[corner]);
      if (kind == ElementKind::quadrangle9)
        for (const auto& [a, b] : triangle_edges) out.push_back(row[quadrangle_mid[piece[a]][piece[b]]]);
    }
  } else {
    out.insert(out.end(), row.begin(), row.end());
  }
}

}  // namespace

std::array<std::array<std::uint8_t, 4>, 3> split_wedge(std::span<const std::int64_t, 6> nodes) {
  const auto& t = turns[std::min_element(nodes.begin(), nodes.end()) - nodes.begin()];
  // Two diagonals start at corner 0; the third lies on the opposite quadrangle 1 2 5 4.
  if (std::min(nodes[t[1]], nodes[t[5]]) < std::min(nodes[t[2]], nodes[t[4]]))
    return {{{t[0], t[1], t[2], t[5]}, {t[0], t[1], t[5], t[4]}, {t[0], t[4], t[5], t[3]}}};
  return {{{t[0], t[1], t[2], t[4]}, {t[0], t[4], t[2], t[5]}, {t[0], t[4], t[5], t[3]}}};
}

TetrahedralSource::TetrahedralSource(mesh::MeshSource& whole) : whole_(whole) {
  announce_as(whole);
  blocks_.clear();
  for (mesh::ElementGroup& group : groups_) group.num_elements = 0;
  const auto parts = whole.blocks();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const ElementKind kind = kind_after(parts[i].kind);
    if (blocks_.empty() || blocks_.back().group != parts[i].group || blocks_.back().kind != kind) {
      first_part_.push_back(i);
      blocks_.push_back({kind, parts[i].group, parts[i].tag, 0});
    }
    const std::int64_t count = parts[i].count * parts_of(parts[i].kind);
    blocks_.back().count += count;
    groups_[static_cast<std::size_t>(parts[i].group)].num_elements += count;
  }
  first_part_.push_back(parts.size());
}

void TetrahedralSource::visit(std::size_t block, const VisitNodes& visit) {
  const auto width = static_cast<std::size_t>(mesh::nodes_of(blocks_.at(block).kind));
  std::vector<std::int64_t> rows;
  rows.reserve(chunk * 3 * width);
  for (std::size_t part = first_part_[block]; part < first_part_[block + 1]; ++part) {
    const ElementKind kind = whole_.blocks()[part].kind;
    const auto width_before = static_cast<std::size_t>(mesh::nodes_of(kind));
    whole_.visit(part, [&](Nodes before) {
      rows.clear();
      for (; !before.empty(); before = before.subspan(width_before)) append_pieces(kind, before.first(width_before), rows);
      for (Nodes rest = rows; !rest.empty();) {
        const Nodes some = rest.first(std::min(chunk * width, rest.size()));
        visit(some);
        rest = rest.subspan(some.size());
      }
    });
  }
}

void TetrahedralSource::visit_field(std::size_t block, mesh::CellField field, const VisitValues& visit) {
  std::vector<double> values;
  for (std::size_t part = first_part_[block]; part < first_part_[block + 1]; ++part) {
    const auto times = static_cast<std::size_t>(parts_of(whole_.blocks()[part].kind));
    whole_.visit_field(part, field, [&](std::span<const double> before) {
      values.clear();
      for (const double value : before) values.insert(values.end(), times, value);
      for (std::span<const double> rest = values; !rest.empty();) {
        const auto some = rest.first(std::min(chunk, rest.size()));
        visit(some);
        rest = rest.subspan(some.size());
      }
    });
  }
}

}  // namespace pcbmesh::extrude
