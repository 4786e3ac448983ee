// SPDX-License-Identifier: GPL-3.0-or-later
// Signs that doubles can't tell: the checker decides them exactly.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "pcbmesh/validation/report.hpp"
#include "validation/checks/orientation.hpp"

namespace pcbmesh::validation {
namespace {

using checks::orientation;
using checks::orientation_exact;
using checks::operator-;
using Point = std::array<double, 3>;

/// Coordinates of 40 bits, so that a point of the plane a b c can be found without rounding.
Point random_point(std::mt19937_64& random) {
  const auto one = [&] { return std::ldexp(static_cast<double>(random() >> 24), -40); };
  return {one(), one(), one()};
}

/// a + (b - a) / 4 + (c - a) / 2, exactly in their plane.
Point in_plane(const Point& a, const Point& b, const Point& c) {
  Point at{};
  for (std::size_t i = 0; i < 3; ++i) at[i] = a[i] + (b[i] - a[i]) / 4 + (c[i] - a[i]) / 2;
  return at;
}

TEST(Orientation, TellsAnUlpOffThePlaneOnEitherSide) {
  std::mt19937_64 random(1);
  int doubtful = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Point a = random_point(random), b = random_point(random), c = random_point(random);
    Point d = in_plane(a, b, c);
    ASSERT_EQ(orientation(a, b, c, d), 0) << i;
    const double up = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    if (std::abs(up) < 1e-9) continue;  // the sign of this normal is beyond doubt
    const int side = up > 0 ? 1 : -1;
    const double z = d[2];
    d[2] = std::nextafter(z, 2);
    ASSERT_EQ(orientation(a, b, c, d), side) << i;
    // Plain doubles get some of these wrong, or the test would prove nothing.
    doubtful += checks::triple(b - a, c - a, d - a) * side <= 0 ? 1 : 0;
    d[2] = std::nextafter(z, -2);
    ASSERT_EQ(orientation(a, b, c, d), -side) << i;
  }
  EXPECT_GT(doubtful, 1000);
}

TEST(Orientation, AgreesWithExactArithmeticWhereDoublesAnswer) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 50'000; ++i) {
    std::array<Point, 4> p{};
    const double size = std::ldexp(1.0, static_cast<int>(random() % 400) - 300);
    for (Point& at : p) {
      at = random_point(random);
      for (double& x : at) x = random() % 4 == 0 ? 0 : x * size;
    }
    if (i % 2 == 0) {
      p[3] = in_plane(p[0], p[1], p[2]);  // rounded: near the plane
      p[3][i % 3] *= 1 + 1e-15 * static_cast<double>(random() % 3);
    }
    ASSERT_EQ(orientation(p[0], p[1], p[2], p[3]), orientation_exact(p[0], p[1], p[2], p[3])) << i;
    ASSERT_EQ(orientation(p[1], p[0], p[2], p[3]), -orientation(p[0], p[1], p[2], p[3])) << i;
  }
}

mesh::MeshData tetrahedra(std::vector<Point> nodes) {
  mesh::MeshData mesh;
  mesh::CellBlock block{mesh::CellKind::tetrahedron, {}, {}};
  for (std::size_t i = 0; i < nodes.size(); ++i) block.corners.push_back(static_cast<std::int64_t>(i));
  block.tags.assign(nodes.size() / 4, 1);
  mesh.cells.push_back(std::move(block));
  mesh.nodes = std::move(nodes);
  return mesh;
}

std::int64_t count_of(const Report& report, const std::string& code) {
  std::int64_t count = 0;
  for (const Finding& finding : report.findings) count += finding.code == code ? finding.count : 0;
  return count;
}

TEST(ExactSigns, ATetrahedronWithinAnUlpOfFlatIsWhatItIs) {
  // 1e-14 of the edges used to count as flat: all three did.
  std::mt19937_64 random(3);
  for (int i = 0; i < 200; ++i) {
    Point a = random_point(random), b = random_point(random), c = random_point(random);
    double up = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    if (std::abs(up) < 1e-3) continue;
    if (up < 0) std::swap(b, c);
    const Point flat = in_plane(a, b, c);
    Point above = flat, below = flat;
    above[2] = std::nextafter(flat[2], 2);
    below[2] = std::nextafter(flat[2], -2);
    const auto shape = [&](const Point& d) {
      const Report report = check(tetrahedra({a, b, c, d}), nullptr);
      return std::array{count_of(report, "cell.nearly_flat"), count_of(report, "cell.flat"), count_of(report, "cell.inverted")};
    };
    EXPECT_EQ(shape(above), (std::array<std::int64_t, 3>{1, 0, 0})) << i;
    EXPECT_EQ(shape(flat), (std::array<std::int64_t, 3>{0, 1, 0})) << i;
    EXPECT_EQ(shape(below), (std::array<std::int64_t, 3>{0, 0, 1})) << i;
  }
}

TEST(ExactSigns, ThinIsNotFlat) {
  // One ulp high, but right-angled: nothing is in doubt.
  const double z = std::nextafter(1.0, 2);
  const Report report = check(tetrahedra({{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {0, 0, z}}), nullptr);
  EXPECT_EQ(count_of(report, "cell.flat") + count_of(report, "cell.nearly_flat") + count_of(report, "cell.inverted"), 0);
  // No double lies inside: whether something else fills the place can't be told, and it says so.
  EXPECT_GT(count_of(report, "cell.overlap_unknown"), 0);
}

/// Two tetrahedra, the upper with an edge across an edge of the lower, `rise` above it.
Report crossed(double height) {
  return check(tetrahedra({{-1, 0, 1},
                           {1, 0, 1},
                           {0, -0.2, 0.1},
                           {0.1, 0.3, 0.2},
                           {0, 1, height},
                           {0, -1, height},
                           {0.3, 0.1, 2},
                           {-0.2, 0, 1.9}}),
               nullptr);
}

TEST(ExactSigns, EdgesThatCrossAreFoundToTheUlp) {
  // The tolerance used to let all three pass.
  EXPECT_EQ(count_of(crossed(std::nextafter(1.0, 2)), "boundary.crossing"), 0);
  EXPECT_GT(count_of(crossed(1.0), "boundary.crossing"), 0);
  EXPECT_GT(count_of(crossed(std::nextafter(1.0, 0)), "boundary.crossing"), 0);
  const Report apart = crossed(std::nextafter(1.0, 2));
  EXPECT_EQ(count_of(apart, "cell.inverted"), 0) << to_text(apart);
}

TEST(ExactSigns, ACellInsideAnotherIsFoundWhereverItsRaysStart) {
  // A small cell in a large one, at places where rays upwards meet edges: above is the crest of a roof.
  for (const double x : {0.0, 0.25, -0.125}) {
    const Report report = check(tetrahedra({{-2, -1, 0},
                                            {2, -1, 0},
                                            {0, 1, 0},
                                            {0, 0, 1},
                                            {x, -0.1, 0.1},
                                            {x + 0.1, -0.1, 0.1},
                                            {x, 0.1, 0.1},
                                            {x, -0.1, 0.2}}),
                                nullptr);
    EXPECT_GT(count_of(report, "cell.overlap"), 0) << to_text(report);
    EXPECT_EQ(count_of(report, "cell.overlap_unknown"), 0);
  }
}

}  // namespace
}  // namespace pcbmesh::validation
