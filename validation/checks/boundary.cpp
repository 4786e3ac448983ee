// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "validation/checks/checks.hpp"
#include "validation/checks/parallel.hpp"

namespace pcbmesh::validation::checks {
namespace {

struct BoundaryEdge {
  std::int64_t low, high;  ///< nodes
  std::int64_t face;       ///< half face << 1 | (1 if the face runs from high to low)
};

struct EdgeTallies {
  Tally open, pinched;
  std::int64_t num_edges = 0;
};

void judge_edges(std::span<BoundaryEdge> edges, EdgeTallies& tallies) {
  std::sort(edges.begin(), edges.end(), [](const BoundaryEdge& a, const BoundaryEdge& b) {
    return std::tie(a.low, a.high, a.face) < std::tie(b.low, b.high, b.face);
  });
  for (std::size_t begin = 0; begin < edges.size();) {
    std::size_t end = begin;
    std::int64_t balance = 0;
    for (; end < edges.size() && edges[end].low == edges[begin].low && edges[end].high == edges[begin].high; ++end) {
      balance += (edges[end].face & 1) != 0 ? -1 : 1;
    }
    ++tallies.num_edges;
    if (balance != 0) {
      tallies.open.add(edges[begin].face >> 1);
    } else if (end - begin > 2) {
      tallies.pinched.add(edges[begin].face >> 1);
    }
    begin = end;
  }
}

}  // namespace

void check_boundary_edges(const Context& context, const FaceMatch& match, Report& report) {
  CheckLog log(report, context, "boundary edges");
  constexpr int shift = 12;
  PartitionPlan plan;
  plan.num_threads = context.num_threads;
  plan.num_items = static_cast<std::int64_t>(match.boundary.size());
  plan.num_partitions = (context.num_nodes() >> shift) + 1;
  plan.max_entries_at_once = std::max<std::int64_t>(1 << 20, context.num_cells());
  std::vector<EdgeTallies> tallies(static_cast<std::size_t>(plan.num_threads));
  partition_entries<BoundaryEdge>(
      plan,
      [&](std::int64_t first, std::int64_t last, auto&& emit) {
        std::array<std::int64_t, 4> corners{};
        for (std::int64_t i = first; i < last; ++i) {
          const std::int64_t half_face = match.boundary[static_cast<std::size_t>(i)];
          const auto n = static_cast<std::size_t>(context.corners_of_half_face(half_face, corners));
          for (std::size_t k = 0; k < n; ++k) {
            const std::int64_t a = corners[k], b = corners[k + 1 == n ? 0 : k + 1];
            if (a == b) continue;  // of a degenerate face: not an edge
            emit(std::min(a, b) >> shift, BoundaryEdge{std::min(a, b), std::max(a, b), half_face << 1 | (a > b ? 1 : 0)});
          }
        }
      },
      [&](int worker, std::int64_t, std::span<BoundaryEdge> edges) {
        judge_edges(edges, tallies[static_cast<std::size_t>(worker)]);
      });
  EdgeTallies all;
  for (const EdgeTallies& mine : tallies) {
    all.open.merge(mine.open);
    all.pinched.merge(mine.pinched);
    all.num_edges += mine.num_edges;
  }
  log.examined(all.num_edges);
  log.found("boundary.open", FindingSeverity::error,
            fmt::format("{} edges of the boundary are not closed: its faces do not cancel there", all.open.count()), all.open,
            PlaceKind::half_face);
  log.found(
      "boundary.pinched", FindingSeverity::warning,
      fmt::format("{} edges of the boundary join four or more boundary faces: the domain touches itself along an edge only",
                  all.pinched.count()),
      all.pinched, PlaceKind::half_face);
}

}  // namespace pcbmesh::validation::checks
