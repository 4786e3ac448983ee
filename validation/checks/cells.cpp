// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>

#include "validation/checks/cell_geometry.hpp"
#include "validation/checks/checks.hpp"
#include "validation/checks/orientation.hpp"
#include "validation/checks/parallel.hpp"

namespace pcbmesh::validation::checks {
namespace {

// The rounding of a corner's triple product is below 1e-15 of its edges' lengths (see orientation): beyond this its sign is
// certain, below it exact arithmetic decides.
constexpr double certain_corner = 1e-14;

struct CellTallies {
  Tally inverted, folded, flat, nearly_flat;
};

/// Sums of one slice of cells, by tag slot in the order met.
struct SliceSums {
  std::vector<int> slots;
  std::vector<CompensatedSum> volumes;
  std::vector<std::int64_t> counts;

  /// @param place_of_slot  scratch of the worker: place in this slice's vectors + 1, 0 = not met yet
  void add(int slot, double volume, std::vector<std::int32_t>& place_of_slot) {
    std::int32_t& place = place_of_slot[static_cast<std::size_t>(slot)];
    if (place == 0) {
      slots.push_back(slot);
      volumes.emplace_back();
      counts.push_back(0);
      place = static_cast<std::int32_t>(slots.size());
    }
    volumes[static_cast<std::size_t>(place) - 1].add(volume);
    ++counts[static_cast<std::size_t>(place) - 1];
  }
  void forget(std::vector<std::int32_t>& place_of_slot) const {
    for (const int slot : slots) place_of_slot[static_cast<std::size_t>(slot)] = 0;
  }
};

enum class Shape { fine, inverted, folded, flat, nearly_flat };

template <mesh::CellKind kind>
Shape judge_corners(const std::array<Vector3, 8>& at) {
  int negative = 0, flat = 0, doubtful = 0, corners = 0;
  for (const CornerFrame& frame : frames_of<kind>()) {
    const auto point = [&](int i) -> const Vector3& { return at[static_cast<std::size_t>(i)]; };
    const Vector3 a = point(frame.e1) - point(frame.at);
    const Vector3 b = point(frame.e2) - point(frame.at);
    const Vector3 c = point(frame.e3) - point(frame.at);
    const double jacobian = triple(a, b, c);
    const double scale = dot(a, a) * dot(b, b) * dot(c, c);
    ++corners;
    int sign = jacobian > 0 ? 1 : -1;
    // Written so that an underflow to zero and an overflow are in doubt.
    if (!(jacobian * jacobian > certain_corner * certain_corner * scale)) {
      ++doubtful;
      sign = orientation_exact(point(frame.at), point(frame.e1), point(frame.e2), point(frame.e3));
    }
    negative += sign < 0 ? 1 : 0;
    flat += sign == 0 ? 1 : 0;
  }
  if (negative == corners) return Shape::inverted;
  if (negative > 0) return Shape::folded;
  if (flat > 0) return Shape::flat;
  return doubtful > 0 ? Shape::nearly_flat : Shape::fine;
}

template <mesh::CellKind kind>
void judge_slice(const Context& context, const mesh::CellBlock& block, std::int64_t first_id, std::int64_t begin,
                 std::int64_t end, CellTallies& tallies, SliceSums& sums, std::vector<std::int32_t>& place_of_slot) {
  for (std::int64_t i = begin; i < end; ++i) {
    const auto index = static_cast<std::size_t>(i);
    const std::array<Vector3, 8> at = points_of<kind>(context, block, index);
    switch (judge_corners<kind>(at)) {
      case Shape::fine:
        break;
      case Shape::inverted:
        tallies.inverted.add(first_id + i);
        break;
      case Shape::folded:
        tallies.folded.add(first_id + i);
        break;
      case Shape::flat:
        tallies.flat.add(first_id + i);
        break;
      case Shape::nearly_flat:
        tallies.nearly_flat.add(first_id + i);
        break;
    }
    sums.add(context.cell_tags.slot(block.tags[index]), volume_of<kind>(at), place_of_slot);
  }
  sums.forget(place_of_slot);
}

}  // namespace

VolumeSums check_cells(const Context& context, Report& report) {
  CheckLog log(report, context, "cells");
  const auto num_tags = static_cast<std::size_t>(context.cell_tags.size());
  std::vector<CompensatedSum> volumes(num_tags);
  VolumeSums result;
  result.of_tag.resize(num_tags);
  result.cells_of_tag.resize(num_tags);
  CellTallies all;
  std::vector<std::vector<std::int32_t>> places(static_cast<std::size_t>(context.num_threads),
                                                std::vector<std::int32_t>(num_tags, 0));
  for (std::size_t b = 0; b < context.mesh.cells.size(); ++b) {
    const mesh::CellBlock& block = context.mesh.cells[b];
    std::vector<CellTallies> tallies(static_cast<std::size_t>(context.num_threads));
    std::vector<SliceSums> sums(static_cast<std::size_t>((block.size() + slice_length - 1) / slice_length));
    for_each_slice(
        context.num_threads, block.size(), [&](int worker, std::int64_t slice, std::int64_t begin, std::int64_t end) {
          with_kind(block.kind, [&]<mesh::CellKind kind>() {
            judge_slice<kind>(context, block, context.first_cell[b], begin, end, tallies[static_cast<std::size_t>(worker)],
                              sums[static_cast<std::size_t>(slice)], places[static_cast<std::size_t>(worker)]);
          });
        });
    for (const CellTallies& mine : tallies) {
      all.inverted.merge(mine.inverted);
      all.folded.merge(mine.folded);
      all.flat.merge(mine.flat);
      all.nearly_flat.merge(mine.nearly_flat);
    }
    for (const SliceSums& slice : sums) {
      for (std::size_t k = 0; k < slice.slots.size(); ++k) {
        const auto slot = static_cast<std::size_t>(slice.slots[k]);
        volumes[slot].add(slice.volumes[k].value());
        result.cells_of_tag[slot] += slice.counts[k];
      }
    }
  }
  CompensatedSum total;
  for (std::size_t slot = 0; slot < num_tags; ++slot) {
    result.of_tag[slot] = volumes[slot].value();
    total.add(result.of_tag[slot]);
  }
  result.total = total.value();
  result.all_positive = all.inverted.count() + all.folded.count() + all.flat.count() == 0;
  log.examined(context.num_cells());
  log.found("cell.inverted", FindingSeverity::error,
            fmt::format("{} cells are inside out: the Jacobian is negative at every corner", all.inverted.count()),
            all.inverted, PlaceKind::cell);
  log.found("cell.folded", FindingSeverity::error,
            fmt::format("{} cells are folded: the Jacobian is negative at some corners", all.folded.count()), all.folded,
            PlaceKind::cell);
  log.found("cell.flat", FindingSeverity::error,
            fmt::format("{} cells have a corner of no volume: coinciding corners or edges in one plane", all.flat.count()),
            all.flat, PlaceKind::cell);
  log.found("cell.nearly_flat",
            fmt::format("{} cells have a corner whose volume is positive, but smaller than the rounding of doubles",
                        all.nearly_flat.count()),
            all.nearly_flat, PlaceKind::cell);
  return result;
}

}  // namespace pcbmesh::validation::checks
