// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/extrude/arc_edges.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>
#include <utility>

#include "pcbmesh/extrude/tetrahedral_source.hpp"

namespace pcbmesh::extrude {
namespace {

using Vector2 = std::array<double, 2>;
using Vector3 = std::array<double, 3>;

/// Corners are whole nanometres: an end of a chord is off its circle by the rounding alone, or by what snapping moved it.
constexpr double rounding_m = 2e-9;
constexpr double part_of_sagitta = 0.1;
/// Simplification drops corners that change the outline by little: chords may be somewhat longer than they were cut.
constexpr double longest_over_given = 2.0;
/// Least Jacobian that is accepted, over that of the straight element.
constexpr double least_jacobian = 0.1;

double distance(const Vector2& a, const Vector2& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1]);
}

/// Circles by the squares of a grid that their circumferences cross.
class CircleGrid {
 public:
  CircleGrid(std::span<const Circle> circles, double square_m) : circles_(circles), square_(square_m) {
    for (std::size_t i = 0; i < circles.size(); ++i) {
      const double around = 2 * std::numbers::pi * circles[i].radius_m;
      const auto steps = static_cast<int>(std::clamp(std::ceil(4 * around / square_m), 8.0, 1e6));
      Square last{};
      for (int k = 0; k < steps; ++k) {
        const double angle = 2 * std::numbers::pi * k / steps;
        const Square at = square_of({circles[i].centre_m[0] + circles[i].radius_m * std::cos(angle),
                                     circles[i].centre_m[1] + circles[i].radius_m * std::sin(angle)});
        if (k == 0 || at != last) entries_.emplace_back(at, static_cast<std::int32_t>(i));
        last = at;
      }
    }
    std::sort(entries_.begin(), entries_.end());
    entries_.erase(std::unique(entries_.begin(), entries_.end()), entries_.end());
  }
  /// Calls visit(circle) for every circle that may pass close to a point; perhaps more than once.
  template <class Visit>
  void near(const Vector2& at, Visit&& visit) const {
    const Square centre = square_of(at);
    for (std::int64_t x = centre.first - 1; x <= centre.first + 1; ++x) {
      const std::pair low{Square{x, centre.second - 1}, std::int32_t{-1}};
      for (auto it = std::lower_bound(entries_.begin(), entries_.end(), low);
           it != entries_.end() && it->first.first == x && it->first.second <= centre.second + 1; ++it)
        visit(circles_[static_cast<std::size_t>(it->second)]);
    }
  }

 private:
  using Square = std::pair<std::int64_t, std::int64_t>;
  [[nodiscard]] Square square_of(const Vector2& at) const {
    return {static_cast<std::int64_t>(std::floor(at[0] / square_)), static_cast<std::int64_t>(std::floor(at[1] / square_))};
  }
  std::span<const Circle> circles_;
  double square_;
  std::vector<std::pair<Square, std::int32_t>> entries_;
};

/// Corners 0 1 2 and middles of 01, 02, 12.
struct Triangle6 {
  std::array<Vector2, 3> corners;
  std::array<Vector2, 3> middles;
};

/// Least Bezier coefficient of the Jacobian: a bound from below everywhere in the triangle. The straight one is twice the area.
double least_bezier(const Triangle6& t) {
  // x = sum of shapes; with l0, l1, l2 the area coordinates: dx/dl1 - dx/dl0 and dx/dl2 - dx/dl0 at a point.
  const auto jacobian = [&](double l0, double l1, double l2) {
    const auto slope = [&](int along) {  // derivative along the edge from corner 0 to corner `along`
      Vector2 sum{};
      for (std::size_t i = 0; i < 2; ++i) {
        const double d0 = (4 * l0 - 1) * t.corners[0][i] + 4 * l1 * t.middles[0][i] + 4 * l2 * t.middles[1][i];
        const double d1 = (4 * l1 - 1) * t.corners[1][i] + 4 * l0 * t.middles[0][i] + 4 * l2 * t.middles[2][i];
        const double d2 = (4 * l2 - 1) * t.corners[2][i] + 4 * l0 * t.middles[1][i] + 4 * l1 * t.middles[2][i];
        sum[i] = (along == 1 ? d1 : d2) - d0;
      }
      return sum;
    };
    const Vector2 u = slope(1), v = slope(2);
    return u[0] * v[1] - u[1] * v[0];
  };
  const double j0 = jacobian(1, 0, 0), j1 = jacobian(0, 1, 0), j2 = jacobian(0, 0, 1);
  const double b01 = 2 * jacobian(0.5, 0.5, 0) - (j0 + j1) / 2, b02 = 2 * jacobian(0.5, 0, 0.5) - (j0 + j2) / 2,
               b12 = 2 * jacobian(0, 0.5, 0.5) - (j1 + j2) / 2;
  return std::min({j0, j1, j2, b01, b02, b12});
}

double straight_jacobian(const Triangle6& t) {
  const auto& [a, b, c] = t.corners;
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// Jacobian of a tetrahedron of ten nodes at a point, divided by nothing.
double jacobian_at(const std::array<Vector3, 10>& x, const std::array<double, 4>& l) {
  constexpr int edges[6][2] = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {2, 3}, {1, 3}};
  std::array<Vector3, 4> d{};  // derivative by each area coordinate
  for (std::size_t c = 0; c < 4; ++c)
    for (std::size_t i = 0; i < 3; ++i) d[c][i] = (4 * l[c] - 1) * x[c][i];
  for (std::size_t e = 0; e < 6; ++e) {
    const auto a = static_cast<std::size_t>(edges[e][0]), b = static_cast<std::size_t>(edges[e][1]);
    for (std::size_t i = 0; i < 3; ++i) {
      d[a][i] += 4 * l[b] * x[4 + e][i];
      d[b][i] += 4 * l[a] * x[4 + e][i];
    }
  }
  std::array<Vector3, 3> u;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < 3; ++i) u[c][i] = d[c + 1][i] - d[0][i];
  return u[0][0] * (u[1][1] * u[2][2] - u[1][2] * u[2][1]) - u[0][1] * (u[1][0] * u[2][2] - u[1][2] * u[2][0]) +
         u[0][2] * (u[1][0] * u[2][1] - u[1][1] * u[2][0]);
}

/// Least Jacobian at the nodes of the three pieces of the prism over the triangle, one unit high.
double least_of_tetrahedra(const Triangle6& t, const std::array<std::int32_t, 3>& vertices) {
  constexpr std::int64_t upper = std::int64_t{1} << 40;
  const std::array<std::int64_t, 6> ids{vertices[0],         vertices[1],         vertices[2],
                                        vertices[0] + upper, vertices[1] + upper, vertices[2] + upper};
  constexpr int edges[6][2] = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {2, 3}, {1, 3}};
  double least = straight_jacobian(t);
  for (const auto& piece : split_wedge(ids)) {
    std::array<Vector3, 10> x{};
    const auto plane = [&](std::size_t p, std::size_t q) {  // corners of the plane, alike or not
      if (p == q) return t.corners[p];
      return t.middles[p + q == 1 ? 0 : p + q == 2 ? 1 : 2];
    };
    for (std::size_t c = 0; c < 4; ++c) {
      const Vector2 at = plane(piece[c] % 3U, piece[c] % 3U);
      x[c] = {at[0], at[1], piece[c] < 3 ? 0.0 : 1.0};
    }
    for (std::size_t e = 0; e < 6; ++e) {
      const std::size_t a = piece[static_cast<std::size_t>(edges[e][0])], b = piece[static_cast<std::size_t>(edges[e][1])];
      const Vector2 at = plane(a % 3, b % 3);
      x[4 + e] = {at[0], at[1], ((a < 3 ? 0.0 : 1.0) + (b < 3 ? 0.0 : 1.0)) / 2};
    }
    for (std::size_t c = 0; c < 4; ++c) {
      std::array<double, 4> l{};
      l[c] = 1;
      least = std::min(least, jacobian_at(x, l));
    }
    for (const auto& [a, b] : edges) {
      std::array<double, 4> l{};
      l[static_cast<std::size_t>(a)] = l[static_cast<std::size_t>(b)] = 0.5;
      least = std::min(least, jacobian_at(x, l));
    }
  }
  return least;
}

/// Point of the circle that an edge stands on, in the middle of it; false if it stands on none.
bool middle_on_circle(const CircleGrid& grid, const Vector2& a, const Vector2& b, double longest_sagitta, Vector2& middle) {
  const Vector2 half{(a[0] + b[0]) / 2, (a[1] + b[1]) / 2};
  const double chord = distance(a, b);
  double best = std::numeric_limits<double>::infinity();
  grid.near(half, [&](const Circle& circle) {
    const double r = circle.radius_m;
    if (chord > 1.5 * r) return;
    const double sagitta = r - std::sqrt(r * r - chord * chord / 4);
    if (sagitta > longest_over_given * longest_sagitta || sagitta < 2 * rounding_m) return;
    const double off = std::max(std::abs(distance(a, circle.centre_m) - r), std::abs(distance(b, circle.centre_m) - r));
    if (off > rounding_m + part_of_sagitta * sagitta) return;
    const double out = distance(half, circle.centre_m);
    const Vector2 at{circle.centre_m[0] + (half[0] - circle.centre_m[0]) * r / out,
                     circle.centre_m[1] + (half[1] - circle.centre_m[1]) * r / out};
    // Ties are broken by the coordinates, so that the order of the circles does not matter.
    if (off < best || (off == best && at < middle)) {
      best = off;
      middle = at;
    }
  });
  return std::isfinite(best);
}

}  // namespace

SecondOrderStatistics curve(const mesh::PlanarMesh& planar, const SecondOrderOptions& options, const EdgeMiddles& edges) {
  SecondOrderStatistics statistics;
  if (options.circles.empty() || planar.num_points() == 0) return statistics;
  const auto points = planar.points_m();
  double low = points[0][0], high = low;
  for (const Vector2& point : points) {
    low = std::min(low, point[0]);
    high = std::max(high, point[0]);
  }
  // The middle of a chord is a sagitta from its arc, so a square beside its own is crossed; few enough for the whole board.
  const CircleGrid grid(options.circles, std::max({(high - low) / 1024, 4 * options.longest_sagitta_m, 1e-6}));
  std::vector<char> is_curved(edges.edges.size(), 0);
  for (const auto& constrained : planar.constrained()) {
    const auto found = std::lower_bound(edges.edges.begin(), edges.edges.end(), constrained);
    const auto edge = static_cast<std::size_t>(found - edges.edges.begin());
    Vector2 middle{};
    if (!middle_on_circle(grid, points[static_cast<std::size_t>(constrained[0])],
                          points[static_cast<std::size_t>(constrained[1])], options.longest_sagitta_m, middle))
      continue;
    is_curved[edge] = 1;
    edges.middles_m[edge] = middle;
    ++statistics.num_curved_edges;
  }
  // Straightening one triangle changes its neighbours: repeat until nothing folds. Every pass straightens or ends it.
  std::vector<char> has_folded(edges.edges_of_triangle.size(), 0);
  for (bool again = true; again;) {
    again = false;
    for (std::size_t t = 0; t < edges.edges_of_triangle.size(); ++t) {
      const auto& sides = edges.edges_of_triangle[t];
      if (std::ranges::none_of(sides, [&](std::int32_t e) { return is_curved[static_cast<std::size_t>(e)] != 0; })) continue;
      const auto& vertices = planar.triangles()[t];
      Triangle6 shape;
      for (std::size_t i = 0; i < 3; ++i) {
        shape.corners[i] = points[static_cast<std::size_t>(vertices[i])];
        shape.middles[i] = edges.middles_m[static_cast<std::size_t>(sides[i])];
      }
      const double wanted = least_jacobian * straight_jacobian(shape);
      if (least_bezier(shape) >= wanted && (!options.for_tetrahedra || least_of_tetrahedra(shape, vertices) >= wanted))
        continue;
      if (has_folded[t] == 0) ++statistics.num_folded_triangles;
      has_folded[t] = 1;
      again = true;
      for (const std::int32_t e : sides) {
        const auto edge = static_cast<std::size_t>(e);
        if (is_curved[edge] == 0) continue;
        is_curved[edge] = 0;
        const Vector2 &a = points[static_cast<std::size_t>(edges.edges[edge][0])],
                      &b = points[static_cast<std::size_t>(edges.edges[edge][1])];
        edges.middles_m[edge] = {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2};
        --statistics.num_curved_edges;
        ++statistics.num_straightened_edges;
      }
    }
  }
  return statistics;
}

}  // namespace pcbmesh::extrude
