// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/profiles/cracks.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

#include "validation/checks/cell_shapes.hpp"

namespace pcbmesh::validation::profiles {
namespace {

using FaceKey = std::array<std::int64_t, 4>;

FaceKey key_of(std::span<const std::int64_t> corners) {
  FaceKey key{-1, -1, -1, -1};
  std::copy(corners.begin(), corners.end(), key.begin());
  std::sort(key.begin(), key.end());
  return key;
}

struct KeyedFace {
  FaceKey key;
  std::int64_t cell;
};

/// The cells round every node of the sheets, joined through all faces but the sheets' own.
class CutNodes {
 public:
  CutNodes(const checks::Context& context, std::span<const std::int64_t> sheets) : context_(context) {
    rank_.assign(context.mesh.nodes.size(), -1);
    std::int64_t count = 0;
    for (const std::int64_t face : sheets) {
      const auto corners = context.corners_of_face(face);
      cuts_.push_back(key_of(corners));
      for (const std::int64_t node : corners) {
        std::int64_t& rank = rank_[static_cast<std::size_t>(node)];
        if (rank < 0) rank = count++;
      }
    }
    std::sort(cuts_.begin(), cuts_.end());
    gather_cells(static_cast<std::size_t>(count));
    join_cells();
  }

  /// The cells round the node fall apart: the cut gives it a twin.
  [[nodiscard]] bool is_split(std::int64_t node) const {
    const auto rank = static_cast<std::size_t>(rank_[static_cast<std::size_t>(node)]);
    for (std::size_t i = starts_[rank] + 1; i < starts_[rank + 1]; ++i) {
      if (root(i) != root(starts_[rank])) return true;
    }
    return false;
  }

 private:
  [[nodiscard]] std::int64_t rank_of(std::int64_t node) const { return rank_[static_cast<std::size_t>(node)]; }

  template <class Visit>
  void each_cell(Visit&& visit) const {
    for (std::size_t b = 0; b < context_.mesh.cells.size(); ++b) {
      const mesh::CellBlock& block = context_.mesh.cells[b];
      const auto n = static_cast<std::size_t>(corners_of(block.kind));
      for (std::int64_t i = 0; i < block.size(); ++i) {
        const auto corners = std::span(block.corners).subspan(static_cast<std::size_t>(i) * n, n);
        if (std::ranges::any_of(corners, [&](std::int64_t node) { return rank_of(node) >= 0; })) {
          visit(context_.first_cell[b] + i, block.kind, corners);
        }
      }
    }
  }

  void gather_cells(std::size_t num_ranks) {
    starts_.assign(num_ranks + 1, 0);
    each_cell([&](std::int64_t, mesh::CellKind, std::span<const std::int64_t> corners) {
      for (const std::int64_t node : corners) {
        if (rank_of(node) >= 0) ++starts_[static_cast<std::size_t>(rank_of(node)) + 1];
      }
    });
    std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
    std::vector<std::size_t> next(starts_.begin(), starts_.end() - 1);
    cells_.resize(starts_.back());
    each_cell([&](std::int64_t cell, mesh::CellKind kind, std::span<const std::int64_t> corners) {
      for (const std::int64_t node : corners) {
        if (rank_of(node) >= 0) cells_[next[static_cast<std::size_t>(rank_of(node))]++] = cell;
      }
      for (const checks::LocalFace& face : checks::faces_of(kind)) {
        std::array<std::int64_t, 4> ids{};
        const auto n = static_cast<std::size_t>(face.num_corners);
        for (std::size_t k = 0; k < n; ++k) ids[k] = corners[static_cast<std::size_t>(face.corners[k])];
        const auto used = std::span<const std::int64_t>(ids).first(n);
        if (std::ranges::any_of(used, [&](std::int64_t node) { return rank_of(node) >= 0; })) {
          faces_.push_back({key_of(used), cell});
        }
      }
    });
    parent_.resize(cells_.size());
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }

  void join_cells() {
    std::sort(faces_.begin(), faces_.end(),
              [](const KeyedFace& a, const KeyedFace& b) { return a.key != b.key ? a.key < b.key : a.cell < b.cell; });
    for (std::size_t i = 1; i < faces_.size(); ++i) {
      if (faces_[i].key != faces_[i - 1].key || std::binary_search(cuts_.begin(), cuts_.end(), faces_[i].key)) continue;
      for (const std::int64_t node : faces_[i].key) {
        if (node < 0 || rank_of(node) < 0) continue;
        const std::size_t a = root(place_of(node, faces_[i - 1].cell)), b = root(place_of(node, faces_[i].cell));
        parent_[std::max(a, b)] = std::min(a, b);
      }
    }
    faces_ = {};
  }

  [[nodiscard]] std::size_t place_of(std::int64_t node, std::int64_t cell) const {
    const auto rank = static_cast<std::size_t>(rank_of(node));
    const auto first = cells_.begin() + static_cast<std::ptrdiff_t>(starts_[rank]),
               end = cells_.begin() + static_cast<std::ptrdiff_t>(starts_[rank + 1]);
    return static_cast<std::size_t>(std::lower_bound(first, end, cell) - cells_.begin());
  }

  [[nodiscard]] std::size_t root(std::size_t i) const {
    while (parent_[i] != i) i = parent_[i];
    return i;
  }

  const checks::Context& context_;
  std::vector<std::int64_t> rank_;   ///< per node of the mesh; -1 = on no sheet
  std::vector<FaceKey> cuts_;        ///< sorted
  std::vector<std::size_t> starts_;  ///< cells_ by rank
  std::vector<std::int64_t> cells_;  ///< cells round each node, ascending
  std::vector<std::size_t> parent_;  ///< per entry of cells_
  std::vector<KeyedFace> faces_;     ///< only while joining
};

struct SheetEdge {
  std::int64_t low, high, face;
};

}  // namespace

checks::Tally find_chords(const checks::Context& context, std::span<const std::int64_t> sheets) {
  checks::Tally chords;
  if (sheets.empty()) return chords;
  const CutNodes cut(context, sheets);
  std::vector<SheetEdge> edges;
  for (const std::int64_t face : sheets) {
    const auto corners = context.corners_of_face(face);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const auto [low, high] = std::minmax(corners[i], corners[(i + 1) % corners.size()]);
      edges.push_back({low, high, face});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const SheetEdge& a, const SheetEdge& b) {
    return std::tie(a.low, a.high, a.face) < std::tie(b.low, b.high, b.face);
  });
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    while (end < edges.size() && edges[end].low == edges[begin].low && edges[end].high == edges[begin].high) ++end;
    if (end - begin > 1 && !cut.is_split(edges[begin].low) && !cut.is_split(edges[begin].high)) chords.add(edges[begin].face);
  }
  return chords;
}

}  // namespace pcbmesh::validation::profiles
