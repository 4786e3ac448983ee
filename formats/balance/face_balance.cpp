// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/balance/face_balance.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats {
namespace {

/// Takes the pattern out of numbers that follow each other.
std::uint64_t scattered(std::uint64_t x) {
  return x ^ (x >> 29);
}
std::uint64_t mark_of(std::int64_t node) {
  return scattered(static_cast<std::uint64_t>(node) * 0x9E3779B97F4A7C15u);
}

// Products of differences alone would be worthless: (a - b)(b - c)(c - a) is a sum over the three edges, ab(b - a) and so on,
// and edges cancel round any closed cell, right or wrong. The last factor, alike for all orders of the corners, forbids that.

/// The same for every turn of the corners, the negative when they run the other way round.
std::uint64_t triangle(std::uint64_t a, std::uint64_t b, std::uint64_t c) {
  return (a - b) * (b - c) * (c - a) * scattered(a + b + c);
}
std::uint64_t quadrangle(std::uint64_t a, std::uint64_t b, std::uint64_t c, std::uint64_t d) {
  return (a - c) * (b - d) * (a + c - b - d) * scattered(a + b + c + d);
}

/// triangle() of the two ends and quadrangle() of the three sides, whose factors share these differences and sums.
std::uint64_t wedge(std::uint64_t a, std::uint64_t b, std::uint64_t c, std::uint64_t d, std::uint64_t e, std::uint64_t f) {
  const std::uint64_t ab = a - b, bc = b - c, ca = c - a, de = d - e, ef = e - f, fd = f - d, ad = a + d, be = b + e,
                      cf = c + f;
  return de * ef * fd * scattered(d + e + f) - ab * bc * ca * scattered(a + b + c) +
         (a - e) * (b - d) * (ab - de) * scattered(ad + be) + (b - f) * (c - e) * (bc - ef) * scattered(be + cf) +
         (c - d) * (a - f) * (ca - fd) * scattered(cf + ad);
}

// Vector units with products of 64 bits make the sum over wedges several times as fast. The loader chooses.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__gnu_linux__)
#define PCBMESH_FOR_EACH_VECTOR_UNIT [[gnu::target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default"), gnu::flatten]]
#else
#define PCBMESH_FOR_EACH_VECTOR_UNIT
#endif

constexpr std::size_t lanes = 8, wedge_width = 6;

/// Wedges of first order, by far the most frequent rows: eight at a time, each in a lane of its own.
PCBMESH_FOR_EACH_VECTOR_UNIT std::uint64_t sum_of_lanes(const std::int64_t* nodes, std::size_t num_groups) {
  std::uint64_t sums[lanes] = {};
  for (; num_groups > 0; --num_groups, nodes += lanes * wedge_width) {
    std::int64_t corner[wedge_width][lanes];
    for (std::size_t lane = 0; lane < lanes; ++lane)
      for (std::size_t i = 0; i < wedge_width; ++i) corner[i][lane] = nodes[wedge_width * lane + i];
    for (std::size_t lane = 0; lane < lanes; ++lane)
      sums[lane] += wedge(mark_of(corner[0][lane]), mark_of(corner[1][lane]), mark_of(corner[2][lane]),
                          mark_of(corner[3][lane]), mark_of(corner[4][lane]), mark_of(corner[5][lane]));
  }
  return std::accumulate(sums, sums + lanes, std::uint64_t{0});
}

std::uint64_t sum_wedges(std::span<const std::int64_t> nodes) {
  constexpr std::size_t group = lanes * wedge_width;
  const std::span<const std::int64_t> rest = nodes.last(nodes.size() % group);
  std::int64_t padded[group] = {};  // six times the same node has the sum zero
  std::ranges::copy(rest, padded);
  return sum_of_lanes(nodes.data(), nodes.size() / group) + sum_of_lanes(padded, 1);
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
  if constexpr (kind == ElementKind::wedge) return wedge(m[0], m[1], m[2], m[3], m[4], m[5]);
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
      return sum_wedges(nodes);
    case ElementKind::wedge15:
    case ElementKind::wedge18:
      break;
  }
  return sum_rows<ElementKind::wedge>(nodes, width);
}

}  // namespace

FaceBalance::FaceBalance(mesh::MeshSource& source, std::filesystem::path file) : source_(source), file_(std::move(file)) {
  announce_as(source);
  sums_.assign(blocks_.size(), 0);
  is_seen_.assign(blocks_.size(), false);
  num_unseen_ = blocks_.size();
}

void FaceBalance::visit(std::size_t block, const VisitNodes& visit) {
  const mesh::ElementBlock& passing = blocks_[block];
  const bool is_cell = mesh::dimension_of(passing.kind) == 3;
  const bool is_inner_face = !is_cell && groups_[static_cast<std::size_t>(passing.group)].is_inner;
  std::uint64_t sum = 0;
  source_.visit(block, [&](std::span<const std::int64_t> nodes) {
    if (!is_inner_face) sum += sum_rows(passing.kind, nodes);
    visit(nodes);
  });
  if (!is_cell) sum = -sum;
  // A writer may look at a block more than once: its last look counts.
  difference_ += sum - std::exchange(sums_[block], sum);
  if (!is_seen_[block]) --num_unseen_;
  is_seen_[block] = true;
  if (is_complete() && difference_ != 0)
    throw Error(
        ErrorCode::internal,
        "the faces of the cells that were written do not add up to the faces of the hull; no file was left behind, please "
        "report this",
        {.file = file_.string()});
}

}  // namespace pcbmesh::formats
