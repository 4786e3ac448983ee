// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/overlay/collapse.hpp"

#include <algorithm>
#include <limits>
#include <queue>

#include "src/overlay/cell_grid.hpp"

namespace pcbmesh::overlay {
namespace {

/// A run this long under one edge is not looked through again and again.
constexpr std::int32_t longest_run = 1000;

/// Edge of a chain, directed along it.
struct Link {
  std::int32_t u = -1, v = -1;
  std::int32_t label = 0;
  std::int32_t chain = -1;                ///< -1: not simplified
  std::int32_t from = 0, to = 0;          ///< places of u and v along the original chain
  std::int32_t previous = -1, next = -1;  ///< links of the chain; -1 at its ends
  std::uint32_t stamp = 0;
  bool alive = true;
};

/// Original vertices of one run of soft vertices. Closed chains repeat no point.
struct Chain {
  std::int32_t first = 0;  ///< into the array of originals
  std::int32_t size = 0;
  bool closed = false;
};

/// Ordered by place where deviations are equal, so that equal outlines of two sheets shrink alike.
struct Candidate {
  double deviation;
  Point low, high;
  std::int32_t link;
  std::uint32_t stamp;
  bool operator<(const Candidate& other) const {
    if (deviation != other.deviation) return deviation > other.deviation;
    if (low != other.low) return low > other.low;
    return high != other.high ? high > other.high : link > other.link;
  }
};

struct Plan {
  double deviation = std::numeric_limits<double>::infinity();
  Point e;
  bool straight = false;  ///< a-d directly
  std::int32_t place = 0;
};

class Collapser {
 public:
  Collapser(const EdgeGraph& graph, const std::vector<std::uint8_t>& marks, const CollapseLimits& limits,
            const Progress& progress)
      : points_(graph.points),
        limits_(limits),
        progress_(progress),
        grid_(box_of(graph.points, graph.edges), graph.edges.size(), static_cast<Nm>(limits.deviation_nm) + 1),
        head_(ix(grid_.num_cells()), -1) {
    make_chains(graph, marks);
    for (std::size_t k = 0; k < links_.size(); ++k) insert(static_cast<std::int32_t>(k));
  }

  EdgeGraph run(LabelPool& labels) {
    // First what sheets have in common, the same way on each; then across the ends of that.
    for (hold_run_ends_ = true;; hold_run_ends_ = false) {
      for (std::size_t k = 0; k < links_.size(); ++k) consider(static_cast<std::int32_t>(k));
      drain();
      if (!hold_run_ends_) break;
    }
    EdgeGraph result{std::move(points_), {}};
    for (const Link& link : links_) {
      if (link.alive) result.edges.push_back({link.u, link.v, link.label >= 0 ? link.label : labels.negate(-1 - link.label)});
    }
    compact(result, labels);
    return result;
  }

 private:
  void drain() {
    std::size_t steps = 0;
    while (!queue_.empty()) {
      if (++steps % 4096 == 0) progress_.check();
      const Candidate candidate = queue_.top();
      queue_.pop();
      const Link& link = links_[ix(candidate.link)];
      if (!link.alive || link.stamp != candidate.stamp) continue;
      const Plan plan = planned(candidate.link);
      if (plan.deviation <= limits_.deviation_nm && is_clear(candidate.link, plan)) apply(candidate.link, plan);
    }
  }

  struct Entry {
    std::int32_t link, next;
  };

  void make_chains(const EdgeGraph& graph, const std::vector<std::uint8_t>& marks);
  void walk(const EdgeGraph& graph, std::int32_t start_vertex, std::int32_t start_edge, std::vector<std::uint8_t>& seen);
  void insert(std::int32_t link);
  void consider(std::int32_t link);
  [[nodiscard]] Plan planned(std::int32_t link) const;
  [[nodiscard]] bool place_corner(Point a, Point b, Point c, Point d, Plan& plan) const;
  [[nodiscard]] double deviation_of(const Link& before, const Link& after, Plan& plan) const;
  [[nodiscard]] bool is_clear(std::int32_t link, const Plan& plan) const;
  void apply(std::int32_t link, const Plan& plan);
  [[nodiscard]] Point original(const Chain& chain, std::int32_t place) const { return originals_[ix(chain.first + place)]; }
  [[nodiscard]] static std::int32_t after(const Chain& chain, std::int32_t place) {
    return place + 1 == chain.size && chain.closed ? 0 : place + 1;
  }

  std::vector<Point> points_;
  CollapseLimits limits_;
  const Progress& progress_;
  std::vector<Link> links_;
  std::vector<Chain> chains_;
  std::vector<Point> originals_;
  std::vector<std::int32_t> offsets_, incident_;  ///< edges per vertex, at the start
  CellGrid grid_;
  std::vector<std::int32_t> head_;  ///< per cell: first entry or -1
  std::vector<Entry> entries_;
  std::priority_queue<Candidate> queue_;
  std::vector<std::uint8_t> soft_, run_end_;
  bool hold_run_ends_ = false;
};

void Collapser::make_chains(const EdgeGraph& graph, const std::vector<std::uint8_t>& marks) {
  const std::size_t num_points = graph.points.size();
  offsets_.assign(num_points + 1, 0);
  for (const Edge& e : graph.edges) ++offsets_[ix(e.u) + 1], ++offsets_[ix(e.v) + 1];
  for (std::size_t i = 1; i < offsets_.size(); ++i) offsets_[i] += offsets_[i - 1];
  incident_.resize(graph.edges.size() * 2);
  std::vector<std::int32_t> fill(offsets_.begin(), offsets_.end() - 1);
  for (std::size_t e = 0; e < graph.edges.size(); ++e) {
    incident_[ix(fill[ix(graph.edges[e].u)]++)] = static_cast<std::int32_t>(e);
    incident_[ix(fill[ix(graph.edges[e].v)]++)] = static_cast<std::int32_t>(e);
  }
  // Two edges at a vertex carry the same label through it, or windings would not close.
  soft_.resize(num_points);
  for (std::size_t v = 0; v < num_points; ++v) soft_[v] = offsets_[v + 1] - offsets_[v] == 2 && marks[v] != fixed_point;
  run_end_.resize(num_points);
  for (std::size_t v = 0; v < num_points; ++v) run_end_[v] = marks[v] == run_end;
  std::vector<std::uint8_t> seen(graph.edges.size(), 0);
  links_.reserve(graph.edges.size());
  for (std::size_t v = 0; v < num_points; ++v) {
    if (soft_[v]) continue;
    for (std::int32_t k = offsets_[v]; k < offsets_[v + 1]; ++k) {
      if (!seen[ix(incident_[ix(k)])]) walk(graph, static_cast<std::int32_t>(v), incident_[ix(k)], seen);
    }
  }
  for (std::size_t e = 0; e < graph.edges.size(); ++e) {
    if (!seen[e]) walk(graph, graph.edges[e].u, static_cast<std::int32_t>(e), seen);
  }
}

void Collapser::walk(const EdgeGraph& graph, std::int32_t start_vertex, std::int32_t start_edge,
                     std::vector<std::uint8_t>& seen) {
  Chain chain;
  chain.first = static_cast<std::int32_t>(originals_.size());
  const auto chain_id = static_cast<std::int32_t>(chains_.size());
  const auto first_link = static_cast<std::int32_t>(links_.size());
  std::int32_t v = start_vertex, e = start_edge, place = 0;
  originals_.push_back(points_[ix(v)]);
  while (true) {
    seen[ix(e)] = 1;
    const Edge& edge = graph.edges[ix(e)];
    const std::int32_t w = edge.u == v ? edge.v : edge.u;
    Link link;
    link.u = v;
    link.v = w;
    link.label = edge.u == v ? edge.label : -1 - edge.label;  // turned labels are settled below
    link.chain = chain_id;
    link.from = place;
    const auto id = static_cast<std::int32_t>(links_.size());
    link.previous = id == first_link ? -1 : id - 1;
    chain.closed = w == start_vertex && soft_[ix(w)];
    link.to = chain.closed ? 0 : place + 1;
    links_.push_back(link);
    if (chain.closed) break;
    originals_.push_back(points_[ix(w)]);
    ++place;
    if (!soft_[ix(w)]) break;
    links_.back().next = id + 1;
    e = incident_[ix(offsets_[ix(w)])] == e ? incident_[ix(offsets_[ix(w)] + 1)] : incident_[ix(offsets_[ix(w)])];
    v = w;
  }
  if (chain.closed) {
    links_.back().next = first_link;
    links_[ix(first_link)].previous = static_cast<std::int32_t>(links_.size()) - 1;
  }
  chain.size = static_cast<std::int32_t>(originals_.size()) - chain.first;
  chains_.push_back(chain);
}

void Collapser::insert(std::int32_t link) {
  grid_.along_segment(points_[ix(links_[ix(link)].u)], points_[ix(links_[ix(link)].v)], 0,
                      [&](std::int32_t first, std::int32_t last) {
                        for (std::int32_t cell = first; cell <= last; ++cell) {
                          entries_.push_back({link, head_[ix(cell)]});
                          head_[ix(cell)] = static_cast<std::int32_t>(entries_.size()) - 1;
                        }
                      });
}

void Collapser::consider(std::int32_t link) {
  if (link < 0) return;
  Link& middle = links_[ix(link)];
  ++middle.stamp;
  if (!middle.alive || middle.previous < 0 || middle.next < 0) return;
  if (hold_run_ends_ && (run_end_[ix(middle.u)] || run_end_[ix(middle.v)])) return;
  const Plan plan = planned(link);
  if (plan.deviation > limits_.deviation_nm) return;
  const Point b = points_[ix(middle.u)], c = points_[ix(middle.v)];
  // Nanometre noise must not decide: the two directions of a chain differ by that much.
  queue_.push({std::floor(plan.deviation / 4), std::min(b, c), std::max(b, c), link, middle.stamp});
}

bool Collapser::place_corner(Point a, Point b, Point c, Point d, Plan& plan) const {
  // All relative to a, so that doubles are good to far below a nanometre.
  const Vector ab = between(a, b), ac = between(a, c), ad = between(a, d), cd = between(c, d);
  const double length2 = dot(ad, ad);
  const double height_b = cross(ad, ab), height_c = cross(ad, ac);  // times |ad|
  const double twice_area = cross(ab, ac) + cross(ac, ad);          // of a-b-c-d
  // Triangle a-e-d has the same area when e stands at this height over a-d.
  const double height = -twice_area;
  const bool same_side = (height_b >= 0) == (height_c >= 0);
  const bool on_ab = same_side ? std::abs(height_b) > std::abs(height_c) : (height_b >= 0) == (height >= 0);
  // Nanometre jitter: a corner that flat would land anywhere.
  if (std::abs(height) <= 2 * std::sqrt(length2)) {
    plan.straight = true;
    return true;
  }
  Vector e;
  if (on_ab) {
    if (height_b == 0) return false;
    const double share = height / height_b;
    e = {ab.x * share, ab.y * share};
  } else {
    if (height_c == 0) return false;
    const double share = height / height_c;  // along d -> c
    e = {ad.x - cd.x * share, ad.y - cd.y * share};
  }
  const double reach = std::sqrt(length2) + std::sqrt(dot(ab, ab)) + std::sqrt(dot(cd, cd)) + 4 * limits_.deviation_nm;
  if (!(std::abs(e.x) < 2 * reach && std::abs(e.y) < 2 * reach)) return false;
  plan.e = {a.x + std::llround(e.x), a.y + std::llround(e.y)};
  return plan.e != a && plan.e != d && turn(a, plan.e, d) != 0;
}

double Collapser::deviation_of(const Link& before, const Link& after_link, Plan& plan) const {
  const Chain& chain = chains_[ix(before.chain)];
  const Point a = points_[ix(before.u)], d = points_[ix(after_link.v)];
  const double limit2 = limits_.deviation_nm * limits_.deviation_nm;
  double worst2 = 0, nearest2 = std::numeric_limits<double>::infinity(), outline2 = nearest2;
  std::int32_t run = 0;
  Point last = original(chain, before.from);
  plan.place = before.from;
  for (std::int32_t place = before.from; place != after_link.to;) {
    place = after(chain, place);
    const Point p = original(chain, place);
    if (!plan.straight) outline2 = std::min(outline2, segment_distance2(plan.e, last, p));
    last = p;
    if (place == after_link.to) break;
    if (++run > longest_run) return std::numeric_limits<double>::infinity();
    const double d2 =
        plan.straight ? segment_distance2(p, a, d) : std::min(segment_distance2(p, a, plan.e), segment_distance2(p, plan.e, d));
    worst2 = std::max(worst2, d2);
    if (worst2 > limit2) return std::numeric_limits<double>::infinity();
    if (plan.straight) continue;
    const double to_e = distance2(p, plan.e);
    if (to_e < nearest2) nearest2 = to_e, plan.place = place;
  }
  if (!plan.straight) worst2 = std::max(worst2, outline2);
  return std::sqrt(worst2);
}

Plan Collapser::planned(std::int32_t link) const {
  Plan plan;
  const Link& middle = links_[ix(link)];
  const Link &before = links_[ix(middle.previous)], &behind = links_[ix(middle.next)];
  // A ring keeps at least a triangle.
  if (before.u == behind.v || before.previous == middle.next) return plan;
  if (!place_corner(points_[ix(before.u)], points_[ix(middle.u)], points_[ix(middle.v)], points_[ix(behind.v)], plan))
    return plan;
  // Straight: two vertices fewer, which a ring of five can bear, and no second edge may stand on the same ends.
  if (plan.straight && before.previous >= 0 && before.previous == behind.next) return plan;
  if (plan.straight && before.previous >= 0 && behind.next >= 0 && links_[ix(before.previous)].previous == behind.next)
    return plan;
  plan.deviation = deviation_of(before, behind, plan);
  return plan;
}

bool Collapser::is_clear(std::int32_t link, const Plan& plan) const {
  const Link& middle = links_[ix(link)];
  const std::int32_t before = middle.previous, behind = middle.next;
  const std::int32_t a_id = links_[ix(before)].u, d_id = links_[ix(behind)].v;
  const Point a = points_[ix(a_id)], b = points_[ix(middle.u)], c = points_[ix(middle.v)], d = points_[ix(d_id)];
  const Point e = plan.straight ? a : plan.e;
  const Point corners[5] = {a, b, c, d, e};
  const double clear = limits_.clearance_nm, clear2 = clear * clear;
  geometry::Box box;
  for (const Point p : corners) box.add(p);
  const auto swept = [&](Point p) {
    bool inside = false;
    for (std::size_t i = 0, j = 4; i < 5; j = i++) {
      const Point q = corners[i], r = corners[j];
      if ((q.y > p.y) != (r.y > p.y) && (turn(q, r, p) > 0) == (r.y > q.y)) inside = !inside;
    }
    return inside;
  };
  // New edges: a-e and e-d, or a-d.
  const Point ends[2][2] = {{a, plan.straight ? d : e}, {e, d}};
  const int num_new = plan.straight ? 1 : 2;
  const auto meets = [&](const Link& other, const Point p, const Point q, int k) {
    const Point from = ends[k][0], to = ends[k][1];
    const bool p_common = other.u == a_id || other.u == d_id, q_common = other.v == a_id || other.v == d_id;
    if (!p_common && segment_distance2(p, from, to) <= clear2) return true;
    if (!q_common && segment_distance2(q, from, to) <= clear2) return true;
    if (plan.straight && p_common && q_common) return true;  // the two would become one edge
    const auto at_end = [&](Point x) { return (p_common && x == p) || (q_common && x == q); };
    if (!at_end(from) && segment_distance2(from, p, q) <= clear2) return true;
    if (!at_end(to) && segment_distance2(to, p, q) <= clear2) return true;
    return crosses_properly(from, to, p, q);
  };
  const double margin = clear + 1;
  const auto hits = [&](const Link& other) {
    const Point p = points_[ix(other.u)], q = points_[ix(other.v)];
    if (static_cast<double>(std::max(p.x, q.x)) < static_cast<double>(box.min.x) - margin ||
        static_cast<double>(std::min(p.x, q.x)) > static_cast<double>(box.max.x) + margin ||
        static_cast<double>(std::max(p.y, q.y)) < static_cast<double>(box.min.y) - margin ||
        static_cast<double>(std::min(p.y, q.y)) > static_cast<double>(box.max.y) + margin)
      return false;
    for (int n = 0; n < num_new; ++n) {
      if (meets(other, p, q, n)) return true;
    }
    return (other.u != a_id && other.u != d_id && swept(p)) || (other.v != a_id && other.v != d_id && swept(q));
  };
  bool free = true;
  // What is swept over lies within the deviation of the old outline and so near the new one.
  const double reach = 2 * limits_.deviation_nm + margin;
  for (int n = 0; free && n < num_new; ++n) {
    grid_.along_segment(ends[n][0], ends[n][1], reach, [&](std::int32_t first, std::int32_t last) {
      for (std::int32_t cell = first; free && cell <= last; ++cell) {
        for (std::int32_t k = head_[ix(cell)]; free && k >= 0; k = entries_[ix(k)].next) {
          const std::int32_t id = entries_[ix(k)].link;
          if (links_[ix(id)].alive && id != link && id != before && id != behind) free = !hits(links_[ix(id)]);
        }
      }
    });
  }
  return free;
}

void Collapser::apply(std::int32_t link, const Plan& plan) {
  Link& middle = links_[ix(link)];
  const std::int32_t before = middle.previous, behind = middle.next;
  Link &first = links_[ix(before)], &last = links_[ix(behind)];
  middle.alive = false;
  if (plan.straight) {
    first.v = last.v;
    first.to = last.to;
    first.next = last.next;
    if (last.next >= 0) links_[ix(last.next)].previous = before;
    last.alive = false;
  } else {
    points_[ix(first.v)] = plan.e;
    last.u = first.v;
    first.to = last.from = plan.place;
    first.next = behind;
    last.previous = before;
    insert(behind);
  }
  insert(before);
  consider(before);
  consider(first.next);
  consider(first.previous);
  if (first.next >= 0) consider(links_[ix(first.next)].next);
}

}  // namespace

EdgeGraph collapse(const EdgeGraph& graph, const std::vector<std::uint8_t>& marks, const CollapseLimits& limits,
                   LabelPool& labels, const Progress& progress) {
  if (graph.edges.empty() || limits.deviation_nm <= 0) return graph;
  return Collapser(graph, marks, limits, progress).run(labels);
}

}  // namespace pcbmesh::overlay
