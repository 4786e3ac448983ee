// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "validation/checks/box_tree.hpp"
#include "validation/checks/checks.hpp"
#include "validation/checks/orientation.hpp"
#include "validation/checks/parallel.hpp"

namespace pcbmesh::validation::checks {
namespace {

/// A boundary face with its geometry at hand.
struct Patch {
  std::size_t n = 0;
  std::array<std::int64_t, 4> ids{};
  std::array<Vector3, 4> at{};
  Vector3 normal{};  ///< unit, outward; zero for a face of no area
  double area = 0;

  [[nodiscard]] bool has(std::int64_t id) const {
    return std::find(ids.begin(), ids.begin() + static_cast<std::ptrdiff_t>(n), id) !=
           ids.begin() + static_cast<std::ptrdiff_t>(n);
  }
};

Patch patch_of(const Context& context, std::int64_t half_face) {
  Patch patch;
  patch.n = static_cast<std::size_t>(context.corners_of_half_face(half_face, patch.ids));
  for (std::size_t i = 0; i < patch.n; ++i) patch.at[i] = context.mesh.nodes[static_cast<std::size_t>(patch.ids[i])];
  const Vector3 twice = patch.n == 3 ? cross(patch.at[1] - patch.at[0], patch.at[2] - patch.at[0])
                                     : cross(patch.at[2] - patch.at[0], patch.at[3] - patch.at[1]);
  const double size = length(twice);
  patch.area = 0.5 * size;
  if (size > 0) patch.normal = {twice[0] / size, twice[1] / size, twice[2] / size};
  return patch;
}

bool has_point(const Patch& patch, const Vector3& at, double tolerance) {
  for (std::size_t i = 0; i < patch.n; ++i) {
    if (length(patch.at[i] - at) <= tolerance) return true;
  }
  return false;
}

/// Distance of a point beyond edge i of the patch, in the patch's plane; positive outside.
double beyond_edge(const Patch& patch, std::size_t i, const Vector3& at) {
  const Vector3& a = patch.at[i];
  const Vector3 outward = cross(patch.at[i + 1 == patch.n ? 0 : i + 1] - a, patch.normal);
  const double size = length(outward);
  return size > 0 ? dot(at - a, outward) / size : 0;
}

bool is_on_edge(const Patch& patch, std::size_t i, const Vector3& at, double tolerance) {
  const Vector3& a = patch.at[i];
  const Vector3 edge = patch.at[i + 1 == patch.n ? 0 : i + 1] - a;
  const double along = dot(at - a, edge), size = dot(edge, edge);
  if (!(along > 0 && along < size)) return false;
  return length(cross(at - a, edge)) <= tolerance * std::sqrt(size);
}

/// The point lies on the patch but on none of its corners.
bool hangs_on(const Patch& patch, const Vector3& at, double tolerance) {
  if (has_point(patch, at, tolerance)) return false;
  for (std::size_t i = 0; i < patch.n; ++i) {
    if (is_on_edge(patch, i, at, tolerance)) return true;
  }
  if (patch.area == 0 || std::abs(dot(at - patch.at[0], patch.normal)) > tolerance) return false;
  for (std::size_t i = 0; i < patch.n; ++i) {
    if (beyond_edge(patch, i, at) > tolerance) return false;
  }
  return true;
}

/// Some edge of `patch` has all of `other` on its far side (separating axis of convex polygons in one plane).
bool is_separated(const Patch& patch, const Patch& other, double tolerance) {
  for (std::size_t i = 0; i < patch.n; ++i) {
    bool all_beyond = true;
    for (std::size_t k = 0; k < other.n && all_beyond; ++k) all_beyond = beyond_edge(patch, i, other.at[k]) >= -tolerance;
    if (all_beyond) return true;
  }
  return false;
}

/// Both lie in one plane and share more than an edge.
bool overlap(const Patch& f, const Patch& g, double tolerance) {
  if (f.area == 0 || g.area == 0) return false;
  const double cosine = dot(f.normal, g.normal);
  if (std::abs(cosine) < 0.5) return false;  // a cheap first look; the plane decides
  const Patch& large = f.area >= g.area ? f : g;
  const Patch& small = f.area >= g.area ? g : f;
  // The large face has the more trustworthy normal.
  for (std::size_t i = 0; i < small.n; ++i) {
    if (std::abs(dot(small.at[i] - large.at[0], large.normal)) > tolerance) return false;
  }
  if (cosine > 0) {
    // Neighbours on a flat side of the domain are the common case, and can overlap only if a cell is folded.
    for (std::size_t i = 0; i < f.n; ++i) {
      if (g.has(f.ids[i])) return false;
    }
  }
  return !is_separated(f, g, tolerance) && !is_separated(g, f, tolerance);
}

/// The segment goes through the plane of the triangle, and there through the triangle or an edge of it, but through no
/// corner: that is a hanging node. Exact.
bool goes_through(const Vector3& p, const Vector3& q, const Vector3& a, const Vector3& b, const Vector3& c) {
  if (orientation(a, b, c, p) * orientation(a, b, c, q) >= 0) return false;
  const int u = orientation(p, q, a, b), v = orientation(p, q, b, c), w = orientation(p, q, c, a);
  if (u * v < 0 || v * w < 0 || w * u < 0) return false;
  return (u == 0 ? 1 : 0) + (v == 0 ? 1 : 0) + (w == 0 ? 1 : 0) <= 1;
}

/// The same for a face. A quadrangle is a patch between its two ways to be split, and crossed where both are.
bool goes_through(const Vector3& p, const Vector3& q, const Patch& g) {
  const auto& at = g.at;
  if (g.n == 3) return goes_through(p, q, at[0], at[1], at[2]);
  return (goes_through(p, q, at[0], at[1], at[2]) || goes_through(p, q, at[0], at[2], at[3])) &&
         (goes_through(p, q, at[0], at[1], at[3]) || goes_through(p, q, at[1], at[2], at[3]));
}

/// Too thin for its normal to be trusted to the tolerance over the length of a face.
bool is_needle(const Patch& patch) {
  double longest = 0;
  for (std::size_t i = 0; i < patch.n; ++i)
    longest = std::max(longest, length(patch.at[i + 1 == patch.n ? 0 : i + 1] - patch.at[i]));
  return 2 * patch.area < 1e-6 * longest * longest;
}

/// Some edge of `f` that meets `g` at no corner goes through `g` or touches an edge of it, however little. Edges that end
/// within the tolerance of `g` are left to node.hanging and the other codes of near misses.
bool cuts_through(const Patch& f, const Patch& g, double tolerance) {
  if (g.area == 0) return false;
  std::array<double, 4> height{};
  bool above = false, below = false;
  for (std::size_t i = 0; i < f.n; ++i) {
    height[i] = dot(f.at[i] - g.at[0], g.normal);
    above = above || height[i] > tolerance;
    below = below || height[i] < -tolerance;
  }
  const bool is_flat = g.n == 3 || std::abs(dot(g.at[2] - g.at[0], g.normal)) <= 0.5 * tolerance;
  const bool is_trusted = is_flat && !is_needle(g);
  if (is_trusted && (!above || !below)) return false;
  for (std::size_t i = 0; i < f.n; ++i) {
    const std::size_t k = i + 1 == f.n ? 0 : i + 1;
    if (is_trusted && (std::min(height[i], height[k]) >= -tolerance || std::max(height[i], height[k]) <= tolerance)) continue;
    if (g.has(f.ids[i]) || g.has(f.ids[k]) || !goes_through(f.at[i], f.at[k], g)) continue;
    const auto ends_on = [&](const Vector3& at) { return has_point(g, at, tolerance) || hangs_on(g, at, tolerance); };
    if (!ends_on(f.at[i]) && !ends_on(f.at[k])) return true;
  }
  return false;
}

bool all_points_on(const Patch& patch, const Patch& other, double tolerance) {
  for (std::size_t i = 0; i < patch.n; ++i) {
    if (!other.has(patch.ids[i]) && !has_point(other, patch.at[i], tolerance)) return false;
  }
  return true;
}

struct OverlapTallies {
  Tally crack, quad_on_triangles, other, crossing, not_searched;
  std::vector<std::int64_t> hanging;
};

bool contains(const Box& box, const Vector3& at) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (at[axis] < double{box.low[axis]} || at[axis] > double{box.high[axis]}) return false;
  }
  return true;
}

/// The boxes are wider than the faces by the tolerance.
void judge_pair(const Context& context, std::int64_t id, const Patch& f, const Box& box_f, const Patch& g, const Box& box_g,
                OverlapTallies& tallies) {
  const double tolerance = context.tolerance;
  for (std::size_t i = 0; i < f.n; ++i) {
    if (!g.has(f.ids[i]) && contains(box_g, f.at[i]) && hangs_on(g, f.at[i], tolerance)) tallies.hanging.push_back(f.ids[i]);
  }
  for (std::size_t i = 0; i < g.n; ++i) {
    if (!f.has(g.ids[i]) && contains(box_f, g.at[i]) && hangs_on(f, g.at[i], tolerance)) tallies.hanging.push_back(g.ids[i]);
  }
  if (!overlap(f, g, tolerance)) {
    if (cuts_through(f, g, tolerance) || cuts_through(g, f, tolerance)) tallies.crossing.add(id);
    return;
  }
  if (f.n == g.n && all_points_on(f, g, tolerance)) {
    tallies.crack.add(id);
  } else if (f.n != g.n && all_points_on(f.n == 3 ? f : g, f.n == 3 ? g : f, tolerance)) {
    tallies.quad_on_triangles.add(id);
  } else {
    tallies.other.add(id);
  }
}

/// Faces that lie in a side of the bounding box can't touch anything beyond it, and are most of a boundary.
bool lies_on_bounding_box(const Context& context, const Patch& patch) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const double side : {context.low[axis], context.high[axis]}) {
      bool on_side = true;
      for (std::size_t i = 0; i < patch.n; ++i) on_side = on_side && patch.at[i][axis] == side;
      if (on_side) return true;
    }
  }
  return false;
}

Box box_around(const Patch& patch, double margin) {
  Box box;
  for (std::size_t i = 0; i < patch.n; ++i) box.add(patch.at[i], margin);
  return box;
}

/// Searches faces [first, last) against all later ones.
void search_slice(const Context& context, const std::vector<std::int64_t>& faces, std::span<const Box> boxes,
                  const BoxTree& tree, std::int64_t first, std::int64_t last, OverlapTallies& tallies) {
  // Faces of a mesh meet a few dozen others; a heap of garbage meets everything, and must not take its square.
  constexpr std::int64_t looks_per_pair = 20;  // comparing two faces takes about as long as looking at this many boxes
  std::int64_t budget = std::max<std::int64_t>(1'000'000, 2000 * (last - first));
  for (std::int64_t i = first; i < last; ++i) {
    const auto here = static_cast<std::size_t>(i);
    const Patch patch = patch_of(context, faces[here]);
    if (budget > 0) {
      budget -= tree.each_meeting(boxes[here], [&](std::size_t there) {
        if (there <= here) return true;
        judge_pair(context, std::min(faces[here], faces[there]), patch, boxes[here], patch_of(context, faces[there]),
                   boxes[there], tallies);
        budget -= looks_per_pair;
        return budget > 0;
      });
    }
    if (budget <= 0) tallies.not_searched.add(faces[here]);
  }
}

Tally tally_of_nodes(std::vector<std::int64_t>& nodes) {
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  Tally tally;
  for (const std::int64_t node : nodes) tally.add(node);
  return tally;
}

void report_overlaps(OverlapTallies& all, std::int64_t num_faces, CheckLog& log) {
  const Tally hanging = tally_of_nodes(all.hanging);
  log.found("node.hanging", FindingSeverity::error,
            fmt::format("{} nodes lie inside an edge or a face of the boundary without being its corner", hanging.count()),
            hanging, PlaceKind::node);
  log.found("boundary.crack", FindingSeverity::error,
            fmt::format("{} pairs of boundary faces lie on each other with the same corner points: cells that should share "
                        "nodes do not",
                        all.crack.count()),
            all.crack, PlaceKind::half_face);
  log.found("boundary.quad_on_triangles", FindingSeverity::error,
            fmt::format("{} times a quadrangle meets a triangle over the same corners", all.quad_on_triangles.count()),
            all.quad_on_triangles, PlaceKind::half_face);
  log.found("boundary.overlap", FindingSeverity::error,
            fmt::format("{} pairs of boundary faces overlap: neighbours do not share whole faces", all.other.count()),
            all.other, PlaceKind::half_face);
  log.found("boundary.crossing",
            fmt::format("{} pairs of boundary faces cut through each other, or meet at edges without a common node",
                        all.crossing.count()),
            all.crossing, PlaceKind::half_face);
  log.found("boundary.not_searched", FindingSeverity::warning,
            fmt::format("{} of {} boundary faces were not compared with others: too many lie on top of each other",
                        all.not_searched.count(), num_faces),
            all.not_searched, PlaceKind::half_face);
}

}  // namespace

void check_boundary_overlaps(const Context& context, const FaceMatch& match, Report& report) {
  CheckLog log(report, context, "boundary overlaps");
  std::vector<std::int64_t> faces;
  for (const std::int64_t half_face : match.boundary) {
    if (!lies_on_bounding_box(context, patch_of(context, half_face))) faces.push_back(half_face);
  }
  const auto num_faces = static_cast<std::int64_t>(faces.size());
  log.examined(num_faces);
  if (num_faces >= std::numeric_limits<std::int32_t>::max()) {
    log.found("boundary.not_searched", FindingSeverity::warning,
              fmt::format("{} boundary faces are too many to compare", num_faces), num_faces);
    return;
  }
  std::vector<Box> boxes(faces.size());
  for_each_slice(context.num_threads, num_faces, [&](int, std::int64_t, std::int64_t first, std::int64_t last) {
    for (auto i = static_cast<std::size_t>(first); i < static_cast<std::size_t>(last); ++i) {
      boxes[i] = box_around(patch_of(context, faces[i]), context.tolerance);
    }
  });
  const BoxTree tree(boxes);
  constexpr std::int64_t faces_per_task = 4096;
  std::vector<OverlapTallies> tallies(static_cast<std::size_t>(context.num_threads));
  for_each_task(context.num_threads, (num_faces + faces_per_task - 1) / faces_per_task, [&](int worker, std::int64_t task) {
    search_slice(context, faces, boxes, tree, task * faces_per_task, std::min(num_faces, (task + 1) * faces_per_task),
                 tallies[static_cast<std::size_t>(worker)]);
  });
  OverlapTallies all;
  for (OverlapTallies& mine : tallies) {
    all.crack.merge(mine.crack);
    all.quad_on_triangles.merge(mine.quad_on_triangles);
    all.other.merge(mine.other);
    all.crossing.merge(mine.crossing);
    all.not_searched.merge(mine.not_searched);
    all.hanging.insert(all.hanging.end(), mine.hanging.begin(), mine.hanging.end());
  }
  report_overlaps(all, num_faces, log);
}

}  // namespace pcbmesh::validation::checks
