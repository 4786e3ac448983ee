// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/overlay/noding.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "pcbmesh/base/error.hpp"

namespace pcbmesh::overlay {
namespace {

constexpr int most_passes = 120;

bool share_end(const Edge& a, const Edge& b) {
  return a.u == b.u || a.u == b.v || a.v == b.u || a.v == b.v;
}

}  // namespace

Noder::Noder(EdgeGraph graph, LabelPool& labels, Nm tolerance, const Progress& progress, std::int32_t first_guide)
    : points_(std::move(graph.points)),
      edges_(std::move(graph.edges)),
      fresh_(edges_.size(), 1),
      moved_(points_.size(), tolerance > 0 ? 1 : 0),  // distinct points are an exact cluster each
      labels_(labels),
      first_guide_(first_guide),
      tolerance_(tolerance),
      tolerance2_(static_cast<double>(tolerance) * static_cast<double>(tolerance)),
      progress_(progress),
      box_(box_of(points_, edges_)) {}

int Noder::stiffness(const Edge& e) const {
  const auto entries = labels_.entries(e.label);
  if (tolerance_ == 0 || entries.empty()) return 0;
  if (entries.front().body == 0) return 3;
  if (entries.back().body >= first_guide_) return 2;
  return entries.front().body == 1 ? 1 : 0;
}

std::int32_t Noder::add_point(Point p) {
  points_.push_back(p);
  moved_.push_back(1);
  return static_cast<std::int32_t>(points_.size()) - 1;
}

void Noder::replace(const std::vector<std::uint8_t>& removed, std::vector<Edge>& added) {
  normalise(added, labels_);
  std::vector<Edge> merged;
  std::vector<std::uint8_t> fresh;
  merged.reserve(edges_.size() + added.size());
  fresh.reserve(merged.capacity());
  const auto before = [](const Edge& a, const Edge& b) { return a.u != b.u ? a.u < b.u : a.v < b.v; };
  std::size_t i = 0, j = 0;
  while (true) {
    while (i < edges_.size() && removed[i]) ++i;
    if (i == edges_.size() && j == added.size()) break;
    if (j == added.size() || (i < edges_.size() && before(edges_[i], added[j]))) {
      merged.push_back(edges_[i]);
      fresh.push_back(fresh_[i++]);
    } else if (i == edges_.size() || before(added[j], edges_[i])) {
      merged.push_back(added[j++]);
      fresh.push_back(1);
    } else {
      // The edge stands already: only its label changes, so nothing need be tested again.
      Edge sum = edges_[i];
      sum.label = labels_.add(sum.label, added[j++].label);
      if (sum.label != 0) merged.push_back(sum), fresh.push_back(fresh_[i]);
      ++i;
    }
  }
  edges_ = std::move(merged);
  fresh_ = std::move(fresh);
}

EdgeGraph Noder::take() {
  EdgeGraph graph{std::move(points_), std::move(edges_)};
  compact(graph, labels_);
  return graph;
}

void Noder::settle() {
  for (int i = 0; i < most_passes; ++i) {
    progress_.check();
    if (!pass()) return;
  }
  Spot spot;
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    if (!fresh_[e]) continue;
    const Point p = points_[ix(edges_[e].u)];
    spot.at_mm = {static_cast<double>(p.x) * 1e-6, static_cast<double>(p.y) * 1e-6};
    break;
  }
  throw Error(ErrorCode::overlay_no_fixpoint,
              "the outlines keep changing while they are snapped together; try another tolerance", spot);
}

bool Noder::pass() {
  ++counts_.num_passes;
  used_.assign(points_.size(), 0);
  for (const Edge& e : edges_) used_[ix(e.u)] = used_[ix(e.v)] = 1;
  if (tolerance_ > 0) rank_vertices();
  const bool merged = cluster();
  if (merged && tolerance_ > 0) rank_vertices();
  return split() || merged;
}

void Noder::rank_vertices() {
  struct End {
    std::int32_t vertex;
    int stiffness;
    std::int32_t other;
  };
  std::vector<End> ends;
  for (const Edge& e : edges_) {
    if (const int s = stiffness(e); s > 0) {
      ends.push_back({e.u, s, e.v});
      ends.push_back({e.v, s, e.u});
    }
  }
  std::sort(ends.begin(), ends.end(), [](const End& a, const End& b) {
    return a.vertex != b.vertex         ? a.vertex < b.vertex
           : a.stiffness != b.stiffness ? a.stiffness > b.stiffness
                                        : a.other < b.other;
  });
  rank_.assign(points_.size(), 0);
  for (std::size_t i = 0; i < ends.size();) {
    std::size_t j = i;
    while (j < ends.size() && ends[j].vertex == ends[i].vertex && ends[j].stiffness == ends[i].stiffness) ++j;
    bool corner = j - i != 2;
    if (!corner) {
      // Grid rounding bends a straight edge by a nanometre; a bend that small is no corner.
      const Point a = points_[ix(ends[i].other)], v = points_[ix(ends[i].vertex)], b = points_[ix(ends[i + 1].other)];
      corner = dot(between(a, v), between(v, b)) <= 0 || foot_of(v, a, b).line_distance2 > 4;
    }
    rank_[ix(ends[i].vertex)] = static_cast<std::uint8_t>(2 * ends[i].stiffness - (corner ? 0 : 1));
    const std::int32_t vertex = ends[i].vertex;
    for (i = j; i < ends.size() && ends[i].vertex == vertex;) ++i;
  }
}

std::vector<std::int32_t> Noder::clustered(std::vector<std::int32_t>& members, const CellGrid& grid) {
  std::vector<double> longest2(points_.size(), 0);
  for (const Edge& e : edges_) {
    const double length2 = distance2(points_[ix(e.u)], points_[ix(e.v)]);
    longest2[ix(e.u)] = std::max(longest2[ix(e.u)], length2);
    longest2[ix(e.v)] = std::max(longest2[ix(e.v)], length2);
  }
  // Long edges keep their direction when their ends stay put, so these come first; outlines of the domain before all.
  std::sort(members.begin(), members.end(), [&](std::int32_t a, std::int32_t b) {
    if (!rank_.empty() && rank_[ix(a)] != rank_[ix(b)]) return rank_[ix(a)] > rank_[ix(b)];
    if (longest2[ix(a)] != longest2[ix(b)]) return longest2[ix(a)] > longest2[ix(b)];
    return points_[ix(a)] != points_[ix(b)] ? points_[ix(a)] < points_[ix(b)] : a < b;
  });
  CellLists cells;
  cells.start(grid.num_cells());
  for (const std::int32_t v : members) cells.put(grid.cell_of(points_[ix(v)]), v);
  cells.finish();
  std::vector<std::int32_t> target(points_.size());
  std::iota(target.begin(), target.end(), 0);
  std::vector<std::uint8_t> stands(points_.size(), 0);
  const double reach = static_cast<double>(tolerance_);
  for (const std::int32_t v : members) {
    const Point p = points_[ix(v)];
    const double x = static_cast<double>(p.x), y = static_cast<double>(p.y);
    double best = tolerance2_;
    std::int32_t into = -1;
    grid.over_box(x - reach, y - reach, x + reach, y + reach, [&](std::int32_t first, std::int32_t last) {
      for (const std::int32_t other : cells.items(first, last)) {
        if (!stands[ix(other)]) continue;
        const double d2 = distance2(p, points_[ix(other)]);
        if (d2 < best || (d2 == best && (into < 0 || points_[ix(other)] < points_[ix(into)]))) best = d2, into = other;
      }
    });
    if (into < 0) {
      stands[ix(v)] = 1;
    } else {
      target[ix(v)] = into;
    }
  }
  return target;
}

bool Noder::cluster() {
  std::vector<std::int32_t> members;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (used_[i] && moved_[i]) members.push_back(static_cast<std::int32_t>(i));
  }
  if (members.empty()) return false;
  const std::size_t num_used = static_cast<std::size_t>(std::count(used_.begin(), used_.end(), 1));
  const CellGrid grid(box_, num_used, std::max<Nm>(tolerance_, 1));
  if (members.size() < num_used) {
    // Two vertices that both stood before are apart already; only neighbours of a moved one matter.
    CellLists cells;
    cells.start(grid.num_cells());
    for (const std::int32_t v : members) cells.put(grid.cell_of(points_[ix(v)]), v);
    cells.finish();
    const double reach = static_cast<double>(tolerance_);
    const std::size_t num_moved = members.size();
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (!used_[i] || moved_[i]) continue;
      const Point p = points_[i];
      const double x = static_cast<double>(p.x), y = static_cast<double>(p.y);
      bool near = false;
      grid.over_box(x - reach, y - reach, x + reach, y + reach, [&](std::int32_t first, std::int32_t last) {
        for (const std::int32_t other : cells.items(first, last))
          near = near || distance2(p, points_[ix(other)]) <= tolerance2_;
      });
      if (near) members.push_back(static_cast<std::int32_t>(i));
    }
    if (members.size() == num_moved && num_moved < 2) return false;
  }
  const std::vector<std::int32_t> target = clustered(members, grid);
  std::vector<std::uint8_t> removed(edges_.size(), 0);
  std::vector<Edge> added;
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    const Edge& edge = edges_[e];
    if (target[ix(edge.u)] == edge.u && target[ix(edge.v)] == edge.v) continue;
    removed[e] = 1;
    if (target[ix(edge.u)] != target[ix(edge.v)]) added.push_back({target[ix(edge.u)], target[ix(edge.v)], edge.label});
  }
  std::int64_t merged = 0;
  for (const std::int32_t v : members) merged += target[ix(v)] != v;
  if (merged == 0) return false;
  counts_.num_snapped += merged;
  replace(removed, added);
  used_.assign(points_.size(), 0);
  for (const Edge& e : edges_) used_[ix(e.u)] = used_[ix(e.v)] = 1;
  return true;
}

bool Noder::splits(std::int32_t vertex, const Edge& e, Foot& foot) const {
  if (vertex == e.u || vertex == e.v) return false;
  const Point p = points_[ix(vertex)], a = points_[ix(e.u)], b = points_[ix(e.v)];
  const Vector ab = between(a, b), ap = between(a, p);
  const double along = dot(ab, ap), length2 = dot(ab, ab);
  if (along <= 0 || along >= length2) return false;
  if (tolerance_ == 0) {
    if (turn(a, b, p) != 0) return false;
    foot = {along / length2, 0};
    return true;
  }
  const double side = cross(ab, ap);
  if (side * side > tolerance2_ * length2) return false;
  // Only the longest side of the triangle gives way; otherwise three near vertices split each other for ever.
  if (dot(ap, ap) >= length2 || distance2(p, b) >= length2) return false;
  foot = {along / length2, side * side / length2};
  return true;
}

void Noder::collect_near(std::vector<Split>& found, std::vector<Pair>& crossing) {
  std::size_t num_used = 0;
  for (const std::uint8_t u : used_) num_used += u;
  const CellGrid grid(box_, num_used, std::max<Nm>(tolerance_, 1));
  const double pad = static_cast<double>(tolerance_);
  CellLists vertices, segments;
  vertices.start(grid.num_cells());
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (used_[i]) vertices.put(grid.cell_of(points_[i]), static_cast<std::int32_t>(i));
  }
  vertices.finish();
  segments.start(grid.num_cells());
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    grid.along_segment(points_[ix(edges_[e].u)], points_[ix(edges_[e].v)], 0, [&](std::int32_t first, std::int32_t last) {
      for (std::int32_t cell = first; cell <= last; ++cell) segments.put(cell, static_cast<std::int32_t>(e));
    });
  }
  segments.finish();
  Foot foot;
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    if (!fresh_[e]) continue;
    if (e % 4096 == 0) progress_.check();
    const Edge edge = edges_[e];
    const auto id = static_cast<std::int32_t>(e);
    const Point a = points_[ix(edge.u)], b = points_[ix(edge.v)];
    const Nm x_low = std::min(a.x, b.x), x_high = std::max(a.x, b.x), y_low = std::min(a.y, b.y), y_high = std::max(a.y, b.y);
    const Nm reach = tolerance_;
    grid.along_segment(a, b, pad, [&](std::int32_t first, std::int32_t last) {
      for (const std::int32_t v : vertices.items(first, last)) {
        const Point p = points_[ix(v)];
        if (p.x < x_low - reach || p.x > x_high + reach || p.y < y_low - reach || p.y > y_high + reach) continue;
        if (splits(v, edge, foot)) found.push_back({id, v, foot.share, foot.line_distance2});
      }
    });
    grid.along_segment(a, b, 0, [&](std::int32_t first, std::int32_t last) {
      for (const std::int32_t f : segments.items(first, last)) {
        if (fresh_[ix(f)] && f <= id) continue;
        const Edge& other = edges_[ix(f)];
        const Point c = points_[ix(other.u)], d = points_[ix(other.v)];
        if (std::max(c.x, d.x) < x_low || std::min(c.x, d.x) > x_high || std::max(c.y, d.y) < y_low ||
            std::min(c.y, d.y) > y_high)
          continue;
        if (!share_end(edge, other) && crosses_properly(a, b, c, d)) crossing.push_back({std::min(id, f), std::max(id, f)});
      }
    });
  }
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (!used_[i] || !moved_[i]) continue;
    const auto v = static_cast<std::int32_t>(i);
    const double x = static_cast<double>(points_[i].x), y = static_cast<double>(points_[i].y);
    grid.over_box(x - pad - 1, y - pad - 1, x + pad + 1, y + pad + 1, [&](std::int32_t first, std::int32_t last) {
      for (const std::int32_t e : segments.items(first, last)) {
        if (!fresh_[ix(e)] && splits(v, edges_[ix(e)], foot)) found.push_back({e, v, foot.share, foot.line_distance2});
      }
    });
  }
}

void Noder::resolve_crossings(std::vector<Pair>& crossing, std::vector<Split>& found) {
  std::sort(crossing.begin(), crossing.end());
  crossing.erase(std::unique(crossing.begin(), crossing.end()), crossing.end());
  Foot foot;
  for (const Pair& pair : crossing) {
    const Edge e = edges_[ix(pair.first)], f = edges_[ix(pair.second)];
    if (splits(f.u, e, foot) || splits(f.v, e, foot) || splits(e.u, f, foot) || splits(e.v, f, foot)) continue;
    const Point a = points_[ix(e.u)], b = points_[ix(e.v)], c = points_[ix(f.u)], d = points_[ix(f.v)];
    const Point x = crossing_point(a, b, c, d);
    // An end that near is the crossing: no new vertex is needed.
    // On the bare grid two nearly parallel edges would creep along each other, a nanometre a pass: rounding the crossing bends
    // them, and they cross again. So there an end within two nanometres, more the longer it takes, counts as the crossing.
    const std::int32_t ends[4] = {e.u, e.v, f.u, f.v};
    const double creep = 2.0 + counts_.num_passes / 16;
    double best = tolerance_ > 0 ? tolerance2_ : creep * creep;
    int nearest = -1;
    for (int k = 0; k < 4; ++k) {
      const double d2 = distance2(x, points_[ix(ends[k])]);
      if (d2 < best || (d2 == best && nearest < 0)) best = d2, nearest = k;
    }
    if (nearest >= 0) {
      const bool cut_second = nearest < 2;
      const Point p = points_[ix(ends[nearest])];
      const Foot at = cut_second ? foot_of(p, c, d) : foot_of(p, a, b);
      found.push_back(
          {cut_second ? pair.second : pair.first, ends[nearest], std::clamp(at.share, 0.0, 1.0), at.line_distance2});
      continue;
    }
    ++counts_.num_crossings;
    const std::int32_t v = add_point(x);
    used_.push_back(1);
    if (!rank_.empty()) rank_.push_back(static_cast<std::uint8_t>(std::max({0, 2 * stiffness(e) - 1, 2 * stiffness(f) - 1})));
    found.push_back({pair.first, v, foot_of(x, a, b).share, 0});
    found.push_back({pair.second, v, foot_of(x, c, d).share, 0});
  }
}

void Noder::collect_moves(const std::vector<Split>& found) {
  moves_.clear();
  if (tolerance_ == 0) return;
  for (const Split& s : found) {
    const Edge& e = edges_[ix(s.edge)];
    const int stiff = stiffness(e);
    if (stiff == 0 || rank_[ix(s.vertex)] >= 2 * stiff - 1) continue;
    const Point a = points_[ix(e.u)], b = points_[ix(e.v)];
    const Vector ab = between(a, b);
    const Point to{a.x + std::llround(s.share * ab.x), a.y + std::llround(s.share * ab.y)};
    if (to != points_[ix(s.vertex)]) moves_.push_back({s.vertex, stiff, s.line_distance2, to});
  }
  std::sort(moves_.begin(), moves_.end(), [](const Move& a, const Move& b) {
    if (a.vertex != b.vertex) return a.vertex < b.vertex;
    if (a.stiffness != b.stiffness) return a.stiffness > b.stiffness;
    return a.line_distance2 != b.line_distance2 ? a.line_distance2 < b.line_distance2 : a.to < b.to;
  });
  moves_.erase(std::unique(moves_.begin(), moves_.end(), [](const Move& a, const Move& b) { return a.vertex == b.vertex; }),
               moves_.end());
}

bool Noder::apply_splits(std::vector<Split>& found) {
  std::sort(found.begin(), found.end(), [](const Split& a, const Split& b) {
    if (a.edge != b.edge) return a.edge < b.edge;
    if (a.line_distance2 != b.line_distance2) return a.line_distance2 < b.line_distance2;
    return a.share != b.share ? a.share < b.share : a.vertex < b.vertex;
  });
  std::vector<std::uint8_t> removed(edges_.size(), 0);
  std::vector<Edge> added;
  std::vector<Split> taken;
  for (std::size_t i = 0; i < found.size();) {
    const Edge edge = edges_[ix(found[i].edge)];
    const double length = distance(points_[ix(edge.u)], points_[ix(edge.v)]);
    taken.clear();
    std::size_t j = i;
    for (; j < found.size() && found[j].edge == found[i].edge; ++j) {
      bool apart = true;
      for (const Split& t : taken) {
        apart = apart && t.vertex != found[j].vertex &&
                (tolerance_ == 0 || std::abs(t.share - found[j].share) * length >= static_cast<double>(tolerance_));
      }
      if (apart) taken.push_back(found[j]);
    }
    std::sort(taken.begin(), taken.end(),
              [](const Split& a, const Split& b) { return a.share != b.share ? a.share < b.share : a.vertex < b.vertex; });
    removed[ix(found[i].edge)] = 1;
    std::int32_t from = edge.u;
    for (const Split& t : taken) {
      added.push_back({from, t.vertex, edge.label});
      from = t.vertex;
    }
    added.push_back({from, edge.v, edge.label});
    i = j;
  }
  if (!moves_.empty()) {
    std::vector<std::uint8_t> shifted(points_.size(), 0);
    for (const Move& m : moves_) {
      points_[ix(m.vertex)] = m.to;
      shifted[ix(m.vertex)] = moved_[ix(m.vertex)] = 1;
    }
    counts_.num_snapped += static_cast<std::int64_t>(moves_.size());
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      if (removed[e] || !(shifted[ix(edges_[e].u)] || shifted[ix(edges_[e].v)])) continue;
      removed[e] = 1;
      added.push_back(edges_[e]);
    }
  }
  const bool changed = !added.empty();
  if (changed) replace(removed, added);
  return changed;
}

bool Noder::split() {
  std::vector<Split> found;
  std::vector<Pair> crossing;
  collect_near(found, crossing);
  // Everything new has been looked at now; what the splits add is new again.
  std::fill(fresh_.begin(), fresh_.end(), std::uint8_t{0});
  std::fill(moved_.begin(), moved_.end(), std::uint8_t{0});
  resolve_crossings(crossing, found);
  collect_moves(found);
  return apply_splits(found);
}

}  // namespace pcbmesh::overlay
