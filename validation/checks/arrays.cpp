// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>
#include <type_traits>

#include "validation/checks/checks.hpp"
#include "validation/checks/parallel.hpp"

namespace pcbmesh::validation::checks {
namespace {

template <class Block>
constexpr int num_kinds() {
  return std::is_same_v<Block, mesh::CellBlock> ? 4 : 2;
}

template <class Block>
bool check_block_sizes(const std::vector<Block>& blocks, const char* what, CheckLog& log) {
  bool fine = true;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const Block& block = blocks[b];
    if (static_cast<int>(block.kind) >= num_kinds<Block>()) {
      log.found("array.kind", FindingSeverity::error,
                fmt::format("{} block {} has the unknown element kind {}", what, b, static_cast<int>(block.kind)));
      fine = false;
    } else if (block.corners.size() != block.tags.size() * static_cast<std::size_t>(corners_of(block.kind))) {
      log.found("array.size", FindingSeverity::error,
                fmt::format("{} block {} has {} corners for {} elements of {} corners each", what, b, block.corners.size(),
                            block.tags.size(), corners_of(block.kind)));
      fine = false;
    } else if (block.num_mid < 0 || block.mids.size() != block.tags.size() * static_cast<std::size_t>(block.num_mid)) {
      log.found("array.size", FindingSeverity::error,
                fmt::format("{} block {} has {} mid-side nodes for {} elements of {} each", what, b, block.mids.size(),
                            block.tags.size(), block.num_mid));
      fine = false;
    }
  }
  return fine;
}

struct CornerTallies {
  Tally out_of_range, repeated;
};

template <class Block>
CornerTallies check_corners(const Context& context, const std::vector<Block>& blocks, const std::vector<std::int64_t>& first) {
  CornerTallies all;
  const std::int64_t num_nodes = context.num_nodes();
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const Block& block = blocks[b];
    const auto n = static_cast<std::size_t>(corners_of(block.kind));
    std::vector<CornerTallies> tallies(static_cast<std::size_t>(context.num_threads));
    for_each_slice(context.num_threads, block.size(), [&](int worker, std::int64_t, std::int64_t begin, std::int64_t end) {
      CornerTallies& mine = tallies[static_cast<std::size_t>(worker)];
      for (std::int64_t i = begin; i < end; ++i) {
        const std::int64_t* corners = block.corners.data() + static_cast<std::size_t>(i) * n;
        bool outside = false, repeated = false;
        for (std::size_t k = 0; k < n; ++k) {
          outside |= corners[k] < 0 || corners[k] >= num_nodes;
          for (std::size_t j = 0; j < k; ++j) repeated |= corners[j] == corners[k];
        }
        for (std::int64_t k = i * block.num_mid; k < (i + 1) * block.num_mid; ++k) {
          const std::int64_t mid = block.mids[static_cast<std::size_t>(k)];
          outside |= mid < 0 || mid >= num_nodes;
        }
        if (outside) mine.out_of_range.add(first[b] + i);
        if (repeated) mine.repeated.add(first[b] + i);
      }
    });
    for (const CornerTallies& mine : tallies) {
      all.out_of_range.merge(mine.out_of_range);
      all.repeated.merge(mine.repeated);
    }
  }
  return all;
}

}  // namespace

ArrayState check_arrays(const Context& context, Report& report) {
  CheckLog log(report, context, "arrays");
  log.examined(context.num_nodes() + context.num_cells() + context.num_faces());
  ArrayState state;
  const bool cells_fine = check_block_sizes(context.mesh.cells, "cell", log);
  const bool faces_fine = check_block_sizes(context.mesh.faces, "face", log);
  state.sizes_ok = cells_fine && faces_fine;
  if (!context.has_geometry) {
    Tally bad;
    for (std::int64_t i = 0; i < context.num_nodes(); ++i) {
      for (const double x : context.mesh.nodes[static_cast<std::size_t>(i)]) {
        if (!std::isfinite(x) || std::abs(x) >= 1e90) {
          bad.add(i);
          break;
        }
      }
    }
    if (bad.count() > 0) {
      log.found("node.not_finite", FindingSeverity::error,
                fmt::format("{} nodes have a coordinate that is infinite, not a number or beyond 1e90", bad.count()), bad,
                PlaceKind::node);
    } else {
      log.found("node.not_finite", FindingSeverity::error, "the coordinates are too large to compute volumes");
    }
  }
  if (!state.sizes_ok) return state;
  if (context.num_cells() == 0) log.found("mesh.empty", FindingSeverity::error, "the mesh has no cells");

  const CornerTallies cells = check_corners(context, context.mesh.cells, context.first_cell);
  const CornerTallies faces = check_corners(context, context.mesh.faces, context.first_face);
  const std::int64_t last = context.num_nodes() - 1;
  log.found("cell.corner_out_of_range", FindingSeverity::error,
            fmt::format("{} cells name a node outside 0..{}", cells.out_of_range.count(), last), cells.out_of_range,
            PlaceKind::cell);
  log.found("face.corner_out_of_range", FindingSeverity::error,
            fmt::format("{} tagged faces name a node outside 0..{}", faces.out_of_range.count(), last), faces.out_of_range,
            PlaceKind::face);
  log.found("cell.corner_repeated", FindingSeverity::error,
            fmt::format("{} cells use one node for two corners", cells.repeated.count()), cells.repeated, PlaceKind::cell);
  log.found("face.corner_repeated", FindingSeverity::error,
            fmt::format("{} tagged faces use one node for two corners", faces.repeated.count()), faces.repeated,
            PlaceKind::face);
  state.ids_ok = cells.out_of_range.count() == 0 && faces.out_of_range.count() == 0;
  return state;
}

}  // namespace pcbmesh::validation::checks
