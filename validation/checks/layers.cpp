// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "validation/checks/checks.hpp"
#include "validation/checks/parallel.hpp"

namespace pcbmesh::validation::checks {
namespace {

struct Interval {
  double low = 0, high = 0;
};

/// Heights of layers and levels in the unit of the mesh.
class Stack {
 public:
  explicit Stack(const Context& context) {
    const Expectation& expected = *context.expectation;
    for (const double z : expected.levels_m) levels_.push_back(z / expected.unit_m);
    of_slot_.resize(static_cast<std::size_t>(context.cell_tags.size()));
    for (const auto& volume : expected.volumes) {
      const int slot = context.cell_tags.slot(volume.tag);
      if (slot < 0) continue;
      for (const auto& layer : expected.layers) {
        if (layer.name == volume.layer) {
          of_slot_[static_cast<std::size_t>(slot)].push_back(
              {layer.z_min_m / expected.unit_m, layer.z_max_m / expected.unit_m});
        }
      }
    }
  }

  [[nodiscard]] const std::vector<double>& levels() const { return levels_; }
  [[nodiscard]] const std::vector<Interval>& of_slot(int slot) const { return of_slot_[static_cast<std::size_t>(slot)]; }
  /// Index of the level within the tolerance of z, or -1.
  [[nodiscard]] std::int32_t level_at(double z, double tolerance) const {
    const auto above = std::lower_bound(levels_.begin(), levels_.end(), z);
    std::int32_t best = -1;
    double nearest = tolerance;
    for (auto i = std::max<std::ptrdiff_t>(0, above - levels_.begin() - 1);
         i <= above - levels_.begin() && i < static_cast<std::ptrdiff_t>(levels_.size()); ++i) {
      const double gap = std::abs(levels_[static_cast<std::size_t>(i)] - z);
      if (gap > nearest) continue;
      nearest = gap;
      best = static_cast<std::int32_t>(i);
    }
    return best;
  }

 private:
  std::vector<double> levels_;
  std::vector<std::vector<Interval>> of_slot_;
};

/// Level of each node, -1 = between levels.
std::vector<std::int32_t> check_levels(const Context& context, const Stack& stack, CheckLog& log) {
  std::vector<std::int32_t> level_of(context.mesh.nodes.size(), -1);
  // Nodes in the middle of edges lie between levels by right, and stray ones are another check's business.
  std::vector<std::uint8_t> is_corner(level_of.size(), 0);
  for (const mesh::CellBlock& block : context.mesh.cells) {
    for (const std::int64_t node : block.corners) is_corner[static_cast<std::size_t>(node)] = 1;
  }
  Tally off, uneven;
  std::vector<std::map<double, std::int64_t>> heights(stack.levels().size());
  for (std::size_t i = 0; i < level_of.size(); ++i) {
    if (is_corner[i] == 0) continue;
    const double z = context.mesh.nodes[i][2];
    level_of[i] = stack.level_at(z, context.tolerance);
    if (level_of[i] < 0) {
      off.add(static_cast<std::int64_t>(i));
    } else {
      ++heights[static_cast<std::size_t>(level_of[i])][z];
    }
  }
  std::vector<double> usual(heights.size(), 0);
  std::int64_t num_empty = 0;
  std::string empty;
  for (std::size_t k = 0; k < heights.size(); ++k) {
    if (heights[k].empty()) {
      if (++num_empty <= 8) empty += fmt::format("{}{:.9g}", empty.empty() ? "" : ", ", stack.levels()[k]);
      continue;
    }
    usual[k] = std::ranges::max_element(heights[k], {}, [](const auto& entry) { return entry.second; })->first;
  }
  for (std::size_t i = 0; i < level_of.size(); ++i) {
    if (level_of[i] >= 0 && context.mesh.nodes[i][2] != usual[static_cast<std::size_t>(level_of[i])]) {
      uneven.add(static_cast<std::int64_t>(i));
    }
  }
  log.found("layer.off_level", fmt::format("{} nodes lie on none of the {} levels of tags.json", off.count(), heights.size()),
            off, PlaceKind::node);
  log.found("layer.uneven_level",
            fmt::format("{} nodes lie within the tolerance of their level, but not exactly on it", uneven.count()), uneven,
            PlaceKind::node);
  if (num_empty > 0) {
    log.found("layer.incomplete",
              fmt::format("{} levels of tags.json carry no node: {}{}", num_empty, empty, num_empty > 8 ? ", ..." : ""),
              num_empty);
  }
  return level_of;
}

struct CellTallies {
  Tally outside, spans;
  std::vector<std::uint8_t> filled;  ///< [slot * levels + level]: the group has a cell that starts at the level
};

void judge_cell(const Context& context, const Stack& stack, const std::vector<std::int32_t>& level_of, std::int64_t cell,
                std::int32_t tag, std::span<const std::int64_t> corners, CellTallies& mine) {
  double low = std::numeric_limits<double>::max(), high = -low;
  std::int32_t first = std::numeric_limits<std::int32_t>::max(), last = -1;
  for (const std::int64_t node : corners) {
    const auto i = static_cast<std::size_t>(node);
    low = std::min(low, context.mesh.nodes[i][2]);
    high = std::max(high, context.mesh.nodes[i][2]);
    first = std::min(first, level_of[i]);
    last = std::max(last, level_of[i]);
  }
  const int slot = context.cell_tags.slot(tag);
  const auto& intervals = stack.of_slot(slot);
  const auto holds = [&](const Interval& one) {
    return low >= one.low - context.tolerance && high <= one.high + context.tolerance;
  };
  if (!intervals.empty() && std::ranges::none_of(intervals, holds)) mine.outside.add(cell);
  if (first < 0 || stack.levels().empty()) return;
  if (last - first != 1) mine.spans.add(cell);
  mine.filled[static_cast<std::size_t>(slot) * stack.levels().size() + static_cast<std::size_t>(first)] = 1;
}

/// Every sub-layer of every layer holds a cell of one of the layer's groups.
void check_sublayers(const Context& context, const Stack& stack, const std::vector<std::uint8_t>& filled, CheckLog& log) {
  const std::size_t num_levels = stack.levels().size();
  std::string first;
  std::int64_t count = 0;
  for (const auto& layer : context.expectation->layers) {
    for (std::size_t k = 0; k + 1 < num_levels; ++k) {
      const double middle = 0.5 * (stack.levels()[k] + stack.levels()[k + 1]) * context.expectation->unit_m;
      if (!(middle > layer.z_min_m && middle < layer.z_max_m)) continue;
      const bool found = std::ranges::any_of(context.expectation->volumes, [&](const Expectation::Volume& volume) {
        const int slot = context.cell_tags.slot(volume.tag);
        return slot >= 0 && volume.layer == layer.name && filled[static_cast<std::size_t>(slot) * num_levels + k] != 0;
      });
      if (!found && ++count == 1) {
        first = fmt::format("{} between {:.9g} and {:.9g}", layer.name, stack.levels()[k], stack.levels()[k + 1]);
      }
    }
  }
  if (count == 0) return;
  log.found("layer.incomplete", fmt::format("{} sub-layers hold no cell of their layer, first {}", count, first), count);
}

}  // namespace

void check_layers(const Context& context, Report& report) {
  if (context.expectation == nullptr || (context.expectation->layers.empty() && context.expectation->levels_m.empty())) return;
  CheckLog log(report, context, "layers");
  log.examined(context.num_cells());
  const Stack stack(context);
  const std::vector<std::int32_t> level_of = check_levels(context, stack, log);
  CellTallies empty;
  empty.filled.assign(static_cast<std::size_t>(context.cell_tags.size()) * stack.levels().size(), 0);
  std::vector<CellTallies> tallies(static_cast<std::size_t>(context.num_threads), empty);
  for (std::size_t b = 0; b < context.mesh.cells.size(); ++b) {
    const mesh::CellBlock& block = context.mesh.cells[b];
    const auto n = static_cast<std::size_t>(corners_of(block.kind));
    for_each_slice(context.num_threads, block.size(), [&](int worker, std::int64_t, std::int64_t begin, std::int64_t end) {
      for (std::int64_t i = begin; i < end; ++i) {
        judge_cell(context, stack, level_of, context.first_cell[b] + i, block.tags[static_cast<std::size_t>(i)],
                   std::span(block.corners).subspan(static_cast<std::size_t>(i) * n, n),
                   tallies[static_cast<std::size_t>(worker)]);
      }
    });
  }
  CellTallies all = std::move(empty);
  for (const CellTallies& mine : tallies) {
    all.outside.merge(mine.outside);
    all.spans.merge(mine.spans);
    for (std::size_t i = 0; i < all.filled.size(); ++i) all.filled[i] |= mine.filled[i];
  }
  log.found("layer.outside", fmt::format("{} cells reach beyond the layer their group belongs to", all.outside.count()),
            all.outside, PlaceKind::cell);
  log.found("layer.spans_levels",
            fmt::format("{} cells do not reach from one level to the next: they leave a level out, or lie flat in one",
                        all.spans.count()),
            all.spans, PlaceKind::cell);
  if (!stack.levels().empty()) check_sublayers(context, stack, all.filled, log);
}

}  // namespace pcbmesh::validation::checks
