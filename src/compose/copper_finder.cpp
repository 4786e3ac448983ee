// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/compose/copper_finder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pcbmesh/geometry/ring_contact.hpp"

namespace pcbmesh::compose {
namespace {

using geometry::Point;
using geometry::Ring;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Track segments of a figure, arcs as chords.
Ring centre_line(const board::Shape& shape, const geometry::ArcOptions& arcs) {
  if (shape.figure.filled || shape.figure.pen <= 0 || shape.figure.path.points.size() < 2) return {};
  return geometry::flatten(shape.figure.path, arcs);
}

struct Foot {
  double along = 0, distance = infinity;  ///< nanometres
};

Foot foot_on(Point p, Point a, Point b) {
  const double ux = static_cast<double>(b.x - a.x), uy = static_cast<double>(b.y - a.y);
  const double length = std::hypot(ux, uy);
  const double px = static_cast<double>(p.x - a.x), py = static_cast<double>(p.y - a.y);
  if (length == 0) return {0, std::hypot(px, py)};
  const double along = std::clamp((px * ux + py * uy) / length, 0.0, length);
  return {along, std::hypot(px - along * ux / length, py - along * uy / length)};
}

/// Section across the segment a-b at a distance from a.
Section across(Point a, Point b, double along, double width) {
  const double ux = static_cast<double>(b.x - a.x), uy = static_cast<double>(b.y - a.y), length = std::hypot(ux, uy);
  return {{static_cast<double>(a.x) + along * ux / length, static_cast<double>(a.y) + along * uy / length},
          {-uy / length, ux / length},
          width};
}

}  // namespace

Point Section::at(double share) const {
  return {std::llround(middle_nm[0] + share * width_nm * along[0]), std::llround(middle_nm[1] + share * width_nm * along[1])};
}

CopperFinder::CopperFinder(const board::Board& board, const study::Study& study)
    : board_(board), study_(study), by_layer_(board.copper_layers().size()) {
  boxes_.reserve(board.shapes().size());
  for (std::size_t i = 0; i < board.shapes().size(); ++i) {
    boxes_.push_back(geometry::bounds(board.shapes()[i].figure));
    by_layer_[static_cast<std::size_t>(board.shapes()[i].copper_layer)].push_back(static_cast<std::int32_t>(i));
  }
}

const std::vector<Ring>& CopperFinder::rings_of(std::int32_t shape) const {
  const auto [found, is_new] = rings_.try_emplace(shape);
  if (is_new) {
    bool simple = true;
    found->second = geometry::outline(board_.shapes()[static_cast<std::size_t>(shape)].figure, study_.arcs, simple);
  }
  return found->second;
}

bool CopperFinder::shape_covers(std::int32_t shape, Point p) const {
  if (!boxes_[static_cast<std::size_t>(shape)].contains(p)) return false;
  return std::ranges::any_of(rings_of(shape), [&](const Ring& ring) { return geometry::location(p, ring) >= 0; });
}

std::vector<std::int32_t> CopperFinder::nets_at(std::int32_t layer, Point p) const {
  std::vector<std::int32_t> nets;
  for (const std::int32_t i : on_layer(layer))
    if (shape_covers(i, p)) nets.push_back(board_.shapes()[static_cast<std::size_t>(i)].net);
  std::sort(nets.begin(), nets.end());
  nets.erase(std::unique(nets.begin(), nets.end()), nets.end());
  return nets;
}

bool CopperFinder::covers(std::int32_t layer, std::int32_t net, Point p) const {
  return std::ranges::any_of(on_layer(layer), [&](std::int32_t i) {
    return board_.shapes()[static_cast<std::size_t>(i)].net == net && shape_covers(i, p);
  });
}

bool CopperFinder::has_plane(std::int32_t layer, std::int32_t net, Point p, double least_width_nm) const {
  return std::ranges::any_of(on_layer(layer), [&](std::int32_t i) {
    const board::Shape& shape = board_.shapes()[static_cast<std::size_t>(i)];
    const bool is_pad = shape.kind == board::ShapeKind::pad || shape.kind == board::ShapeKind::via;
    if (is_pad || shape.net != net || !shape_covers(i, p)) return false;
    const geometry::Box& box = boxes_[static_cast<std::size_t>(i)];
    const double width = shape.figure.filled ? static_cast<double>(std::min(box.max.x - box.min.x, box.max.y - box.min.y))
                                             : static_cast<double>(shape.figure.pen);
    return width >= least_width_nm;
  });
}

void CopperFinder::chord(std::int32_t shape, Point p, std::array<double, 2> direction, double& before, double& behind) const {
  before = -infinity;
  behind = infinity;
  const auto [dx, dy] = direction;
  for (const Ring& ring : rings_of(shape)) {
    for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
      const double ax = static_cast<double>(ring[j].x - p.x), ay = static_cast<double>(ring[j].y - p.y);
      const double bx = static_cast<double>(ring[i].x - p.x), by = static_cast<double>(ring[i].y - p.y);
      const double a_side = dx * ay - dy * ax, b_side = dx * by - dy * bx;
      if ((a_side < 0) == (b_side < 0)) continue;
      const double share = a_side / (a_side - b_side);
      const double t = dx * (ax + share * (bx - ax)) + dy * (ay + share * (by - ay));
      if (t <= 0) before = std::max(before, t);
      if (t >= 0) behind = std::min(behind, t);
    }
  }
}

std::optional<Section> CopperFinder::section_at(std::int32_t layer, std::int32_t net, Point p) const {
  std::optional<Section> best;
  double nearest = infinity;
  for (const std::int32_t i : on_layer(layer)) {
    const board::Shape& shape = board_.shapes()[static_cast<std::size_t>(i)];
    if (shape.net != net || !boxes_[static_cast<std::size_t>(i)].contains(p)) continue;
    const Ring line = centre_line(shape, study_.arcs);
    for (std::size_t k = 1; k < line.size(); ++k) {
      const Foot foot = foot_on(p, line[k - 1], line[k]);
      if (line[k] == line[k - 1] || foot.distance * 2 > static_cast<double>(shape.figure.pen) || foot.distance >= nearest)
        continue;
      nearest = foot.distance;
      best = across(line[k - 1], line[k], foot.along, static_cast<double>(shape.figure.pen));
    }
  }
  return best ? best : pad_section(layer, net, p);
}

std::optional<Section> CopperFinder::pad_section(std::int32_t layer, std::int32_t net, Point p,
                                                 const std::optional<std::array<double, 2>>& along) const {
  constexpr double share_of_extent = 0.9;  // round pads have corners inside their outline only
  constexpr std::array<double, 2> along_x{1, 0}, along_y{0, 1};
  std::optional<Section> best;
  for (const std::int32_t i : on_layer(layer)) {
    if (board_.shapes()[static_cast<std::size_t>(i)].net != net || !shape_covers(i, p)) continue;
    for (const std::array<double, 2>& direction : {along.value_or(along_x), along.value_or(along_y)}) {
      double before = 0, behind = 0;
      chord(i, p, direction, before, behind);
      const double width = share_of_extent * (behind - before);
      if (!std::isfinite(width) || width <= 0 || (best && width >= best->width_nm)) continue;
      const double middle = 0.5 * (before + behind);
      best = Section{{static_cast<double>(p.x) + middle * direction[0], static_cast<double>(p.y) + middle * direction[1]},
                     direction,
                     width};
    }
  }
  return best;
}

std::vector<std::pair<double, double>> CopperFinder::cuts(std::int32_t layer, std::int32_t net, int axis, Nm at) const {
  std::vector<double> marks;
  std::vector<std::int32_t> shapes;
  for (const std::int32_t i : on_layer(layer)) {
    const geometry::Box& box = boxes_[static_cast<std::size_t>(i)];
    if (board_.shapes()[static_cast<std::size_t>(i)].net != net) continue;
    if (at < (axis == 0 ? box.min.x : box.min.y) || at > (axis == 0 ? box.max.x : box.max.y)) continue;
    shapes.push_back(i);
    for (const Ring& ring : rings_of(i)) {
      for (std::size_t k = 0, j = ring.size() - 1; k < ring.size(); j = k++) {
        const Point a = axis == 0 ? ring[j] : Point{ring[j].y, ring[j].x},
                    b = axis == 0 ? ring[k] : Point{ring[k].y, ring[k].x};
        if ((a.x < at) == (b.x < at)) continue;
        const double share = static_cast<double>(at - a.x) / static_cast<double>(b.x - a.x);
        marks.push_back(static_cast<double>(a.y) + share * static_cast<double>(b.y - a.y));
      }
    }
  }
  std::sort(marks.begin(), marks.end());
  std::vector<std::pair<double, double>> intervals;
  for (std::size_t k = 1; k < marks.size(); ++k) {
    if (marks[k] - marks[k - 1] < 2) continue;
    const Nm middle = std::llround(0.5 * (marks[k] + marks[k - 1]));
    const Point p = axis == 0 ? Point{at, middle} : Point{middle, at};
    if (std::ranges::none_of(shapes, [&](std::int32_t i) { return shape_covers(i, p); })) continue;
    if (!intervals.empty() && intervals.back().second >= marks[k - 1] - 2)
      intervals.back().second = marks[k];
    else
      intervals.emplace_back(marks[k - 1], marks[k]);
  }
  return intervals;
}

std::vector<Section> CopperFinder::sections_away_from(std::int32_t layer, std::int32_t net, Point p, double reach_nm) const {
  // Pieces of track, each turned so that it begins at its end nearer to the pad; pieces further on have begun where one ends.
  struct Piece {
    Point from, to;
    double width, start;
  };
  std::vector<Piece> open;
  for (const std::int32_t i : on_layer(layer)) {
    const board::Shape& shape = board_.shapes()[static_cast<std::size_t>(i)];
    if (shape.net != net) continue;
    const Ring line = centre_line(shape, study_.arcs);
    for (std::size_t k = 1; k < line.size(); ++k)
      if (line[k] != line[k - 1]) open.push_back({line[k - 1], line[k], static_cast<double>(shape.figure.pen), 0});
  }
  std::vector<std::pair<double, Section>> found;
  std::vector<std::pair<Point, double>> starts{{p, 0}};  // where tracks may begin, and how far that is from the pad
  const auto apart = [](Point a, Point b) {
    return std::hypot(static_cast<double>(a.x - b.x), static_cast<double>(a.y - b.y));
  };
  for (std::size_t s = 0; s < starts.size(); ++s) {
    const auto [start, far] = starts[s];
    for (std::size_t k = 0; k < open.size();) {
      Piece piece = open[k];
      // A track may end anywhere in a pad; further on, ends of tracks meet.
      const double slack = s == 0 ? 0.5 * nm_per_mm : 0.5 * piece.width;
      if (apart(piece.to, start) < apart(piece.from, start)) std::swap(piece.from, piece.to);
      if (apart(piece.from, start) > slack) {
        ++k;
        continue;
      }
      open.erase(open.begin() + static_cast<std::ptrdiff_t>(k));
      const double length = apart(piece.from, piece.to), begin = far + (s == 0 ? apart(piece.from, start) : 0);
      const double step = std::max(0.25 * piece.width, 20.0 * nm_per_um);
      for (double along = 0.5 * step; along < length && begin + along < reach_nm; along += step)
        found.emplace_back(begin + along, across(piece.from, piece.to, along, piece.width));
      if (begin + length < reach_nm) starts.emplace_back(piece.to, begin + length);
    }
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Section> sections;
  for (auto& [far, section] : found) sections.push_back(section);
  return sections;
}

std::optional<CopperFinder::Gap> CopperFinder::gap_from(std::int32_t layer, std::int32_t net, Point p,
                                                        std::array<double, 2> direction, double reach_nm) const {
  // All outlines on the way, in order; between two of them one probe tells what is there.
  std::vector<double> marks{0, reach_nm};
  const Point end{p.x + std::llround(direction[0] * reach_nm), p.y + std::llround(direction[1] * reach_nm)};
  geometry::Box way;
  way.add(p);
  way.add(end);
  const auto [dx, dy] = direction;
  for (const std::int32_t i : on_layer(layer)) {
    if (!boxes_[static_cast<std::size_t>(i)].touches(way)) continue;
    for (const Ring& ring : rings_of(i)) {
      for (std::size_t k = 0, j = ring.size() - 1; k < ring.size(); j = k++) {
        const double ax = static_cast<double>(ring[j].x - p.x), ay = static_cast<double>(ring[j].y - p.y);
        const double bx = static_cast<double>(ring[k].x - p.x), by = static_cast<double>(ring[k].y - p.y);
        const double a_side = dx * ay - dy * ax, b_side = dx * by - dy * bx;
        if ((a_side < 0) == (b_side < 0)) continue;
        const double share = a_side / (a_side - b_side);
        const double t = dx * (ax + share * (bx - ax)) + dy * (ay + share * (by - ay));
        if (t > 0 && t < reach_nm) marks.push_back(t);
      }
    }
  }
  std::sort(marks.begin(), marks.end());
  Gap gap;
  bool left = false;
  for (std::size_t k = 1; k < marks.size(); ++k) {
    if (marks[k] - marks[k - 1] < 2) continue;
    const double t = 0.5 * (marks[k] + marks[k - 1]);
    const std::vector<std::int32_t> nets = nets_at(layer, {p.x + std::llround(dx * t), p.y + std::llround(dy * t)});
    if (std::ranges::find(nets, net) != nets.end()) {
      if (left) return std::nullopt;  // the same net again
      continue;
    }
    if (!left) gap.leave_nm = marks[k - 1];
    left = true;
    if (nets.empty()) continue;
    gap.meet_nm = marks[k - 1];
    gap.net = nets.front();
    return gap;
  }
  return std::nullopt;
}

const board::Drill* CopperFinder::drill_in(const Section& section) const {
  const Point a = section.at(-0.5), b = section.at(0.5);
  geometry::Box way;
  way.add(a);
  way.add(b);
  for (const board::Drill& drill : board_.drills()) {
    if (!geometry::bounds(drill.figure).touches(way)) continue;
    bool simple = true;
    for (const Ring& ring : geometry::outline(drill.figure, study_.arcs, simple))
      for (int k = -8; k <= 8; ++k)
        if (geometry::location(section.at(k / 16.0), ring) >= 0) return &drill;
  }
  return nullptr;
}

}  // namespace pcbmesh::compose
