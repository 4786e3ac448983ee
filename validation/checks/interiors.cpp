// SPDX-License-Identifier: GPL-3.0-or-later
// Do the interiors of cells overlap that share neither nodes nor faces?
//
// Where all cells are positive and all faces match, the inner faces cancel: the winding number of the boundary round a
// point is the number of cells that cover it. So it is enough to look at the boundary. Cells that overlap are bounded by
// faces whose inner side is covered twice, and either such a face lies there as a whole, which the samples below see, or
// another face cuts it, which boundary.crossing and boundary.overlap see.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "validation/checks/box_tree.hpp"
#include "validation/checks/cell_shapes.hpp"
#include "validation/checks/checks.hpp"
#include "validation/checks/orientation.hpp"
#include "validation/checks/parallel.hpp"

namespace pcbmesh::validation::checks {
namespace {

struct Triangle {
  Vector3 a, b, c;
};

/// A face of a cell as one or two triangles, counter-clockwise from outside.
int triangles_of(const Context& context, std::int64_t half_face, std::array<Triangle, 2>& out) {
  std::array<std::int64_t, 4> ids{};
  const int n = context.corners_of_half_face(half_face, ids);
  const auto at = [&](std::size_t i) -> const Vector3& { return context.mesh.nodes[static_cast<std::size_t>(ids[i])]; };
  out[0] = {at(0), at(1), at(2)};
  if (n == 3) return 1;
  out[1] = {at(0), at(2), at(3)};
  return 2;
}

/// +1 or -1 for a ray that leaves or enters through the triangle, 0 for a miss, nothing if it meets an edge or corner of it
/// or starts on it. Exact.
std::optional<int> crossing_of(const Triangle& t, const Vector3& from, const Vector3& to) {
  const int u = orientation(from, to, t.a, t.b), v = orientation(from, to, t.b, t.c);
  if (u * v < 0) return 0;
  const int w = orientation(from, to, t.c, t.a);
  if (u * w < 0 || v * w < 0) return 0;
  if (u == 0 || v == 0 || w == 0) return std::nullopt;
  const int start = orientation(t.a, t.b, t.c, from), end = orientation(t.a, t.b, t.c, to);
  if (start == 0 || end == 0) return std::nullopt;
  return start == end ? 0 : end;
}

class Windings {
 public:
  Windings(const Context& context, std::span<const std::int64_t> faces, std::span<const Box> boxes)
      : context_(context), faces_(faces), tree_(boxes) {}

  /// Number of times the boundary goes round the point; nothing if no ray gives a clear answer.
  [[nodiscard]] std::optional<int> at(const Vector3& point) const {
    // Boards are flat, so rays go up, and off every axis: layouts are full of straight walls.
    constexpr double slopes[][2] = {{0.0137, 0.0251}, {-0.0293, 0.0171}, {0.0407, -0.0319}, {-0.0523, -0.0613}, {0.231, 0.179}};
    for (const auto& slope : slopes) {
      if (const auto winding = along_ray(point, slope)) return winding;
    }
    return std::nullopt;
  }

 private:
  [[nodiscard]] std::optional<int> along_ray(const Vector3& point, const double (&slope)[2]) const {
    const double rise = 1.01 * (context_.high[2] - point[2]) + context_.tolerance;
    const Vector3 to{point[0] + slope[0] * rise, point[1] + slope[1] * rise, point[2] + rise};
    Box box;
    box.add(point);
    box.add(to);
    int winding = 0;
    bool clear = true;
    std::array<Triangle, 2> triangles;
    tree_.each_meeting(box, [&](std::size_t i) {
      const int n = triangles_of(context_, faces_[i], triangles);
      for (int k = 0; k < n && clear; ++k) {
        const auto crossing = crossing_of(triangles[static_cast<std::size_t>(k)], point, to);
        clear = crossing.has_value();
        winding += crossing.value_or(0);
      }
      return clear;
    });
    return clear ? std::optional(winding) : std::nullopt;
  }

  const Context& context_;
  std::span<const std::int64_t> faces_;
  BoxTree tree_;
};

Vector3 centre_of(const Context& context, std::span<const std::int64_t> corners) {
  Vector3 sum{};
  for (const std::int64_t corner : corners) {
    for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += context.mesh.nodes[static_cast<std::size_t>(corner)][axis];
  }
  for (double& x : sum) x /= static_cast<double>(corners.size());
  return sum;
}

/// Behind the face itself in both its triangles, behind every other face of its cell in one at least: those may be bent.
bool is_inside_cell(const Context& context, std::int64_t half_face, const Vector3& at) {
  const std::int64_t cell = half_face >> 3;
  const auto num_faces = faces_of(context.mesh.cells[context.locate_cell(cell).first].kind).size();
  std::array<Triangle, 2> triangles;
  for (std::size_t face = 0; face < num_faces; ++face) {
    const std::int64_t here = cell << 3 | static_cast<std::int64_t>(face);
    const int n = triangles_of(context, here, triangles);
    int behind = 0;
    for (int k = 0; k < n; ++k) {
      const Triangle& t = triangles[static_cast<std::size_t>(k)];
      behind += orientation(t.a, t.b, t.c, at) < 0 ? 1 : 0;
    }
    if (behind < (here == half_face ? n : 1)) return false;
  }
  return true;
}

/// How often space is filled close behind the middle of a face; nothing if it can't be told.
std::optional<int> winding_behind(const Context& context, const Windings& windings, std::int64_t half_face) {
  std::array<std::int64_t, 4> ids{};
  const auto n = static_cast<std::size_t>(context.corners_of_half_face(half_face, ids));
  const Vector3 middle = centre_of(context, context.corners_of_cell(half_face >> 3));
  const Vector3 face = centre_of(context, std::span(ids).first(n));
  // A bent face may bulge beyond the first, and either may lie on a face of another cell; the last is the middle of the cell.
  for (const double depth : {0.05, 0.31, 1.0}) {
    Vector3 at = face;
    for (std::size_t axis = 0; axis < 3; ++axis) at[axis] += depth * (middle[axis] - face[axis]);
    if (!is_inside_cell(context, half_face, at)) continue;
    if (const auto winding = windings.at(at)) return winding;
  }
  return std::nullopt;
}

Box box_of(const Context& context, std::int64_t half_face) {
  std::array<std::int64_t, 4> ids{};
  const auto n = static_cast<std::size_t>(context.corners_of_half_face(half_face, ids));
  Box box;
  for (std::size_t i = 0; i < n; ++i) box.add(context.mesh.nodes[static_cast<std::size_t>(ids[i])], context.tolerance);
  return box;
}

}  // namespace

void check_interiors(const Context& context, const FaceMatch& match, const VolumeSums& sums, Report& report) {
  CheckLog log(report, context, "interiors");
  const bool reliable = sums.all_positive && match.many_owners.count() == 0 && match.same_orientation.count() == 0;
  const auto num_faces = static_cast<std::int64_t>(match.boundary.size());
  if (!reliable || num_faces == 0 || num_faces >= std::numeric_limits<std::int32_t>::max()) return;
  std::vector<Box> boxes(match.boundary.size());
  for_each_slice(context.num_threads, num_faces, [&](int, std::int64_t, std::int64_t first, std::int64_t last) {
    for (auto i = static_cast<std::size_t>(first); i < static_cast<std::size_t>(last); ++i) {
      boxes[i] = box_of(context, match.boundary[i]);
    }
  });
  const Windings windings(context, match.boundary, boxes);
  // Overlaps smaller than a few faces are cut by other faces, and found there; samples are for those that are not.
  constexpr std::int64_t max_samples = 200'000, samples_per_task = 512;
  const std::int64_t stride = std::max<std::int64_t>(1, (num_faces + max_samples - 1) / max_samples);
  const std::int64_t num_samples = (num_faces + stride - 1) / stride;
  struct Tallies {
    Tally covered, unknown;
  };
  std::vector<Tallies> tallies(static_cast<std::size_t>(context.num_threads));
  for_each_task(context.num_threads, (num_samples + samples_per_task - 1) / samples_per_task,
                [&](int worker, std::int64_t task) {
                  const std::int64_t end = std::min(num_samples, (task + 1) * samples_per_task);
                  for (std::int64_t i = task * samples_per_task; i < end; ++i) {
                    const std::int64_t half_face = match.boundary[static_cast<std::size_t>(i * stride)];
                    const auto winding = winding_behind(context, windings, half_face);
                    Tallies& mine = tallies[static_cast<std::size_t>(worker)];
                    if (!winding) mine.unknown.add(half_face >> 3);
                    if (winding.value_or(1) > 1) mine.covered.add(half_face >> 3);
                  }
                });
  Tally all, unknown;
  for (const Tallies& mine : tallies) {
    all.merge(mine.covered);
    unknown.merge(mine.unknown);
  }
  log.examined(num_samples);
  log.found("cell.overlap",
            fmt::format("behind {} of {} boundary faces space is filled more than once: cells lie inside other cells",
                        all.count(), num_samples),
            all, PlaceKind::cell);
  log.found(
      "cell.overlap_unknown",
      fmt::format("behind {} of {} boundary faces it can't be told whether space is filled more than once: the cell is so "
                  "thin or so bent that its middle is not surely inside",
                  unknown.count(), num_samples),
      unknown, PlaceKind::cell);
}

}  // namespace pcbmesh::validation::checks
