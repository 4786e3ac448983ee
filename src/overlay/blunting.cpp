// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/overlay/blunting.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "src/overlay/match_sides.hpp"

namespace pcbmesh::overlay {
namespace {

/// Cosine of 20.7 degrees, the angle the triangulation is asked for.
constexpr double bound_cosine = 0.93544;

struct Wedge {
  double cosine;                       ///< of the angle; larger is sharper
  std::int32_t vertex, first, second;  ///< second is counter-clockwise of first
};

std::vector<Wedge> sharp_wedges(const Noder& noder, double angle_deg) {
  const std::vector<Point>& points = noder.points();
  const std::vector<Edge>& edges = noder.edges();
  std::vector<std::int32_t> offsets(points.size() + 1, 0);
  for (const Edge& e : edges) ++offsets[ix(e.u) + 1], ++offsets[ix(e.v) + 1];
  for (std::size_t i = 1; i < offsets.size(); ++i) offsets[i] += offsets[i - 1];
  std::vector<std::int32_t> incident(edges.size() * 2), fill(offsets.begin(), offsets.end() - 1);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    incident[ix(fill[ix(edges[e].u)]++)] = static_cast<std::int32_t>(e);
    incident[ix(fill[ix(edges[e].v)]++)] = static_cast<std::int32_t>(e);
  }
  const double limit = std::cos(angle_deg * std::numbers::pi / 180);
  std::vector<Wedge> wedges;
  const auto far_end = [&](std::int32_t e, std::int32_t v) {
    return points[ix(edges[ix(e)].u == v ? edges[ix(e)].v : edges[ix(e)].u)];
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto v = static_cast<std::int32_t>(i);
    const auto first = incident.begin() + offsets[i], last = incident.begin() + offsets[i + 1];
    const auto degree = last - first;
    if (degree < 2) continue;
    const Point centre = points[i];
    const auto cosine = [&](std::int32_t e, std::int32_t f) {
      const Vector p = between(centre, far_end(e, v)), q = between(centre, far_end(f, v));
      return dot(p, q) / std::sqrt(dot(p, p) * dot(q, q));
    };
    if (degree == 2) {
      if (const double c = cosine(*first, *(first + 1)); c > limit) {
        const bool ordered = turn(centre, far_end(*first, v), far_end(*(first + 1), v)) > 0;
        wedges.push_back({c, v, ordered ? *first : *(first + 1), ordered ? *(first + 1) : *first});
      }
      continue;
    }
    std::sort(first, last, [&](std::int32_t e, std::int32_t f) {
      const Point p = far_end(e, v), q = far_end(f, v);
      const bool p_right = p.x > centre.x || (p.x == centre.x && p.y > centre.y),
                 q_right = q.x > centre.x || (q.x == centre.x && q.y > centre.y);
      return p_right != q_right ? p_right : turn(centre, p, q) > 0;
    });
    for (auto it = first; it != last; ++it) {
      const std::int32_t other = it + 1 == last ? *first : *(it + 1);
      if (const double c = cosine(*it, other); c > limit && turn(centre, far_end(*it, v), far_end(other, v)) > 0)
        wedges.push_back({c, v, *it, other});
    }
  }
  std::sort(wedges.begin(), wedges.end(), [](const Wedge& a, const Wedge& b) {
    return a.cosine != b.cosine ? a.cosine > b.cosine : a.vertex != b.vertex ? a.vertex < b.vertex : a.first < b.first;
  });
  return wedges;
}

class Blunter {
 public:
  Blunter(Noder& noder, const BluntLimits& limits, const Conductors& conductors)
      : noder_(noder),
        limits_(limits),
        conductors_(conductors),
        removed_(noder.edges().size(), 0),
        grid_(box_of(noder.points(), noder.edges()), noder.edges().size(), static_cast<Nm>(limits.width_nm) + 1) {
    lists_.start(grid_.num_cells());
    for (std::size_t e = 0; e < noder.edges().size(); ++e) {
      grid_.along_segment(start_of(e), end_of(e), 0, [&](std::int32_t first, std::int32_t last) {
        for (std::int32_t cell = first; cell <= last; ++cell) lists_.put(cell, static_cast<std::int32_t>(e));
      });
    }
    lists_.finish();
  }

  std::int64_t run(const std::vector<Wedge>& wedges) {
    std::int64_t count = 0;
    for (const Wedge& wedge : wedges) {
      if (!removed_[ix(wedge.first)] && !removed_[ix(wedge.second)] && apply(wedge)) ++count;
    }
    if (count > 0) noder_.replace(removed_, added_);
    return count;
  }

 private:
  [[nodiscard]] Point start_of(std::size_t e) const { return noder_.points()[ix(noder_.edges()[e].u)]; }
  [[nodiscard]] Point end_of(std::size_t e) const { return noder_.points()[ix(noder_.edges()[e].v)]; }
  [[nodiscard]] std::int32_t label_from(const Edge& e, std::int32_t v) {
    return e.u == v ? e.label : noder_.labels().negate(e.label);
  }

  bool apply(const Wedge& wedge) {
    const Edge first = noder_.edges()[ix(wedge.first)], second = noder_.edges()[ix(wedge.second)];
    const std::int32_t v = wedge.vertex;
    const Point at = noder_.points()[ix(v)];
    const std::int32_t first_end = first.u == v ? first.v : first.u, second_end = second.u == v ? second.v : second.u;
    const double first_length = distance(at, noder_.points()[ix(first_end)]),
                 second_length = distance(at, noder_.points()[ix(second_end)]);
    const double half_sine = std::sqrt(std::max(0.0, (1 - wedge.cosine) / 2));
    // An angle below the triangulation's bound is worth going nearer to a neck; the topology check has the last word.
    guard_ = wedge.cosine > bound_cosine ? 0.5 : 1.0;
    const double run = limits_.width_nm / (2 * half_sine);
    const double least = run + static_cast<double>(noder_.tolerance());
    if (std::min(first_length, second_length) >= least) {
      // The stiffer, else the longer edge keeps its place if it can.
      const int first_stiff = noder_.stiffness(first), second_stiff = noder_.stiffness(second);
      const bool keep_first = first_stiff != second_stiff ? first_stiff > second_stiff : first_length >= second_length;
      if ((keep_first ? second_stiff : first_stiff) > 0) return false;
      if (run_together(wedge, keep_first, run)) return true;
      return (keep_first ? first_stiff : second_stiff) == 0 && run_together(wedge, !keep_first, run);
    }
    const bool move_first = first_length > second_length;
    if (route_by_end(wedge, move_first)) return true;
    return std::abs(first_length - second_length) < static_cast<double>(noder_.tolerance()) && route_by_end(wedge, !move_first);
  }

  /// Both edges share v -> m2, the one that gives way then steps across to m1.
  bool run_together(const Wedge& wedge, bool keep_first, double run) {
    const std::int32_t v = wedge.vertex;
    const std::int32_t keep_id = keep_first ? wedge.first : wedge.second, move_id = keep_first ? wedge.second : wedge.first;
    const Edge keep = noder_.edges()[ix(keep_id)], move = noder_.edges()[ix(move_id)];
    const std::int32_t keep_end = keep.u == v ? keep.v : keep.u, move_end = move.u == v ? move.v : move.u;
    const std::int32_t keep_label = label_from(keep, v), move_label = label_from(move, v);
    const Point at = noder_.points()[ix(v)];
    const auto along = [&](std::int32_t end) {
      const Vector way = between(at, noder_.points()[ix(end)]);
      const double share = run / std::sqrt(dot(way, way));
      return Point{at.x + std::llround(way.x * share), at.y + std::llround(way.y * share)};
    };
    const Point on_keep = along(keep_end), on_move = along(move_end);
    if (!is_safe(v, keep_label, move_label, move_id, on_keep, on_move)) return false;
    const std::int32_t m2 = noder_.add_point(on_keep), m1 = noder_.add_point(on_move);
    removed_[ix(keep_id)] = removed_[ix(move_id)] = 1;
    added_.push_back({v, m2, noder_.labels().add(keep_label, move_label)});
    added_.push_back({m2, keep_end, keep_label});
    added_.push_back({m2, m1, move_label});
    added_.push_back({m1, move_end, move_label});
    return true;
  }

  /// The edge that gives way, the longer or one hardly shorter, goes by the end of the other.
  bool route_by_end(const Wedge& wedge, bool move_first) {
    const std::int32_t v = wedge.vertex;
    const std::int32_t keep_id = move_first ? wedge.second : wedge.first, move_id = move_first ? wedge.first : wedge.second;
    const Edge keep = noder_.edges()[ix(keep_id)], move = noder_.edges()[ix(move_id)];
    if (noder_.stiffness(move) > 0) return false;
    const std::int32_t keep_end = keep.u == v ? keep.v : keep.u, move_end = move.u == v ? move.v : move.u;
    const Point at = noder_.points()[ix(v)], by = noder_.points()[ix(keep_end)], to = noder_.points()[ix(move_end)];
    const double detour = 1.6 * limits_.width_nm;
    const Foot foot = foot_of(by, at, to);
    const double beyond = (foot.share - 1) * distance(at, to);
    if (foot.line_distance2 > detour * detour || beyond >= static_cast<double>(noder_.tolerance())) return false;
    const std::int32_t keep_label = label_from(keep, v), move_label = label_from(move, v);
    if (!is_safe(v, keep_label, move_label, move_id, by, to)) return false;
    removed_[ix(move_id)] = removed_[ix(keep_id)] = 1;
    added_.push_back({v, keep_end, noder_.labels().add(keep_label, move_label)});
    added_.push_back({keep_end, move_end, move_label});
    return true;
  }

  /// Neither may two nets come to share an edge, nor may a neck beyond the wedge get narrower.
  bool is_safe(std::int32_t v, std::int32_t keep_label, std::int32_t move_label, std::int32_t move_id, Point keep_to,
               Point move_to) {
    LabelPool& labels = noder_.labels();
    const Edge& move = noder_.edges()[ix(move_id)];
    const std::int32_t move_end = move.u == v ? move.v : move.u;
    pairs_.clear();
    conductors_.pairs_across(labels, labels.add(keep_label, move_label), pairs_);
    if (!pairs_.empty()) return false;
    for (const Increment& in : labels.entries(move_label)) {
      if (std::ranges::binary_search(limits_.spared, in.body)) return false;
    }
    // A body whose outline both edges are has its tip in the wedge; it loses or gains only that.
    bodies_.clear();
    for (const Increment& in : labels.entries(move_label)) {
      if (labels.delta(keep_label, in.body) == 0) bodies_.push_back(in.body);
    }
    if (bodies_.empty()) return true;
    const Point at = noder_.points()[ix(v)];
    const int move_side = turn(at, keep_to, move_to);
    const double reach = guard_ * limits_.width_nm;
    bool safe = true;
    grid_.along_segment(at, keep_to, reach, [&](std::int32_t first, std::int32_t last) {
      for (const std::int32_t e : lists_.items(first, last)) {
        if (!safe) return;
        const Edge& other = noder_.edges()[ix(e)];
        // What goes on from the ends of the edge that gives way is the same side of the body, no neck.
        if (e == move_id || other.u == v || other.v == v || other.u == move_end || other.v == move_end) continue;
        const Point p = noder_.points()[ix(other.u)], q = noder_.points()[ix(other.v)];
        if (turn(at, keep_to, p) * move_side >= 0 && turn(at, keep_to, q) * move_side >= 0) continue;
        const double near2 = std::min({segment_distance2(p, at, keep_to), segment_distance2(q, at, keep_to),
                                       segment_distance2(at, p, q), segment_distance2(keep_to, p, q)});
        if (near2 > reach * reach) continue;
        for (const std::int32_t body : bodies_) safe = safe && labels.delta(other.label, body) == 0;
      }
    });
    return safe;
  }

  Noder& noder_;
  const BluntLimits& limits_;
  const Conductors& conductors_;
  std::vector<std::uint8_t> removed_;
  std::vector<Edge> added_;
  CellGrid grid_;
  CellLists lists_;
  std::vector<NetPair> pairs_;
  std::vector<std::int32_t> bodies_;
  double guard_ = 2;
};

}  // namespace

std::int64_t blunt(Noder& noder, const BluntLimits& limits, const Conductors& conductors) {
  if (limits.angle_deg <= 0 || limits.width_nm <= 0) return 0;
  std::vector<Wedge> wedges = sharp_wedges(noder, limits.angle_deg);
  // What is sharp on one of two periodic sides is obtuse on the other: blunted, they would differ.
  const PeriodicSides periodic(conductors.model());
  std::erase_if(wedges, [&](const Wedge& wedge) { return periodic.hold(noder.points()[ix(wedge.vertex)]); });
  return wedges.empty() ? 0 : Blunter(noder, limits, conductors).run(wedges);
}

}  // namespace pcbmesh::overlay
