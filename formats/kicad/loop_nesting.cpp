// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/kicad/loop_nesting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats::kicad {
namespace {

using geometry::Point;
using geometry::Ring;

struct Loop {
  Ring ring;
  geometry::Box box;
  double area = 0;
  std::vector<std::size_t> around;  ///< loops that contain this one
};

struct Edge {
  Point a, b;  ///< a.x <= b.x
  std::size_t loop = 0, index = 0, loop_size = 0;
};

bool is_inside(const Ring& ring, Point p) {
  bool inside = false;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const Point a = ring[j], b = ring[i];
    if ((a.y > p.y) == (b.y > p.y)) continue;
    inside ^= (geometry::orientation(a, b, p) > 0) == (b.y > a.y);
  }
  return inside;
}

/// Most of a few corners decide, since loops may touch.
bool contains(const Loop& outer, const Loop& inner) {
  if (inner.box.min.x < outer.box.min.x || inner.box.max.x > outer.box.max.x || inner.box.min.y < outer.box.min.y ||
      inner.box.max.y > outer.box.max.y)
    return false;
  const std::size_t samples = std::min<std::size_t>(7, inner.ring.size());
  std::size_t hits = 0;
  for (std::size_t k = 0; k < samples; ++k) hits += is_inside(outer.ring, inner.ring[k * inner.ring.size() / samples]) ? 1 : 0;
  return 2 * hits > samples;
}

bool cross(const Edge& e, const Edge& f) {
  return geometry::orientation(e.a, e.b, f.a) * geometry::orientation(e.a, e.b, f.b) < 0 &&
         geometry::orientation(f.a, f.b, e.a) * geometry::orientation(f.a, f.b, e.b) < 0;
}

void warn_crossing(Reading& reading, const std::vector<EdgePiece>& loops, const Edge& e, const Edge& f) {
  // A place between the four ends is near enough to find it.
  const double x = static_cast<double>(std::max(e.a.x, f.a.x) + std::min(e.b.x, f.b.x)) * 0.5e-6;
  const double y = static_cast<double>(std::max(std::min(e.a.y, e.b.y), std::min(f.a.y, f.b.y)) +
                                       std::min(std::max(e.a.y, e.b.y), std::max(f.a.y, f.b.y))) *
                   0.5e-6;
  Spot spot{.file = reading.tree.file(), .line = loops[e.loop].line, .layer = "Edge.Cuts", .at_mm = std::array{x, y}};
  if (e.loop == f.loop)
    reading.diagnostics.warn("kicad.outline_crosses_itself", "a board outline or cut-out crosses itself; mend Edge.Cuts",
                             std::move(spot));
  else
    reading.diagnostics.warn("kicad.outlines_cross", "two board outlines or cut-outs cross each other; mend Edge.Cuts",
                             std::move(spot));
}

}  // namespace

void report_crossings(Reading& reading, const std::vector<EdgePiece>& loops) {
  constexpr std::size_t most_comparisons = 50'000'000;
  constexpr std::int64_t most_crossings = 1000;
  std::vector<Edge> edges;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const Ring ring = geometry::flatten(loops[i].path, {});
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const auto [a, b] = std::minmax(ring[k], ring[(k + 1) % ring.size()]);
      edges.push_back({a, b, i, k, ring.size()});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& e, const Edge& f) {
    return std::tie(e.a, e.b, e.loop, e.index) < std::tie(f.a, f.b, f.loop, f.index);
  });
  std::vector<std::size_t> active;
  std::size_t comparisons = 0;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Edge& e = edges[i];
    std::erase_if(active, [&](std::size_t k) { return edges[k].b.x < e.a.x; });
    comparisons += active.size();
    const std::int64_t crossings =
        reading.diagnostics.count("kicad.outline_crosses_itself") + reading.diagnostics.count("kicad.outlines_cross");
    if (comparisons > most_comparisons || crossings > most_crossings) {
      reading.diagnostics.note("kicad.outline_not_checked",
                               "the board outline has too many edges or crossings to look for more of them");
      return;
    }
    const auto [low, high] = std::minmax(e.a.y, e.b.y);
    for (const std::size_t k : active) {
      const Edge& f = edges[k];
      if (std::max(f.a.y, f.b.y) < low || std::min(f.a.y, f.b.y) > high) continue;
      if (cross(e, f)) warn_crossing(reading, loops, e, f);
    }
    active.push_back(i);
  }
}

std::vector<board::Outline> nest(const Reading& reading, std::vector<EdgePiece> pieces) {
  constexpr std::size_t most_work = 1'000'000'000;
  std::size_t work = 0;
  constexpr geometry::ArcOptions fine{.sagitta_nm = nm_per_um};
  std::vector<Loop> loops(pieces.size());
  std::vector<std::size_t> order(pieces.size());
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    loops[i].ring = geometry::flatten(pieces[i].path, fine);
    for (const Point p : loops[i].ring) loops[i].box.add(p);
    loops[i].area = std::abs(geometry::area_mm2(loops[i].ring));
    order[i] = i;
  }
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return std::pair(loops[a].box.min.x, a) < std::pair(loops[b].box.min.x, b); });
  std::vector<std::size_t> active;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::size_t i = order[k];
    std::erase_if(active, [&](std::size_t j) { return loops[j].box.max.x < loops[i].box.min.x; });
    for (const std::size_t j : active)
      work += 1 + (loops[j].box.touches(loops[i].box) ? loops[j].ring.size() + loops[i].ring.size() : 0);
    if (work > most_work)
      throw Error(
          ErrorCode::outline_invalid,
          fmt::format("{} closed loops on Edge.Cuts overlap too much to be told apart; is this a board edge?", loops.size()),
          {.file = reading.tree.file(), .line = pieces[i].line, .layer = "Edge.Cuts"});
    for (const std::size_t j : active) {
      const std::size_t big = loops[j].area > loops[i].area || (loops[j].area == loops[i].area && j < i) ? j : i;
      const std::size_t small = big == j ? i : j;
      if (contains(loops[big], loops[small])) loops[small].around.push_back(big);
    }
    active.push_back(i);
  }
  std::vector<board::Outline> outlines;
  std::vector<std::size_t> outline_of(loops.size());
  for (std::size_t i = 0; i < loops.size(); ++i)
    if (loops[i].around.size() % 2 == 0) {
      outline_of[i] = outlines.size();
      outlines.push_back({std::move(pieces[i].path), {}});
    }
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (loops[i].around.size() % 2 == 0) continue;
    std::size_t parent = loops[i].around.front();
    bool found = false;
    for (const std::size_t j : loops[i].around)
      if (loops[j].around.size() % 2 == 0 && (!found || loops[j].area < loops[parent].area)) parent = j, found = true;
    if (found) outlines[outline_of[parent]].cutouts.push_back(std::move(pieces[i].path));
  }
  return outlines;
}

}  // namespace pcbmesh::formats::kicad
