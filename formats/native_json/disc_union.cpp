// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/native_json/disc_union.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>

#include "formats/native_json/contour.hpp"

namespace pcbmesh::formats::native_json {
namespace {

using geometry::Path;
using geometry::Point;
using DiscPair = std::pair<std::size_t, std::size_t>;

constexpr double full_turn = 2 * std::numbers::pi;
/// Two crossings closer than this on a circle are one point for all practical purposes.
constexpr double least_angle = 1e-9;

double distance(const Disc& a, const Disc& b) {
  return std::hypot(static_cast<double>(b.centre.x - a.centre.x), static_cast<double>(b.centre.y - a.centre.y));
}

Point on_circle(const Disc& disc, double angle) {
  return {std::llround(static_cast<double>(disc.centre.x) + static_cast<double>(disc.radius) * std::cos(angle)),
          std::llround(static_cast<double>(disc.centre.y) + static_cast<double>(disc.radius) * std::sin(angle))};
}

/// Part of a circle inside another disc: entered at `enter`, left at `leave`, walking counter-clockwise.
struct Covered {
  std::size_t by;
  double enter, leave;
};

double ahead(double from, double to) {
  const double turn = std::fmod(to - from, full_turn);
  return turn < 0 ? turn + full_turn : turn;
}

/// Free arc of one circle: begins where it leaves `from`, ends where it enters `to`.
struct FreeArc {
  std::size_t to;
  Point start, mid;
  bool used = false;
};

/// Discs of one group that no other of the group contains.
std::vector<std::size_t> uncontained(const std::vector<Disc>& discs, const std::vector<std::size_t>& members) {
  std::vector<std::size_t> out;
  for (std::size_t i : members) {
    const bool contained = std::any_of(members.begin(), members.end(), [&](std::size_t j) {
      const double slack = static_cast<double>(discs[j].radius - discs[i].radius) - distance(discs[i], discs[j]);
      return j != i && (slack > 0 || (slack == 0 && (discs[j].radius > discs[i].radius || j < i)));
    });
    if (!contained) out.push_back(i);
  }
  return out;
}

/// Free arcs by (circle, disc that the arc comes out of); empty optional where crossings coincide.
std::optional<std::map<DiscPair, FreeArc>> free_arcs(const std::vector<Disc>& discs, const std::vector<std::size_t>& members) {
  std::map<DiscPair, FreeArc> arcs;
  for (std::size_t i : members) {
    const double r = static_cast<double>(discs[i].radius);
    std::vector<Covered> covered;
    for (std::size_t j : members) {
      const double d = distance(discs[i], discs[j]), s = static_cast<double>(discs[j].radius);
      if (j == i || d >= r + s) continue;
      const double cosine = (d * d + r * r - s * s) / (2 * d * r);
      if (!(std::abs(cosine) < 1)) return std::nullopt;  // touching from inside
      const double towards = std::atan2(static_cast<double>(discs[j].centre.y - discs[i].centre.y),
                                        static_cast<double>(discs[j].centre.x - discs[i].centre.x));
      const double half = std::acos(cosine);
      covered.push_back({j, towards - half, towards + half});
    }
    for (const Covered& behind : covered) {
      bool is_free = true;
      double nearest = full_turn;
      std::size_t to = behind.by;
      for (const Covered& next : covered) {
        const double to_enter = ahead(behind.leave, next.enter), to_leave = ahead(behind.leave, next.leave);
        if (&next != &behind &&
            (std::min(to_leave, full_turn - to_leave) < least_angle || std::min(to_enter, full_turn - to_enter) < least_angle))
          return std::nullopt;
        if (&next != &behind && to_leave < to_enter) is_free = false;
        if (to_enter < nearest) nearest = to_enter, to = next.by;
      }
      if (is_free)
        arcs[{i, behind.by}] = {to, on_circle(discs[i], behind.leave), on_circle(discs[i], behind.leave + nearest / 2)};
    }
  }
  return arcs;
}

/// The loop that goes round all discs. Where a circle enters disc k it meets k's arc that comes out of this circle.
std::optional<Path> outer_loop(const std::vector<Disc>& discs, const std::vector<std::size_t>& members) {
  const std::vector<std::size_t> rim = uncontained(discs, members);
  if (rim.size() == 1) return circle_path(discs[rim.front()].centre, discs[rim.front()].radius);
  auto arcs = free_arcs(discs, rim);
  if (!arcs) return std::nullopt;
  std::optional<Path> outer;
  for (auto& [first, arc] : *arcs) {
    if (arc.used) continue;
    Path path;
    path.closed = true;
    DiscPair at = first;
    do {
      const auto found = arcs->find(at);
      if (found == arcs->end() || found->second.used) return std::nullopt;
      FreeArc& step = found->second;
      step.used = true;
      path.arc_starts.push_back(static_cast<std::int32_t>(path.points.size()));
      path.points.push_back(step.start);
      path.points.push_back(step.mid);
      at = {step.to, at.first};
    } while (at != first);
    // Loops round enclosed scraps run clockwise.
    if (geometry::twice_area_nm2(geometry::flatten(path, {nm_per_um, geometry::ArcMode::inscribed})) <= 0) continue;
    if (outer) return std::nullopt;
    outer = std::move(path);
  }
  return outer;
}

}  // namespace

std::vector<DiscCluster> unite(const std::vector<Disc>& discs) {
  std::vector<std::size_t> order(discs.size()), parent(discs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root = [&](std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  const auto left = [&](std::size_t i) { return discs[i].centre.x - discs[i].radius; };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return left(a) < left(b); });
  std::vector<std::size_t> active;
  for (std::size_t i : order) {
    std::erase_if(active, [&](std::size_t k) { return discs[k].centre.x + discs[k].radius < left(i); });
    for (std::size_t k : active)
      if (distance(discs[i], discs[k]) < static_cast<double>(discs[i].radius + discs[k].radius)) {
        const std::size_t a = root(i), b = root(k);
        parent[std::max(a, b)] = std::min(a, b);
      }
    active.push_back(i);
  }
  std::map<std::size_t, DiscCluster> clusters;
  for (std::size_t i = 0; i < discs.size(); ++i) clusters[root(i)].members.push_back(i);
  std::vector<DiscCluster> out;
  for (auto& [first, cluster] : clusters) {
    cluster.path = outer_loop(discs, cluster.members);
    out.push_back(std::move(cluster));
  }
  return out;
}

}  // namespace pcbmesh::formats::native_json
