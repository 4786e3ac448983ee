// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/kicad/outlines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "formats/kicad/loop_nesting.hpp"

namespace pcbmesh::formats::kicad {
namespace {

using geometry::Path;
using geometry::Point;

constexpr double joined_nm = 1000, widest_gap_nm = 10000;

double distance(Point a, Point b) {
  return std::hypot(static_cast<double>(a.x - b.x), static_cast<double>(a.y - b.y));
}

Path reversed(const Path& path) {
  Path out = path;
  std::reverse(out.points.begin(), out.points.end());
  const auto last = static_cast<std::int32_t>(path.points.size()) - 1;
  out.arc_starts.clear();
  for (auto i = path.arc_starts.rbegin(); i != path.arc_starts.rend(); ++i) out.arc_starts.push_back(last - (*i + 2));
  return out;
}

/// The same piece whichever way it was drawn.
Path directed(const Path& path) {
  if (path.closed || path.points.front() <= path.points.back()) return path;
  return reversed(path);
}

bool comes_before(const Path& a, const Path& b) {
  return std::tie(a.points, a.arc_starts) < std::tie(b.points, b.arc_starts);
}

/// Drops pieces of no length and all but the first of pieces drawn twice.
std::vector<EdgePiece> distinct(std::vector<EdgePiece> pieces) {
  for (EdgePiece& piece : pieces) piece.path = directed(piece.path);
  std::vector<std::size_t> order(pieces.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return comes_before(pieces[a].path, pieces[b].path); });
  std::vector<bool> keep(pieces.size(), true);
  for (std::size_t k = 1; k < order.size(); ++k)
    if (pieces[order[k]].path == pieces[order[k - 1]].path) keep[order[k]] = false;
  std::vector<EdgePiece> out;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const auto& points = pieces[i].path.points;
    const bool has_length = std::any_of(points.begin(), points.end(), [&](Point p) { return p != points.front(); });
    if (keep[i] && has_length) out.push_back(std::move(pieces[i]));
  }
  return out;
}

class Chainer {
 public:
  Chainer(Reading& reading, std::vector<EdgePiece> pieces)
      : reading_(reading), pieces_(std::move(pieces)), partner_(pieces_.size() * 2, none) {}

  std::vector<EdgePiece> run() {
    match_ends();
    std::vector<EdgePiece> loops;
    std::vector<bool> used(pieces_.size(), false);
    for (std::size_t i = 0; i < pieces_.size(); ++i)
      for (std::size_t side = 0; side < 2; ++side)
        if (!used[i] && partner_[2 * i + side] == none) report_open(walk(2 * i + side, used));
    for (std::size_t i = 0; i < pieces_.size(); ++i)
      if (!used[i]) {
        EdgePiece loop = walk(2 * i, used);
        loop.path.points.pop_back();
        loop.path.closed = true;
        loops.push_back(std::move(loop));
      }
    return loops;
  }

 private:
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  [[nodiscard]] Point end_point(std::size_t end) const {
    const auto& points = pieces_[end / 2].path.points;
    return end % 2 == 0 ? points.front() : points.back();
  }

  struct Pair {
    double distance;
    std::size_t a, b;
  };

  /// Nearest ends first, each end once.
  void match_ends() {
    std::vector<std::size_t> ends(partner_.size());
    for (std::size_t i = 0; i < ends.size(); ++i) ends[i] = i;
    std::sort(ends.begin(), ends.end(),
              [&](std::size_t a, std::size_t b) { return std::pair(end_point(a), a) < std::pair(end_point(b), b); });
    constexpr std::size_t most_neighbours = 32;  // a heap of ends in one place is no outline; do not try all pairs
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < ends.size(); ++i) {
      std::size_t near = 0;
      for (std::size_t j = i + 1; j < ends.size() && near < most_neighbours; ++j) {
        const Point a = end_point(ends[i]), b = end_point(ends[j]);
        if (static_cast<double>(b.x - a.x) > widest_gap_nm) break;
        const double gap = distance(a, b);
        if (gap > widest_gap_nm) continue;
        // A straight piece can't close on itself, however short.
        if (ends[i] / 2 == ends[j] / 2 && pieces_[ends[i] / 2].path.points.size() < 3) continue;
        pairs.push_back({gap, std::min(ends[i], ends[j]), std::max(ends[i], ends[j])});
        ++near;
      }
    }
    std::sort(pairs.begin(), pairs.end(),
              [](const Pair& p, const Pair& q) { return std::tie(p.distance, p.a, p.b) < std::tie(q.distance, q.a, q.b); });
    for (const Pair& pair : pairs) {
      if (partner_[pair.a] != none || partner_[pair.b] != none) continue;
      partner_[pair.a] = pair.b;
      partner_[pair.b] = pair.a;
      if (pair.distance > joined_nm)
        reading_.diagnostics.note("kicad.outline_gap_closed",
                                  fmt::format("gap of {:.2f} um in the board edge closed", pair.distance / 1000),
                                  place(end_point(pair.a), pieces_[pair.a / 2].line));
    }
  }

  /// Strings pieces together, entering the first one at `end`, until the chain ends or comes back.
  EdgePiece walk(std::size_t end, std::vector<bool>& used) const {
    EdgePiece chain{{}, pieces_[end / 2].line};
    while (end != none && !used[end / 2]) {
      used[end / 2] = true;
      const Path piece = end % 2 == 0 ? pieces_[end / 2].path : reversed(pieces_[end / 2].path);
      Path& path = chain.path;
      const std::size_t base = path.points.empty() ? 0 : path.points.size() - 1;
      path.points.insert(path.points.end(), piece.points.begin() + (path.points.empty() ? 0 : 1), piece.points.end());
      for (const std::int32_t i : piece.arc_starts) path.arc_starts.push_back(static_cast<std::int32_t>(base) + i);
      end = partner_[end ^ 1];
    }
    return chain;
  }

  [[nodiscard]] Spot place(Point at, std::int64_t line) const {
    return {.file = reading_.tree.file(),
            .line = line,
            .layer = "Edge.Cuts",
            .at_mm = std::array{static_cast<double>(at.x) * 1e-6, static_cast<double>(at.y) * 1e-6}};
  }

  void report_open(const EdgePiece& chain) {
    const Point a = chain.path.points.front(), b = chain.path.points.back();
    reading_.diagnostics.warn(
        "kicad.outline_open",
        fmt::format("board edge does not close: from ({:.4f}, {:.4f}) to ({:.4f}, {:.4f}) mm a gap of {:.4f} mm is left; this "
                    "part is ignored",
                    static_cast<double>(a.x) * 1e-6, static_cast<double>(a.y) * 1e-6, static_cast<double>(b.x) * 1e-6,
                    static_cast<double>(b.y) * 1e-6, distance(a, b) * 1e-6),
        place(b, chain.line));
  }

  Reading& reading_;
  std::vector<EdgePiece> pieces_;
  std::vector<std::size_t> partner_;  ///< per end (2 * piece + side): the end it is joined to
};

}  // namespace

void read_outlines(Reading& reading) {
  std::vector<EdgePiece> open, loops;
  for (EdgePiece& piece : distinct(std::move(reading.edges))) (piece.path.closed ? loops : open).push_back(std::move(piece));
  for (EdgePiece& loop : Chainer(reading, std::move(open)).run()) loops.push_back(std::move(loop));
  std::erase_if(loops, [](const EdgePiece& loop) { return loop.path.points.size() < 3; });
  if (loops.empty()) {
    reading.diagnostics.warn("kicad.no_outline",
                             "no closed board outline on Edge.Cuts; the study must say what the board's edge is",
                             {.file = reading.tree.file(), .layer = "Edge.Cuts"});
    return;
  }
  report_crossings(reading, loops);
  reading.parts.outlines = nest(reading, std::move(loops));
}

}  // namespace pcbmesh::formats::kicad
