// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/face_parents/face_parents.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats {
namespace {

using mesh::ElementKind;

constexpr std::array<CellSide, 4> tetrahedron_sides{{{3, {0, 2, 1}}, {3, {0, 1, 3}}, {3, {1, 2, 3}}, {3, {0, 3, 2}}}};
constexpr std::array<CellSide, 5> pyramid_sides{
    {{4, {0, 3, 2, 1}}, {3, {0, 1, 4}}, {3, {1, 2, 4}}, {3, {2, 3, 4}}, {3, {3, 0, 4}}}};
constexpr std::array<CellSide, 5> wedge_sides{
    {{3, {0, 2, 1}}, {3, {3, 4, 5}}, {4, {0, 1, 4, 3}}, {4, {1, 2, 5, 4}}, {4, {2, 0, 3, 5}}}};
constexpr std::array<CellSide, 6> hexahedron_sides{
    {{4, {0, 3, 2, 1}}, {4, {4, 5, 6, 7}}, {4, {0, 1, 5, 4}}, {4, {1, 2, 6, 5}}, {4, {2, 3, 7, 6}}, {4, {3, 0, 4, 7}}}};

std::array<std::int64_t, 4> key_of(std::array<std::int64_t, 4> corners) {
  std::sort(corners.begin(), corners.end());
  return corners;
}

std::uint64_t hash_of(const std::array<std::int64_t, 4>& key) {
  std::uint64_t h = 0;
  for (const std::int64_t node : key) {
    h = (h ^ static_cast<std::uint64_t>(node)) * 0x9E3779B97F4A7C15U;
    h ^= h >> 32;
  }
  return h;
}

}  // namespace

std::span<const CellSide> sides_of(ElementKind kind) {
  switch (mesh::corners_of(kind)) {
    case 4:
      return tetrahedron_sides;
    case 5:
      return pyramid_sides;
    case 6:
      return wedge_sides;
    default:
      return hexahedron_sides;
  }
}

FaceParents::FaceParents(mesh::MeshSource& source, const Progress& progress) {
  enter_faces(source);
  if (!keys_.empty()) match_cells(source, progress);
  for (const auto& parents : parents_) num_loose_ += parents[0] < 0 ? 1 : 0;
}

void FaceParents::enter_faces(mesh::MeshSource& source) {
  const auto num_faces = static_cast<std::size_t>(source.num_elements(2));
  keys_.reserve(num_faces);
  parents_.assign(num_faces, {-1, -1});
  slots_.assign(std::bit_ceil(2 * num_faces + 1), -1);
  for (std::size_t b = 0; b < source.blocks().size(); ++b) {
    const ElementKind kind = source.blocks()[b].kind;
    if (mesh::dimension_of(kind) != 2) continue;
    const auto width = static_cast<std::size_t>(mesh::nodes_of(kind));
    source.visit(b, [&](std::span<const std::int64_t> rows) {
      for (; !rows.empty(); rows = rows.subspan(width)) {
        const std::int64_t last = mesh::corners_of(kind) == 4 ? rows[3] : -1;
        keys_.push_back(key_of({rows[0], rows[1], rows[2], last}));
        // Two groups may hold the same face: each gets a slot of its own.
        std::size_t slot = hash_of(keys_.back()) & (slots_.size() - 1);
        while (slots_[slot] >= 0) slot = (slot + 1) & (slots_.size() - 1);
        slots_[slot] = static_cast<std::int64_t>(keys_.size()) - 1;
      }
    });
  }
}

void FaceParents::match_cells(mesh::MeshSource& source, const Progress& progress) {
  std::int64_t cell = 0;
  for (std::size_t b = 0; b < source.blocks().size(); ++b) {
    const ElementKind kind = source.blocks()[b].kind;
    if (mesh::dimension_of(kind) != 3) continue;
    const auto width = static_cast<std::size_t>(mesh::nodes_of(kind));
    const std::span<const CellSide> sides = sides_of(kind);
    source.visit(b, [&](std::span<const std::int64_t> rows) {
      progress.check();
      for (; !rows.empty(); rows = rows.subspan(width), ++cell) {
        for (std::size_t s = 0; s < sides.size(); ++s) {
          const auto& [num_corners, c] = sides[s];
          const Key key = key_of({rows[c[0]], rows[c[1]], rows[c[2]], num_corners == 4 ? rows[c[3]] : -1});
          for (std::size_t slot = hash_of(key) & (slots_.size() - 1); slots_[slot] >= 0;
               slot = (slot + 1) & (slots_.size() - 1)) {
            const auto face = static_cast<std::size_t>(slots_[slot]);
            if (keys_[face] != key) continue;
            auto& parents = parents_[face];
            std::int64_t& place = parents[0] < 0 ? parents[0] : parents[1];
            place = (cell * 8 + static_cast<std::int64_t>(s)) * 16 + static_cast<std::int64_t>(kind);
          }
        }
      }
    });
  }
}

std::array<FaceParents::Parent, 2> FaceParents::of(std::int64_t face) const {
  std::array<Parent, 2> out;
  for (std::size_t i = 0; i < 2; ++i)
    if (const std::int64_t packed = parents_[static_cast<std::size_t>(face)][i]; packed >= 0)
      out[i] = {packed / 128, static_cast<std::int32_t>(packed / 16 % 8), static_cast<ElementKind>(packed % 16)};
  return out;
}

void FaceParents::require_no_loose(std::string_view format, const std::filesystem::path& file) const {
  if (num_loose_ == 0) return;
  throw Error(ErrorCode::format_limit,
              fmt::format("{} tagged faces are a side of no cell, and {} stores faces as sides of cells; 'pcbmesh check' shows "
                          "where they are",
                          num_loose_, format),
              {.file = file.string()});
}

}  // namespace pcbmesh::formats
