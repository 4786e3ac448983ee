// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/overlay/flood.hpp"

#include <algorithm>

#include "pcbmesh/base/error.hpp"
#include "src/overlay/cell_grid.hpp"
#include "src/overlay/union_find.hpp"

namespace pcbmesh::overlay {
namespace {

/// Half-edge 2e runs u -> v of edge e, 2e+1 runs back. Loops have their face on the left.
struct HalfEdges {
  std::vector<std::int32_t> offsets;   ///< per vertex
  std::vector<std::int32_t> outgoing;  ///< counter-clockwise from straight down, exclusive
  std::vector<std::int32_t> next;      ///< per half-edge
};

std::int32_t origin(const EdgeGraph& graph, std::int32_t half) {
  const Edge& e = graph.edges[ix(half / 2)];
  return half % 2 == 0 ? e.u : e.v;
}

/// True for directions in (-90, +90] degrees.
bool in_right_half(Point from, Point to) {
  return to.x > from.x || (to.x == from.x && to.y > from.y);
}

HalfEdges connect(const EdgeGraph& graph) {
  HalfEdges halves;
  const std::size_t num_halves = graph.edges.size() * 2;
  halves.offsets.assign(graph.points.size() + 1, 0);
  for (const Edge& e : graph.edges) ++halves.offsets[ix(e.u) + 1], ++halves.offsets[ix(e.v) + 1];
  for (std::size_t i = 1; i < halves.offsets.size(); ++i) halves.offsets[i] += halves.offsets[i - 1];
  halves.outgoing.resize(num_halves);
  std::vector<std::int32_t> fill(halves.offsets.begin(), halves.offsets.end() - 1);
  for (std::int32_t h = 0; ix(h) < num_halves; ++h) halves.outgoing[ix(fill[ix(origin(graph, h))]++)] = h;
  halves.next.resize(num_halves);
  for (std::size_t v = 0; v < graph.points.size(); ++v) {
    const auto first = halves.outgoing.begin() + halves.offsets[v], last = halves.outgoing.begin() + halves.offsets[v + 1];
    const Point centre = graph.points[v];
    std::sort(first, last, [&](std::int32_t g, std::int32_t h) {
      const Point p = graph.points[ix(origin(graph, g ^ 1))], q = graph.points[ix(origin(graph, h ^ 1))];
      const bool p_right = in_right_half(centre, p), q_right = in_right_half(centre, q);
      if (p_right != q_right) return p_right;
      return turn(centre, p, q) > 0;
    });
    // Arriving at v against outgoing half g, the face on the left goes on along the outgoing half clockwise before g.
    for (auto it = first; it != last; ++it) halves.next[ix(*it ^ 1)] = it == first ? *(last - 1) : *(it - 1);
  }
  return halves;
}

/// Finds the edge straight below a point, for points that are the leftmost, lowest of their component.
class EdgeBelow {
 public:
  explicit EdgeBelow(const EdgeGraph& graph) : graph_(graph), grid_(box_of(graph.points, graph.edges), graph.edges.size(), 1) {
    lists_.start(grid_.num_cells());
    for (std::size_t e = 0; e < graph.edges.size(); ++e) {
      grid_.along_segment(graph.points[ix(graph.edges[e].u)], graph.points[ix(graph.edges[e].v)], 0,
                          [&](std::int32_t first, std::int32_t last) {
                            for (std::int32_t cell = first; cell <= last; ++cell)
                              lists_.put(cell, static_cast<std::int32_t>(e));
                          });
    }
    lists_.finish();
  }

  /// Edge id or -1.
  [[nodiscard]] std::int32_t find(Point p) const {
    const double x = static_cast<double>(p.x);
    const std::int32_t column = grid_.column_of(x);
    std::int32_t best = -1;
    for (std::int32_t row = grid_.row_of(static_cast<double>(p.y)); row >= 0; --row) {
      const std::int32_t cell = row * grid_.columns() + column;
      for (const std::int32_t e : lists_.items(cell, cell)) {
        Point a, b;
        ends(e, a, b);
        // Half open: the ray stands an infinitesimal to the right of p, so it meets no vertex.
        if (a.x > p.x || b.x <= p.x || turn(a, b, p) <= 0) continue;
        if (best < 0 || (best != e && is_above(e, best))) best = e;
      }
      if (best >= 0) {
        Point a, b;
        ends(best, a, b);
        const double y = static_cast<double>(a.y) +
                         (x - static_cast<double>(a.x)) * static_cast<double>(b.y - a.y) / static_cast<double>(b.x - a.x);
        if (y > grid_.row_bottom(row) + 1) break;
      }
    }
    return best;
  }

  /// Ends from left to right.
  void ends(std::int32_t e, Point& a, Point& b) const {
    a = graph_.points[ix(graph_.edges[ix(e)].u)];
    b = graph_.points[ix(graph_.edges[ix(e)].v)];
    if (b < a) std::swap(a, b);
  }

 private:
  /// Both span a common x and do not cross.
  [[nodiscard]] bool is_above(std::int32_t e, std::int32_t f) const {
    Point a, b, c, d;
    ends(e, a, b);
    ends(f, c, d);
    if (a.x < c.x || (a.x == c.x && a.y < c.y)) {
      int side = turn(a, b, c);
      if (side == 0) side = turn(a, b, d);
      return side < 0;
    }
    int side = turn(c, d, a);
    if (side == 0) side = turn(c, d, b);
    return side > 0;
  }
  const EdgeGraph& graph_;
  CellGrid grid_;
  CellLists lists_;
};

struct Island {
  std::int32_t corner;  ///< leftmost, lowest vertex
  std::int32_t outer;   ///< a half-edge whose left is the surrounding face
};

std::vector<Island> islands_of(const EdgeGraph& graph, const HalfEdges& halves) {
  UnionFind joined(graph.points.size());
  for (const Edge& e : graph.edges) joined.unite(e.u, e.v);
  std::vector<std::int32_t> corner(graph.points.size(), -1);
  for (std::size_t v = 0; v < graph.points.size(); ++v) {
    if (halves.offsets[v] == halves.offsets[v + 1]) continue;
    std::int32_t& best = corner[ix(joined.find(static_cast<std::int32_t>(v)))];
    if (best < 0 || graph.points[v] < graph.points[ix(best)]) best = static_cast<std::int32_t>(v);
  }
  std::vector<Island> islands;
  for (const std::int32_t v : corner) {
    // All directions at the corner lie in (-90, 90]: left of the last one is the outside.
    if (v >= 0) islands.push_back({v, halves.outgoing[ix(halves.offsets[ix(v) + 1]) - 1]});
  }
  std::sort(islands.begin(), islands.end(),
            [&](const Island& a, const Island& b) { return graph.points[ix(a.corner)] < graph.points[ix(b.corner)]; });
  return islands;
}

}  // namespace

Faces flood(const EdgeGraph& graph, LabelPool& labels, const Progress& progress) {
  Faces faces;
  faces.left.assign(graph.edges.size(), -1);
  faces.right.assign(graph.edges.size(), -1);
  faces.state.push_back(0);
  if (graph.edges.empty()) return faces;
  const HalfEdges halves = connect(graph);
  const EdgeBelow below(graph);
  const auto face_of = [&](std::int32_t half) -> std::int32_t& {
    return half % 2 == 0 ? faces.left[ix(half / 2)] : faces.right[ix(half / 2)];
  };
  const auto paint = [&](std::int32_t half, std::int32_t face) {
    for (std::int32_t h = half; face_of(h) < 0; h = halves.next[ix(h)]) face_of(h) = face;
  };
  std::vector<std::int32_t> open;
  for (const Island& island : islands_of(graph, halves)) {
    progress.check();
    // Whatever lies below belongs to an island further left, which is done.
    const std::int32_t under = below.find(graph.points[ix(island.corner)]);
    std::int32_t around = 0;
    if (under >= 0) {
      const Edge& e = graph.edges[ix(under)];
      around = graph.points[ix(e.u)] < graph.points[ix(e.v)] ? faces.left[ix(under)] : faces.right[ix(under)];
      PCBMESH_ASSERT(around >= 0);
    }
    paint(island.outer, around);
    open.assign(1, island.outer);
    while (!open.empty()) {
      const std::int32_t start = open.back();
      open.pop_back();
      const std::int32_t state = faces.state[ix(face_of(start))];
      std::int32_t h = start;
      do {
        const std::int32_t twin = h ^ 1;
        const std::int32_t label = graph.edges[ix(h / 2)].label;
        const std::int32_t across = h % 2 == 0 ? labels.subtract(state, label) : labels.add(state, label);
        if (face_of(twin) < 0) {
          const auto face = static_cast<std::int32_t>(faces.state.size());
          faces.state.push_back(across);
          paint(twin, face);
          open.push_back(twin);
        }
        PCBMESH_ASSERT(faces.state[ix(face_of(twin))] == across);
        h = halves.next[ix(h)];
      } while (h != start);
    }
  }
  return faces;
}

std::int64_t keep_positive(Faces& faces, LabelPool& labels) {
  std::int64_t odd = 0;
  std::vector<Increment> kept;
  for (std::int32_t& state : faces.state) {
    kept.clear();
    bool changed = false;
    for (const Increment& in : labels.entries(state)) {
      changed = changed || in.delta != 1;
      if (in.delta > 0) kept.push_back({in.body, 1});
    }
    if (!changed) continue;
    state = labels.intern(kept);
    ++odd;
  }
  return odd;
}

}  // namespace pcbmesh::overlay
