// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/overlay/ledger.hpp"

#include <algorithm>
#include <limits>

#include "src/overlay/cell_grid.hpp"

namespace pcbmesh::overlay {
namespace {

/// Nearest exact outline of a body.
class OutlineFinder {
 public:
  OutlineFinder(const EdgeGraph& outlines, const LabelPool& labels, Nm least_cell)
      : outlines_(outlines),
        labels_(labels),
        grid_(box_of(outlines.points, outlines.edges), outlines.edges.size(), least_cell) {
    lists_.start(grid_.num_cells());
    for (std::size_t e = 0; e < outlines.edges.size(); ++e) {
      grid_.along_segment(start_of(e), end_of(e), 0, [&](std::int32_t first, std::int32_t last) {
        for (std::int32_t cell = first; cell <= last; ++cell) lists_.put(cell, static_cast<std::int32_t>(e));
      });
    }
    lists_.finish();
  }

  [[nodiscard]] double distance_to(Point p, std::int32_t body, double first_reach) const {
    const double x = static_cast<double>(p.x), y = static_cast<double>(p.y);
    for (double reach = first_reach; reach < first_reach * 2000; reach *= 4) {
      double best2 = std::numeric_limits<double>::infinity();
      grid_.over_box(x - reach, y - reach, x + reach, y + reach, [&](std::int32_t first, std::int32_t last) {
        for (const std::int32_t e : lists_.items(first, last)) {
          const double d2 = segment_distance2(p, start_of(ix(e)), end_of(ix(e)));
          if (d2 < best2 && labels_.delta(outlines_.edges[ix(e)].label, body) != 0) best2 = d2;
        }
      });
      if (best2 <= reach * reach) return std::sqrt(best2);
    }
    return std::numeric_limits<double>::infinity();
  }

 private:
  [[nodiscard]] Point start_of(std::size_t e) const { return outlines_.points[ix(outlines_.edges[e].u)]; }
  [[nodiscard]] Point end_of(std::size_t e) const { return outlines_.points[ix(outlines_.edges[e].v)]; }
  const EdgeGraph& outlines_;
  const LabelPool& labels_;
  CellGrid grid_;
  CellLists lists_;
};

}  // namespace

std::vector<SnapRecord> make_ledger(const model::Model& model, const Sheets& sheets, const EdgeGraph& graph,
                                    const std::vector<double>& area_mm2, const LabelPool& labels, Nm tolerance,
                                    const Progress& progress) {
  const std::size_t num_bodies = model.bodies().size();
  std::vector<std::int32_t> sheet_of(num_bodies, 0);
  std::vector<OutlineFinder> finders;
  finders.reserve(sheets.sheets.size());
  for (std::size_t s = 0; s < sheets.sheets.size(); ++s) {
    finders.emplace_back(sheets.sheets[s].outlines, labels, tolerance);
    for (const std::int32_t b : sheets.sheets[s].bodies) sheet_of[ix(b)] = static_cast<std::int32_t>(s);
  }
  struct Visit {
    std::int32_t vertex, body;
    auto operator<=>(const Visit&) const = default;
  };
  std::vector<Visit> visits;
  for (const Edge& e : graph.edges) {
    for (const Increment& in : labels.entries(e.label)) {
      if (in.body < 2) continue;
      visits.push_back({e.u, in.body});
      visits.push_back({e.v, in.body});
    }
  }
  std::sort(visits.begin(), visits.end());
  visits.erase(std::unique(visits.begin(), visits.end()), visits.end());
  std::vector<SnapRecord> by_body(num_bodies);
  for (std::size_t k = 0; k < visits.size(); ++k) {
    if (k % 4096 == 0) progress.check();
    const auto [vertex, body] = visits[k];
    const Point p = graph.points[ix(vertex)];
    const double moved = finders[ix(sheet_of[ix(body)])].distance_to(p, body, static_cast<double>(tolerance));
    SnapRecord& record = by_body[ix(body)];
    if (!(moved > 1)) continue;
    ++record.num_moved;
    const Nm move = std::isfinite(moved) ? std::llround(moved) : std::numeric_limits<Nm>::max();
    if (move > record.max_move_nm) record.max_move_nm = move, record.at = p;
  }
  std::vector<SnapRecord> ledger;
  for (std::size_t b = 2; b < num_bodies; ++b) {
    by_body[b].body = static_cast<std::int32_t>(b);
    by_body[b].area_before_mm2 = sheets.area_mm2[b];
    by_body[b].area_after_mm2 = area_mm2[b];
    ledger.push_back(by_body[b]);
  }
  return ledger;
}

}  // namespace pcbmesh::overlay
