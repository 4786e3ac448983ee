// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "validation/checks/cell_geometry.hpp"
#include "validation/checks/checks.hpp"
#include "validation/checks/parallel.hpp"

namespace pcbmesh::validation::checks {

double HeightGrowth::height_over(std::int64_t half_face) const {
  const auto [b, index] = context_.locate_cell(half_face >> 3);
  const mesh::CellBlock& block = context_.mesh.cells[b];
  const auto local = static_cast<std::size_t>(half_face & 7);
  const auto height = [&]<mesh::CellKind kind>() {
    const std::array<Vector3, 8> at = points_of<kind>(context_, block, static_cast<std::size_t>(index));
    return 2 * volume_of<kind>(at) / length(twice_area_of<kind>(at, faces_of<kind>()[local]));
  };
  if (block.kind == mesh::CellKind::wedge && local < 2) return height.template operator()<mesh::CellKind::wedge>();
  if (block.kind == mesh::CellKind::hexahedron) return height.template operator()<mesh::CellKind::hexahedron>();
  return 0;
}

namespace {

/// Without a limit, what is bent more than this is told as a warning.
constexpr double usual_max_warp = 1e-3;

/// An edge of a cell and the two faces that meet there.
struct CellEdge {
  std::size_t a = 0, b = 0, face = 0, other = 0;
};

template <mesh::CellKind kind>
constexpr std::size_t num_edges() {
  std::size_t corners = 0;
  for (const LocalFace& face : faces_of<kind>()) corners += static_cast<std::size_t>(face.num_corners);
  return corners / 2;
}

/// Each edge runs once one way and once the other way round the faces.
template <mesh::CellKind kind>
constexpr auto edges_of() {
  std::array<CellEdge, num_edges<kind>()> edges{};
  std::size_t count = 0;
  const auto& faces = faces_of<kind>();
  const auto each = [&](auto&& visit) {
    for (std::size_t f = 0; f < faces.size(); ++f) {
      const auto n = static_cast<std::size_t>(faces[f].num_corners);
      for (std::size_t i = 0; i < n; ++i) {
        visit(f, static_cast<std::size_t>(faces[f].corners[i]),
              static_cast<std::size_t>(faces[f].corners[i + 1 == n ? 0 : i + 1]));
      }
    }
  };
  each([&](std::size_t f, std::size_t a, std::size_t b) {
    if (a < b) edges[count++] = {a, b, f, 0};
  });
  each([&](std::size_t f, std::size_t a, std::size_t b) {
    for (CellEdge& edge : edges) {
      if (edge.a == b && edge.b == a) edge.other = f;
    }
  });
  return edges;
}

double cosine_between(const Vector3& a, const Vector3& b) {
  const double size = std::sqrt(dot(a, a) * dot(b, b));
  return size > 0 ? dot(a, b) / size : 1;
}

/// Distance between the diagonals of a quadrangle over the longer of them, squared.
template <mesh::CellKind kind>
double squared_warp(const std::array<Vector3, 8>& at) {
  double worst = 0;
  for (const LocalFace& face : faces_of<kind>()) {
    if (face.num_corners == 3) continue;
    const auto point = [&](std::size_t i) -> const Vector3& { return at[static_cast<std::size_t>(face.corners[i])]; };
    const Vector3 p = point(2) - point(0), q = point(3) - point(1), normal = cross(p, q);
    const double gap = dot(point(1) - point(0), normal), size = dot(normal, normal);
    if (size > 0) worst = std::max(worst, gap * gap / (size * std::max(dot(p, p), dot(q, q))));
  }
  return worst;
}

/// What the limits but warp and growth look at.
struct Shape {
  double max_face_cosine = -1;  ///< of the smallest angle in a face
  double max_dihedral_cosine = -1, min_dihedral_cosine = 1;
  double shortest_edge2 = 0, longest_edge2 = 0;
  double scaled_jacobian = 0;
  double prism_quality = 1;
};

template <mesh::CellKind kind>
double scaled_jacobian_of(const std::array<Vector3, 8>& at) {
  if constexpr (kind == mesh::CellKind::tetrahedron) {
    const double six = triple(at[1] - at[0], at[2] - at[0], at[3] - at[0]);
    double largest = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      double product = 1;
      for (std::size_t k = 0; k < 4; ++k) product *= i == k ? 1 : length(at[k] - at[i]);
      largest = std::max(largest, product);
    }
    return largest > 0 ? std::numbers::sqrt2 * six / largest : 0;
  } else {
    constexpr double regular = kind == mesh::CellKind::wedge     ? 2 / std::numbers::sqrt3
                               : kind == mesh::CellKind::pyramid ? std::numbers::sqrt2
                                                                 : 1.0;
    double smallest = std::numeric_limits<double>::max();
    for (const CornerFrame& frame : frames_of<kind>()) {
      const auto edge = [&](int to) { return at[static_cast<std::size_t>(to)] - at[static_cast<std::size_t>(frame.at)]; };
      const Vector3 a = edge(frame.e1), b = edge(frame.e2), c = edge(frame.e3);
      const double size = std::sqrt(dot(a, a) * dot(b, b) * dot(c, c));
      smallest = std::min(smallest, size > 0 ? triple(a, b, c) / size : 0);
    }
    return regular * smallest;
  }
}

/// q_p = 32/sqrt(3) V / (a^2 + b^2 + c^2 + h^2)^(3/2); a slanted prism counts with the means of its two bases and three
/// heights.
double prism_quality_of(const std::array<Vector3, 8>& at) {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t k = (i + 1) % 3;
    const Vector3 low = at[k] - at[i], high = at[k + 3] - at[i + 3], up = at[i + 3] - at[i];
    sum += 0.5 * (dot(low, low) + dot(high, high)) + dot(up, up) / 3;
  }
  return sum > 0 ? 32 * std::numbers::inv_sqrt3 * volume_of<mesh::CellKind::wedge>(at) / (sum * std::sqrt(sum)) : 0;
}

template <mesh::CellKind kind>
Shape shape_of(const std::array<Vector3, 8>& at) {
  Shape shape;
  constexpr auto edges = edges_of<kind>();
  const auto& faces = faces_of<kind>();
  std::array<Vector3, 6> normals{};
  for (std::size_t f = 0; f < faces.size(); ++f) {
    normals[f] = twice_area_of<kind>(at, faces[f]);
    const auto n = static_cast<std::size_t>(faces[f].num_corners);
    const auto point = [&](std::size_t i) -> const Vector3& { return at[static_cast<std::size_t>(faces[f].corners[i % n])]; };
    for (std::size_t i = 0; i < n; ++i) {
      shape.max_face_cosine =
          std::max(shape.max_face_cosine, cosine_between(point(i + 1) - point(i), point(i + n - 1) - point(i)));
    }
  }
  shape.shortest_edge2 = std::numeric_limits<double>::max();
  for (const CellEdge& edge : edges) {
    const Vector3 along = at[edge.b] - at[edge.a];
    const double size = dot(along, along);
    shape.shortest_edge2 = std::min(shape.shortest_edge2, size);
    shape.longest_edge2 = std::max(shape.longest_edge2, size);
    // Outward normals that point the same way belong to a flat angle.
    const double cosine = -cosine_between(normals[edge.face], normals[edge.other]);
    shape.max_dihedral_cosine = std::max(shape.max_dihedral_cosine, cosine);
    shape.min_dihedral_cosine = std::min(shape.min_dihedral_cosine, cosine);
  }
  shape.scaled_jacobian = scaled_jacobian_of<kind>(at);
  if constexpr (kind == mesh::CellKind::wedge) shape.prism_quality = prism_quality_of(at);
  return shape;
}

/// One measure beside its limit. The worst value is kept for the text.
struct Bound {
  const Limit* limit = nullptr;
  const char* code = "";
  const char* what = "";
  bool at_most = false;
};

struct BoundTally {
  Tally beyond;
  double worst = 0;
  bool is_set = false;
  void look(const Bound& bound, double value, std::int64_t cell) {
    // A limit given as 2 must bear the 2.0000000000000004 that rounding makes of a mesh that was made for it.
    constexpr double slack = 1e-9;
    const double limit = bound.limit->value * (bound.at_most ? 1 + slack : 1 - slack);
    if (!(bound.at_most ? value > limit : value < limit)) return;
    beyond.add(cell);
    if (!is_set || (bound.at_most ? value > worst : value < worst)) worst = value;
    is_set = true;
  }
  void merge(const Bound& bound, const BoundTally& other) {
    beyond.merge(other.beyond);
    if (other.is_set && (!is_set || (bound.at_most ? other.worst > worst : other.worst < worst))) worst = other.worst;
    is_set = is_set || other.is_set;
  }
};

enum Measure : std::size_t { face_angle, small_dihedral, large_dihedral, aspect, edge, jacobian, quality, num_measures };
using Bounds = std::array<Bound, num_measures>;
using BoundTallies = std::array<BoundTally, num_measures>;

Bounds bounds_of(const Limits& limits) {
  const auto at = [](const std::optional<Limit>& limit) { return limit ? &*limit : nullptr; };
  return {{{at(limits.min_face_angle_deg), "limit.needle", "degrees is the smallest angle of a face", false},
           {at(limits.min_dihedral_deg), "limit.sliver", "degrees is the smallest angle between faces", false},
           {at(limits.max_dihedral_deg), "limit.sliver", "degrees is the largest angle between faces", true},
           {at(limits.max_aspect_ratio), "limit.aspect", "is the longest edge over the shortest", true},
           {at(limits.min_edge_m), "limit.edge", "m is the shortest edge", false},
           {at(limits.min_scaled_jacobian), "limit.jacobian", "is the smallest scaled Jacobian", false},
           {at(limits.min_prism_quality), "limit.quality", "is the smallest prism quality", false}}};
}

double degrees(double cosine) {
  return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::numbers::pi;
}

template <mesh::CellKind kind>
void judge_shape(const Bounds& bounds, const std::array<Vector3, 8>& at, std::int64_t cell, double unit_m, BoundTallies& out) {
  const Shape shape = shape_of<kind>(at);
  const auto look = [&](Measure measure, double value) {
    if (bounds[measure].limit != nullptr) out[measure].look(bounds[measure], value, cell);
  };
  look(face_angle, degrees(shape.max_face_cosine));
  look(small_dihedral, degrees(shape.max_dihedral_cosine));
  look(large_dihedral, degrees(shape.min_dihedral_cosine));
  look(aspect, std::sqrt(shape.longest_edge2 / shape.shortest_edge2));
  look(edge, std::sqrt(shape.shortest_edge2) * unit_m);
  look(jacobian, shape.scaled_jacobian);
  if (kind == mesh::CellKind::wedge) look(quality, shape.prism_quality);
}

struct ShapeTallies {
  BoundTallies of_bound;
  Tally bent;
  double worst_warp2 = 0;
};

void report_shapes(const Context& context, const Bounds& bounds, const ShapeTallies& all, CheckLog& log) {
  const double max_warp = context.limits.max_warp ? context.limits.max_warp->value : usual_max_warp;
  log.found("face.not_planar", context.limits.max_warp ? context.limits.max_warp->severity : FindingSeverity::warning,
            fmt::format("{} cells have a quadrangle that is not flat: its diagonals miss each other by up to {:.3g} of their "
                        "length, limit {:.3g}",
                        all.bent.count(), std::sqrt(all.worst_warp2), max_warp),
            all.bent, PlaceKind::cell);
  for (std::size_t m = 0; m < num_measures; ++m) {
    const BoundTally& tally = all.of_bound[m];
    if (bounds[m].limit == nullptr) continue;
    log.found(bounds[m].code, bounds[m].limit->severity,
              fmt::format("{} cells are beyond the limit {:.4g}: {:.4g} {}", tally.beyond.count(), bounds[m].limit->value,
                          tally.worst, bounds[m].what),
              tally.beyond, PlaceKind::cell);
  }
}

}  // namespace

void check_limits(const Context& context, const HeightGrowth& growth, Report& report) {
  CheckLog log(report, context, "limits");
  const Bounds bounds = bounds_of(context.limits);
  const bool has_bounds = std::ranges::any_of(bounds, [](const Bound& bound) { return bound.limit != nullptr; });
  const double max_warp = context.limits.max_warp ? context.limits.max_warp->value : usual_max_warp;
  ShapeTallies all;
  for (std::size_t b = 0; b < context.mesh.cells.size(); ++b) {
    const mesh::CellBlock& block = context.mesh.cells[b];
    if (!has_bounds && block.kind == mesh::CellKind::tetrahedron) continue;
    std::vector<ShapeTallies> tallies(static_cast<std::size_t>(context.num_threads));
    for_each_slice(context.num_threads, block.size(), [&](int worker, std::int64_t, std::int64_t begin, std::int64_t end) {
      ShapeTallies& mine = tallies[static_cast<std::size_t>(worker)];
      with_kind(block.kind, [&]<mesh::CellKind kind>() {
        for (std::int64_t i = begin; i < end; ++i) {
          const std::array<Vector3, 8> at = points_of<kind>(context, block, static_cast<std::size_t>(i));
          const std::int64_t cell = context.first_cell[b] + i;
          if (const double warp2 = squared_warp<kind>(at); warp2 > max_warp * max_warp) {
            mine.bent.add(cell);
            mine.worst_warp2 = std::max(mine.worst_warp2, warp2);
          }
          if (has_bounds) judge_shape<kind>(bounds, at, cell, context.unit_m(), mine.of_bound);
        }
      });
    });
    for (const ShapeTallies& mine : tallies) {
      all.bent.merge(mine.bent);
      all.worst_warp2 = std::max(all.worst_warp2, mine.worst_warp2);
      for (std::size_t m = 0; m < num_measures; ++m) all.of_bound[m].merge(bounds[m], mine.of_bound[m]);
    }
  }
  log.examined(context.num_cells());
  report_shapes(context, bounds, all, log);
  if (!growth.is_needed()) return;
  const Tally beyond = growth.beyond();
  log.found("limit.growth", context.limits.max_height_growth->severity,
            fmt::format("heights on both sides of {} faces differ by more than {:.4g} times, at most {:.4g} times",
                        beyond.count(), context.limits.max_height_growth->value, growth.largest()),
            beyond, PlaceKind::half_face);
}

}  // namespace pcbmesh::validation::checks
