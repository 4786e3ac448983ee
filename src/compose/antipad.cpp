// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/compose/antipad.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <vector>

#include "pcbmesh/geometry/polygon_sets.hpp"
#include "pcbmesh/geometry/ring_contact.hpp"

namespace pcbmesh::compose {
namespace {

using geometry::Box;
using geometry::Point;
using geometry::Ring;

/// An antipad reaches no farther from its hole.
constexpr Nm reach_nm = 3 * nm_per_mm;
/// Radii of one edge may differ by this share of the gap: an octagon passes, two antipads in one do not.
constexpr double most_out_of_round = 0.25;
constexpr double least_gap_nm = 20e3;

struct Radii {
  double least = std::numeric_limits<double>::infinity(), most = 0;
};

/// Least and greatest distance of a ring from a point inside it.
Radii radii_of(const Ring& ring, Point centre) {
  Radii radii;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const double ax = static_cast<double>(ring[j].x - centre.x), ay = static_cast<double>(ring[j].y - centre.y);
    const double ux = static_cast<double>(ring[i].x - ring[j].x), uy = static_cast<double>(ring[i].y - ring[j].y);
    const double square = ux * ux + uy * uy;
    const double share = square > 0 ? std::clamp(-(ax * ux + ay * uy) / square, 0.0, 1.0) : 0;
    radii.least = std::min(radii.least, std::hypot(ax + share * ux, ay + share * uy));
    radii.most = std::max(radii.most, std::hypot(ax, ay));
  }
  return radii;
}

double radius_of_same_area(const Ring& ring) {
  constexpr double nm_per_mm_exact = 1e6;
  return std::sqrt(std::abs(geometry::area_mm2(ring)) / std::numbers::pi) * nm_per_mm_exact;
}

/// What a figure covers inside a box.
void add_covered(const geometry::Figure& figure, const geometry::ArcOptions& arcs, const Box& box, std::vector<Ring>& rings) {
  if (!geometry::bounds(figure).touches(box)) return;
  bool simple = true;
  std::vector<Ring> own;
  for (const Ring& ring : geometry::outline(figure, arcs, simple))
    if (Ring cut = geometry::clip_to_box(ring, box); cut.size() >= 3) own.push_back(std::move(cut));
  // A shape that may cross itself counts on its own, so that a negative loop cancels nobody's copper.
  if (!simple) own = geometry::united(own);
  rings.insert(rings.end(), own.begin(), own.end());
}

/// The smallest hole of a set of the plane that holds the point, counter-clockwise; empty = none.
Ring hole_round(const std::vector<Ring>& covered, Point p) {
  Ring found;
  for (const Ring& ring : covered) {
    if (geometry::twice_area_nm2(ring) >= 0 || geometry::location(p, ring) <= 0) continue;
    if (found.empty() || std::abs(geometry::area_mm2(ring)) < std::abs(geometry::area_mm2(found))) found = ring;
  }
  if (!found.empty()) geometry::make_counter_clockwise(found);
  return found;
}

std::string um(double nm) {
  return fmt::format("{:.4g}", nm * 1e-3);
}

}  // namespace

Antipad find_antipad(const board::Board& board, const geometry::ArcOptions& arcs, const board::Drill& hole, std::int32_t layer,
                     std::optional<std::int32_t> reference) {
  Antipad found;
  const Point centre = hole.figure.path.points.front();
  const Box box = geometry::bounds(hole.figure).grown(reach_nm);
  std::map<std::int32_t, std::vector<Ring>> copper;
  for (const board::Shape& shape : board.shapes())
    if (shape.copper_layer == layer) add_covered(shape.figure, arcs, box, copper[shape.net]);
  for (const board::Drill& drill : board.drills())
    if (drill.plated && drill.first_copper <= layer && layer <= drill.last_copper)
      add_covered(drill.figure, arcs, box, copper[drill.net]);
  for (auto& [net, rings] : copper) rings = geometry::united(rings);

  double smallest = std::numeric_limits<double>::infinity();
  for (const auto& [net, rings] : copper) {
    if (net == hole.net || net < 0 || (reference && net != *reference)) continue;
    Ring around = hole_round(rings, centre);
    if (around.empty() || geometry::area_mm2(around) >= smallest) continue;
    smallest = geometry::area_mm2(around);
    found.outer = std::move(around);
    found.net = net;
  }
  if (found.outer.empty()) {
    found.reason = reference ? fmt::format("copper of net '{}' does not surround the hole", board.net_name(*reference))
                             : std::string("no copper surrounds the hole");
    return found;
  }
  for (const auto& [net, rings] : copper) {
    std::vector<Ring> inside = geometry::intersected(rings, {found.outer});
    if (net == hole.net) {
      std::erase_if(inside, [](const Ring& ring) { return geometry::twice_area_nm2(ring) < 0; });
      if (inside.size() == 1 && geometry::location(centre, inside.front()) > 0) {
        found.inner = std::move(inside.front());
        continue;
      }
    }
    if (geometry::covered_mm2(inside) == 0) continue;
    found.reason = fmt::format("more copper, of net '{}', lies in the antipad beside the hole", board.net_name(net));
    return found;
  }
  if (found.inner.empty()) {
    found.reason = "the hole has no copper there";
    return found;
  }
  found.outer_radius_nm = radius_of_same_area(found.outer);
  found.inner_radius_nm = radius_of_same_area(found.inner);
  const Radii outer = radii_of(found.outer, centre), inner = radii_of(found.inner, centre);
  const double gap = found.outer_radius_nm - found.inner_radius_nm;
  const double out_of_round = std::max(outer.most - outer.least, inner.most - inner.least);
  if (inner.most >= outer.least || gap < least_gap_nm || out_of_round > most_out_of_round * gap)
    found.reason = fmt::format(
        "the gap is no round ring: the hole's copper reaches {} to {} um from its middle, the plane of net '{}' begins at {} "
        "to "
        "{} um",
        um(inner.least), um(inner.most), board.net_name(found.net), um(outer.least), um(outer.most));
  return found;
}

}  // namespace pcbmesh::compose
