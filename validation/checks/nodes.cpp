// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>

#include "validation/checks/checks.hpp"
#include "validation/checks/parallel.hpp"

namespace pcbmesh::validation::checks {
namespace {

Tally find_orphans(const Context& context) {
  std::vector<std::uint8_t> used(context.mesh.nodes.size(), 0);
  for (const mesh::CellBlock& block : context.mesh.cells) {
    for (const std::vector<std::int64_t>* nodes : {&block.corners, &block.mids})
      for_each_slice(context.num_threads, static_cast<std::int64_t>(nodes->size()),
                     [&](int, std::int64_t, std::int64_t first, std::int64_t last) {
                       for (std::int64_t i = first; i < last; ++i) {
                         const auto node = static_cast<std::size_t>((*nodes)[static_cast<std::size_t>(i)]);
                         std::atomic_ref(used[node]).store(1, std::memory_order_relaxed);
                       }
                     });
  }
  Tally orphans;
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i] == 0) orphans.add(static_cast<std::int64_t>(i));
  }
  return orphans;
}

/// A node in one cell of the search grid. A node within the tolerance of a cell's wall is entered in the cells on both
/// sides, so that two close nodes always meet in the home cell of either.
struct GridEntry {
  std::uint64_t cell;  ///< hash of the grid cell
  std::int64_t node;   ///< node << 1 | (1 in its home cell)
};

std::uint64_t hash_cell(std::int64_t x, std::int64_t y, std::int64_t z) {
  std::uint64_t h = static_cast<std::uint64_t>(x) * 0x9E3779B97F4A7C15u;
  h = (h ^ (h >> 29) ^ static_cast<std::uint64_t>(y)) * 0xBF58476D1CE4E5B9u;
  h = (h ^ (h >> 32) ^ static_cast<std::uint64_t>(z)) * 0x94D049BB133111EBu;
  return h ^ (h >> 31);
}

/// Calls visit(hash, is_home) for each grid cell the node lies in or touches.
template <class Visit>
void each_grid_cell(const Vector3& at, const Vector3& low, double cell_size, double margin, Visit&& visit) {
  // Layouts love round numbers; an origin off any round number keeps whole planes of nodes away from the cells' walls.
  constexpr double offset = 0.38196601125;
  std::array<std::array<std::int64_t, 2>, 3> range{};
  Vector3 scaled{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    scaled[axis] = (at[axis] - low[axis]) / cell_size + offset;
    range[axis] = {static_cast<std::int64_t>(std::floor(scaled[axis] - margin)),
                   static_cast<std::int64_t>(std::floor(scaled[axis] + margin))};
  }
  const std::array<std::int64_t, 3> home{static_cast<std::int64_t>(std::floor(scaled[0])),
                                         static_cast<std::int64_t>(std::floor(scaled[1])),
                                         static_cast<std::int64_t>(std::floor(scaled[2]))};
  for (std::int64_t x = range[0][0]; x <= range[0][1]; ++x) {
    for (std::int64_t y = range[1][0]; y <= range[1][1]; ++y) {
      for (std::int64_t z = range[2][0]; z <= range[2][1]; ++z) {
        visit(hash_cell(x, y, z), x == home[0] && y == home[1] && z == home[2]);
      }
    }
  }
}

struct Duplicates {
  Tally exact, near;
};

void find_in_cell(const Context& context, std::span<const GridEntry> entries, Duplicates& found) {
  const auto& nodes = context.mesh.nodes;
  for (std::size_t i = 1; i < entries.size(); ++i) {
    // A pair is counted in the home cell of its later node alone.
    if ((entries[i].node & 1) == 0) continue;
    const std::int64_t later = entries[i].node >> 1;
    const Vector3& at = nodes[static_cast<std::size_t>(later)];
    bool exact = false, near = false;
    int still_to_see = 64;  // after a near one: a heap of nodes on one spot must not cost its square
    for (std::size_t j = i; j-- > 0 && entries[j].cell == entries[i].cell && !exact && still_to_see > 0;) {
      const std::int64_t earlier = entries[j].node >> 1;
      if (earlier == later) continue;  // two touched cells with the same hash
      const Vector3 gap = nodes[static_cast<std::size_t>(earlier)] - at;
      exact = gap[0] == 0 && gap[1] == 0 && gap[2] == 0;
      near = near || length(gap) <= context.tolerance;
      still_to_see -= near ? 1 : 0;
    }
    if (exact) {
      found.exact.add(later);
    } else if (near) {
      found.near.add(later);
    }
  }
}

Duplicates find_duplicates(const Context& context) {
  const auto& nodes = context.mesh.nodes;
  const double tolerance = std::max(context.tolerance, 1e-300);
  // A thousand tolerances wide: few nodes touch a wall, few cells hold two nodes.
  constexpr double cells_per_tolerance = 1.0 / 1024;
  const double cell_size = tolerance / cells_per_tolerance;
  PartitionPlan plan;
  plan.num_threads = context.num_threads;
  plan.num_items = context.num_nodes();
  const int bits = static_cast<int>(std::bit_width(static_cast<std::uint64_t>(plan.num_items) >> 13));
  plan.num_partitions = std::int64_t{1} << bits;
  plan.max_entries_at_once = std::max<std::int64_t>(1 << 20, plan.num_items / 2);
  std::vector<Duplicates> found(static_cast<std::size_t>(plan.num_threads));
  partition_entries<GridEntry>(
      plan,
      [&](std::int64_t first, std::int64_t last, auto&& emit) {
        for (std::int64_t i = first; i < last; ++i) {
          each_grid_cell(
              nodes[static_cast<std::size_t>(i)], context.low, cell_size, 1.01 * cells_per_tolerance,
              [&](std::uint64_t hash, bool home) {
                emit(bits == 0 ? 0 : static_cast<std::int64_t>(hash >> (64 - bits)), GridEntry{hash, i << 1 | (home ? 1 : 0)});
              });
        }
      },
      [&](int worker, std::int64_t, std::span<GridEntry> entries) {
        std::sort(entries.begin(), entries.end(),
                  [](const GridEntry& a, const GridEntry& b) { return a.cell != b.cell ? a.cell < b.cell : a.node < b.node; });
        find_in_cell(context, entries, found[static_cast<std::size_t>(worker)]);
      });
  Duplicates all;
  for (const Duplicates& mine : found) {
    all.exact.merge(mine.exact);
    all.near.merge(mine.near);
  }
  return all;
}

}  // namespace

void check_nodes(const Context& context, Report& report) {
  CheckLog log(report, context, "nodes");
  log.examined(context.num_nodes());
  const Tally orphans = find_orphans(context);
  log.found("node.orphan", FindingSeverity::error, fmt::format("{} nodes belong to no cell", orphans.count()), orphans,
            PlaceKind::node);
  if (!context.has_geometry || context.num_nodes() == 0) return;
  const Duplicates duplicates = find_duplicates(context);
  log.found("node.duplicate", FindingSeverity::error,
            fmt::format("{} nodes have the very coordinates of an earlier node", duplicates.exact.count()), duplicates.exact,
            PlaceKind::node);
  log.found("node.near_duplicate", FindingSeverity::error,
            fmt::format("{} nodes lie within {:.3g} (1e-9 of the bounding box) of an earlier node", duplicates.near.count(),
                        context.tolerance),
            duplicates.near, PlaceKind::node);
}

}  // namespace pcbmesh::validation::checks
