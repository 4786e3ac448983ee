// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/compose/footprint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/geometry/polygon_sets.hpp"
#include "pcbmesh/geometry/ring_contact.hpp"

namespace pcbmesh::compose {
namespace {

using board::Board;
using geometry::Box;
using geometry::ContactKind;
using geometry::Point;
using geometry::Ring;
using study::RegionKind;
using study::Study;

/// Rings are cut this far outside the domain: local cost, and the exact cut is the domain's own edge.
constexpr Nm clip_slack_nm = 50 * nm_per_um;
/// Board assumed around the copper where the file has no outline.
constexpr Nm assumed_edge_nm = 1 * nm_per_mm;

std::array<double, 2> mm(Point p) {
  return {static_cast<double>(p.x) * 1e-6, static_cast<double>(p.y) * 1e-6};
}

std::string text_of(const Box& box) {
  return fmt::format("({:.6g}, {:.6g}) to ({:.6g}, {:.6g}) mm", mm(box.min)[0], mm(box.min)[1], mm(box.max)[0], mm(box.max)[1]);
}

Ring rectangle(const Box& box) {
  return {box.min, {box.max.x, box.min.y}, box.max, {box.min.x, box.max.y}};
}

bool has_area(const Box& box) {
  return box.max.x > box.min.x && box.max.y > box.min.y;
}

Box intersection(const Box& a, const Box& b) {
  return {{std::max(a.min.x, b.min.x), std::max(a.min.y, b.min.y)}, {std::min(a.max.x, b.max.x), std::min(a.max.y, b.max.y)}};
}

/// One board: outer ring and sorted-out cut-outs.
struct BoardRings {
  Ring outer;
  std::vector<Ring> cutouts;
};

Ring ring_of(const Board& board, const geometry::Path& path, const Study& study, std::string_view what) {
  Ring ring = geometry::flatten(path, study.arcs);
  if (ring.size() < 3 || geometry::twice_area_nm2(ring) == 0)
    throw Error(ErrorCode::outline_invalid, fmt::format("the {} encloses no area; mend it in the layout program", what),
                {.file = board.source(), .at_mm = mm(path.points.front())});
  geometry::make_counter_clockwise(ring);
  return ring;
}

/// Cut-outs apart from everything stay with their board; one that meets another or the outline is loose, since winding
/// numbers of rings that overlap would count twice. One inside another adds nothing.
void sort_cutouts(const Board& board, const Study& study, const board::Outline& outline, BoardRings& into,
                  std::vector<Ring>& loose, Diagnostics& diagnostics) {
  std::vector<Ring> rings;
  for (const geometry::Path& path : outline.cutouts) rings.push_back(ring_of(board, path, study, "cut-out"));
  const std::size_t n = rings.size();
  std::vector<Box> boxes;
  for (const Ring& ring : rings) boxes.push_back(geometry::bounds(ring));
  std::vector<char> meets(n, 0), drop(n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    if (geometry::contact(rings[i], into.outer).kind != ContactKind::none) {
      meets[i] = 1;
    } else if (!geometry::is_inside(rings[i], into.outer)) {
      drop[i] = 1;
      diagnostics.warn("compose.cutout_outside_outline", "a cut-out outside its board outline is ignored",
                       {.file = board.source(), .at_mm = mm(rings[i].front())});
    }
    for (std::size_t j = 0; j < i; ++j) {
      if (drop[i] || drop[j] || !boxes[i].touches(boxes[j])) continue;
      if (geometry::contact(rings[i], rings[j]).kind != ContactKind::none)
        meets[i] = meets[j] = 1;
      else if (geometry::is_inside(rings[i], rings[j]))
        drop[i] = 1;
      else if (geometry::is_inside(rings[j], rings[i]))
        drop[j] = 1;
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (drop[i]) continue;
    if (meets[i]) {
      diagnostics.note("compose.cutout_meets_outline", "a cut-out meets the outline or another cut-out; their union is cut",
                       {.file = board.source(), .at_mm = mm(rings[i].front())});
      loose.push_back(std::move(rings[i]));
    } else {
      into.cutouts.push_back(std::move(rings[i]));
    }
  }
}

/// Whether two rings have area in common. Aligned rectangles overlap without any edge crossing another, hence the middles.
bool overlap(const Ring& a, const Ring& b) {
  const geometry::Contact met = geometry::contact(a, b);
  if (met.kind == ContactKind::crossing || geometry::is_inside(a, b) || geometry::is_inside(b, a)) return true;
  if (met.kind == ContactKind::none) return false;
  const auto reaches_into = [](const Ring& ring, const Ring& other) {
    for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
      const Point middle{(ring[i].x + ring[j].x) / 2, (ring[i].y + ring[j].y) / 2};
      if (geometry::location(ring[i], other) > 0 || geometry::location(middle, other) > 0) return true;
    }
    return false;
  };
  return reaches_into(a, b) || reaches_into(b, a);
}

void require_apart(const Board& board, const std::vector<BoardRings>& boards) {
  const auto in_cutout = [](const Ring& inner, const BoardRings& frame) {
    return std::any_of(frame.cutouts.begin(), frame.cutouts.end(), [&](const Ring& cutout) {
      return geometry::contact(inner, cutout).kind != ContactKind::crossing && geometry::is_inside(inner, cutout);
    });
  };
  for (std::size_t i = 0; i < boards.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Ring &a = boards[i].outer, &b = boards[j].outer;
      if (!geometry::bounds(a).touches(geometry::bounds(b)) || !overlap(a, b)) continue;
      if (in_cutout(a, boards[j]) || in_cutout(b, boards[i])) continue;
      throw Error(
          ErrorCode::outline_invalid,
          fmt::format("board outlines {} and {} overlap; an outline inside another is a cut-out: mend the outline in the "
                      "layout program",
                      j + 1, i + 1),
          {.file = board.source(), .at_mm = mm(a.front())}, {static_cast<std::int64_t>(j), static_cast<std::int64_t>(i)});
    }
}

/// Bounding box of the copper and holes of one net, or of all.
Box copper_box(const Board& board, std::optional<std::int32_t> net) {
  Box box;
  for (const board::Shape& shape : board.shapes())
    if (!net || shape.net == *net) box.add(geometry::bounds(shape.figure));
  for (const board::Drill& drill : board.drills())
    if (!net || drill.net == *net) box.add(geometry::bounds(drill.figure));
  return box;
}

std::vector<BoardRings> board_rings(const Board& board, const Study& study, std::vector<Ring>& loose,
                                    Diagnostics& diagnostics) {
  std::vector<BoardRings> boards;
  for (const board::Outline& outline : board.outlines()) {
    BoardRings rings{ring_of(board, outline.outer, study, "board outline"), {}};
    if (const auto at = geometry::self_crossing(rings.outer))
      diagnostics.warn("compose.outline_crosses_itself", "the board outline crosses itself; all it winds round is board",
                       {.file = board.source(), .at_mm = mm(*at)});
    sort_cutouts(board, study, outline, rings, loose, diagnostics);
    boards.push_back(std::move(rings));
  }
  require_apart(board, boards);
  if (!boards.empty()) return boards;
  const Box copper = copper_box(board, std::nullopt);
  if (copper.is_empty())
    throw Error(ErrorCode::outline_invalid, "the board has neither outline nor copper: there is nothing to mesh",
                {.file = board.source()});
  const Box assumed = copper.grown(assumed_edge_nm);
  diagnostics.warn(
      "compose.outline_absent",
      fmt::format("the board has no outline; the box of its copper and 1 mm around is taken: {}", text_of(assumed)),
      {.file = board.source()});
  boards.push_back({rectangle(assumed), {}});
  return boards;
}

Box nets_box(const Board& board, const Study& study, std::span<const std::int32_t> nets, Diagnostics& diagnostics) {
  Box box;
  std::string bare;
  for (std::int32_t net : nets) {
    const Box one = copper_box(board, net);
    box.add(one);
    if (!one.is_empty()) continue;
    bare += fmt::format("{}'{}'", bare.empty() ? "" : ", ", board.net_name(net));
    diagnostics.warn("compose.net_without_copper", "a net of the region has no copper on this board",
                     {.file = board.source(), .net = std::string(board.net_name(net))});
  }
  if (box.is_empty())
    throw Error(ErrorCode::region_empty,
                fmt::format("no net of the region has copper ({}); name routed nets (`pcbmesh inspect` lists them)", bare),
                {.file = board.source()});
  return box.grown(study.margin);
}

/// The domain's rectangle for a region, cut down to the board and the air beside it. A polygon is taken as it is.
Box region_box(const Board& board, const Study& study, std::span<const std::int32_t> nets, const Box& around,
               Diagnostics& diagnostics) {
  if (study.region == RegionKind::polygon) return geometry::bounds(study.polygon);
  const Box wanted = study.region == RegionKind::box ? *study.box : nets_box(board, study, nets, diagnostics);
  const Box box = intersection(wanted, around);
  if (!has_area(box))
    throw Error(ErrorCode::region_empty,
                fmt::format("the region {} does not meet the board, {}; y is up, as `pcbmesh inspect` prints it",
                            text_of(wanted), text_of(around)),
                {.file = board.source()});
  return box;
}

/// The ring clipped to the box if it reaches out of it; empty if nothing is left.
Ring clipped(Ring ring, const Box& box) {
  const Box own = geometry::bounds(ring);
  if (box.contains(own.min) && box.contains(own.max)) return ring;
  if (!box.touches(own)) return {};
  return geometry::clip_to_box(ring, box);
}

/// Every edge of the ring on the line `axis` = from is swept to `to`. Winding numbers beyond the line become those at it.
Ring swept(const Ring& ring, Nm Point::*axis, Nm from, Nm to) {
  Ring out;
  const std::size_t n = ring.size();
  const auto is_on = [&](std::size_t i) { return ring[i % n].*axis == from; };
  for (std::size_t i = 0; i < n; ++i) {
    const bool was = is_on(i + n - 1), is = is_on(i), will = is_on(i + 1);
    if (!is || !was || !will) out.push_back(ring[i]);
    if (!is || (!was && !will)) continue;
    Point moved = ring[i];
    moved.*axis = to;
    if (was == will)
      out.push_back(moved);
    else if (will)
      out.push_back(moved);  // the run begins: on the line, then beyond it
    else
      out.insert(out.end() - 1, moved);  // the run ends: beyond it, then on the line
  }
  return out;
}

/// Box of the domain with its matched layers.
Box outer_box(const Box& box, const Study& study) {
  const auto thickness = [&](study::HullSide side) {
    const study::Boundary& boundary = study.boundaries[static_cast<std::size_t>(side)];
    return boundary.kind == study::BoundaryKind::pml ? boundary.thickness : 0;
  };
  using study::HullSide;
  return {{box.min.x - thickness(HullSide::xmin), box.min.y - thickness(HullSide::ymin)},
          {box.max.x + thickness(HullSide::xmax), box.max.y + thickness(HullSide::ymax)}};
}

/// Whether a ring and the polygon of the region have area in common.
bool meets(const Ring& ring, const Ring& polygon) {
  return geometry::covered_mm2(geometry::intersected({ring}, {polygon})) > 0;
}

}  // namespace

Ring Footprint::cut(Ring ring) const {
  const Box far = outer.grown(clip_slack_nm);
  Box clip = far;
  if (goes_on[0]) clip.min.x = box.min.x;
  if (goes_on[1]) clip.max.x = box.max.x;
  if (goes_on[2]) clip.min.y = box.min.y;
  if (goes_on[3]) clip.max.y = box.max.y;
  ring = clipped(std::move(ring), clip);
  // First along x, then along y, so that corners are filled.
  if (!ring.empty() && goes_on[0]) ring = swept(ring, &Point::x, box.min.x, far.min.x);
  if (!ring.empty() && goes_on[1]) ring = swept(ring, &Point::x, box.max.x, far.max.x);
  if (!ring.empty() && goes_on[2]) ring = swept(ring, &Point::y, box.min.y, far.min.y);
  if (!ring.empty() && goes_on[3]) ring = swept(ring, &Point::y, box.max.y, far.max.y);
  return ring;
}

bool Footprint::contains(Point p) const {
  if (!box.contains(p)) return false;
  return domain.size() != 1 || geometry::location(p, domain.front()) >= 0;
}

Footprint build_footprint(const Board& board, const Study& study, std::span<const std::int32_t> nets,
                          Diagnostics& diagnostics) {
  Footprint footprint;
  std::vector<Ring> loose;
  const std::vector<BoardRings> boards = board_rings(board, study, loose, diagnostics);
  Box outlines;
  for (const BoardRings& rings : boards) outlines.add(geometry::bounds(rings.outer));
  const Box around = outlines.grown(study.air_around);
  const bool any_air = study.air_above > 0 || study.air_below > 0 || study.air_around > 0;

  footprint.box = study.region == RegionKind::whole ? around : region_box(board, study, nets, around, diagnostics);
  footprint.outer = outer_box(footprint.box, study);
  for (std::size_t side = 0; side < footprint.goes_on.size(); ++side)
    footprint.goes_on[side] =
        study.boundaries[side].kind == study::BoundaryKind::pml || study.boundaries[side].kind == study::BoundaryKind::periodic;
  const Box limit{{-max_coordinate_nm, -max_coordinate_nm}, {max_coordinate_nm, max_coordinate_nm}};
  if (!limit.contains(footprint.outer.min) || !limit.contains(footprint.outer.max))
    throw Error(ErrorCode::study_invalid,
                fmt::format("/air/around: the domain would reach beyond 1 m from the origin: {}", text_of(footprint.outer)));
  if (study.region == RegionKind::whole && !any_air)
    for (const BoardRings& rings : boards) footprint.domain.push_back(rings.outer);
  else
    footprint.domain.push_back(rectangle(footprint.outer));
  const bool is_polygon = study.region == RegionKind::polygon;
  if (is_polygon) {
    footprint.domain = {study.polygon};
    geometry::make_counter_clockwise(footprint.domain.front());
  }

  bool board_in_domain = false;
  for (const BoardRings& rings : boards) {
    std::vector<Ring> kept;
    Ring outer = footprint.cut(rings.outer);
    if (outer.empty()) continue;
    const Ring inside = clipped(rings.outer, footprint.box);
    board_in_domain = board_in_domain || (!inside.empty() && geometry::twice_area_nm2(inside) != 0 &&
                                          (!is_polygon || meets(inside, footprint.domain.front())));
    kept.push_back(std::move(outer));
    for (const Ring& cutout : rings.cutouts) {
      Ring inner = footprint.cut(cutout);
      if (inner.empty()) continue;
      std::reverse(inner.begin(), inner.end());
      kept.push_back(std::move(inner));
    }
    footprint.boards.push_back(std::move(kept));
  }
  if (!board_in_domain)
    throw Error(ErrorCode::region_empty, fmt::format("the region {} lies beside the board", text_of(footprint.box)),
                {.file = board.source()});
  for (Ring& ring : loose)
    if (Ring cut = footprint.cut(std::move(ring)); !cut.empty()) footprint.loose_cutouts.push_back(std::move(cut));
  return footprint;
}

}  // namespace pcbmesh::compose
