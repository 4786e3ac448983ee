// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/layering/prism_quality.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "explicit_mesh.hpp"

namespace pcbmesh::layering {
namespace {

struct Triangle {
  double area = 0, beta = 0;
  std::array<double, 3> squared{};
};

Triangle triangle_of(const std::array<std::array<double, 2>, 3>& corners) {
  Triangle triangle;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto &p = corners[(i + 1) % 3], &q = corners[(i + 2) % 3];
    triangle.squared[i] = (q[0] - p[0]) * (q[0] - p[0]) + (q[1] - p[1]) * (q[1] - p[1]);
    triangle.beta += triangle.squared[i];
  }
  const auto& [a, b, c] = corners;
  triangle.area = 0.5 * std::abs((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
  return triangle;
}

/// Three uniform points of the unit square. Our own scaling: the standard distributions differ between libraries.
std::vector<Triangle> random_triangles(std::size_t count, unsigned seed) {
  std::mt19937_64 random(seed);
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  std::vector<Triangle> triangles;
  while (triangles.size() < count) {
    std::array<std::array<double, 2>, 3> corners{};
    for (auto& corner : corners) corner = {uniform(), uniform()};
    triangles.push_back(triangle_of(corners));
  }
  return triangles;
}

const Triangle equilateral{std::sqrt(3.0) / 4, 3, {1, 1, 1}};

void expect_relative(double value, double expected, double tolerance = 1e-9) {
  EXPECT_NEAR(value, expected, tolerance * std::abs(expected));
}

TEST(PrismQuality, F1_RegularPrismHasQualityOne) {
  expect_relative(prism_quality(equilateral.area, equilateral.beta, 1.0), 1.0);
  expect_relative(triangle_quality(equilateral.area, equilateral.beta), 1.0);
}

TEST(PrismQuality, F2_ScaleDoesNotMatter) {
  for (const Triangle& t : random_triangles(100, 2)) {
    expect_relative(prism_quality(1e-6 * t.area, 1e-6 * t.beta, 1e-3 * 0.3), prism_quality(t.area, t.beta, 0.3));
  }
}

TEST(PrismQuality, F3_OptimalHeightIsTheMaximum) {
  for (const Triangle& t : random_triangles(1000, 3)) {
    const double best = optimal_height(t.beta), quality = prism_quality(t.area, t.beta, best);
    for (double factor : {0.5, 0.99, 0.9999, 1.0001, 1.01, 2.0})
      EXPECT_LT(prism_quality(t.area, t.beta, factor * best), quality);
  }
}

TEST(PrismQuality, F4_BestQualityIsProportionalToTriangleQuality) {
  for (const Triangle& t : random_triangles(1000, 4)) {
    const double best = prism_quality(t.area, t.beta, optimal_height(t.beta));
    expect_relative(best, 64 * t.area / (9 * t.beta));
    expect_relative(best, max_prism_quality * triangle_quality(t.area, t.beta));
  }
  expect_relative(max_prism_quality, 16 * std::sqrt(3.0) / 27, 1e-15);
}

TEST(PrismQuality, F5_EquilateralBaseHasTheLargestQuality) {
  EXPECT_NEAR(optimal_height(equilateral.beta), 1.224744871, 1e-9);
  EXPECT_NEAR(prism_quality(equilateral.area, equilateral.beta, optimal_height(equilateral.beta)), 1.026400479, 1e-9);
  for (const Triangle& t : random_triangles(1000, 5)) EXPECT_LE(triangle_quality(t.area, t.beta), 1.0);
}

TEST(PrismQuality, F6_FalloffIsTheSameForEveryTriangle) {
  for (const Triangle& t : random_triangles(1000, 6)) {
    const double best = optimal_height(t.beta);
    for (double s : {0.01, 0.3, 0.9, 1.0, 1.7, 40.0}) {
      expect_relative(prism_quality(t.area, t.beta, s * best), prism_quality(t.area, t.beta, best) * quality_falloff(s));
    }
  }
}

TEST(PrismQuality, F7_FalloffAtItsPublishedPoints) {
  EXPECT_DOUBLE_EQ(quality_falloff(1.0), 1.0);
  EXPECT_NEAR(quality_falloff(0.5), 0.76980, 5e-6);
  EXPECT_NEAR(quality_falloff(2.0), 0.7071068, 5e-8);
  EXPECT_NEAR(quality_falloff(1e-6) / 1e-6, 1.837, 5e-4);
  EXPECT_NEAR(quality_falloff(1e4) * 1e8, 5.196, 5e-4);
}

TEST(PrismQuality, F8_SecondDerivativeAtTheOptimum) {
  for (const Triangle& t : random_triangles(1000, 8)) {
    const double best = optimal_height(t.beta);
    // In s = h/h*: q'' h*^2 / q* = -4/3. Fourth-order differences of the function itself, step 1e-3: error below 1e-9.
    const auto q = [&](double s) { return prism_quality(t.area, t.beta, s * best) / prism_quality(t.area, t.beta, best); };
    const double d = 2e-3;
    const double second = (-q(1 + 2 * d) + 16 * q(1 + d) - 30 * q(1) + 16 * q(1 - d) - q(1 - 2 * d)) / (12 * d * d);
    EXPECT_NEAR(second, -4.0 / 3.0, 1e-8);
    expect_relative(-512 * t.area / (27 * t.beta * t.beta), -4.0 / 3.0 * prism_quality(t.area, t.beta, best) / (best * best));
  }
}

TEST(PrismQuality, F9_AverageEdgeHeightStaysBelowOne) {
  for (const Triangle& t : random_triangles(5000, 9)) {
    const double average = average_edge_height(t.squared), s = average / optimal_height(t.beta);
    EXPECT_GT(s, 2.0 / 3.0);
    EXPECT_LE(s, std::sqrt(2.0 / 3.0) * (1 + 1e-12));
    const double ratio = prism_quality(t.area, t.beta, average) / prism_quality(t.area, t.beta, optimal_height(t.beta));
    EXPECT_GT(ratio, 0.90639);
    EXPECT_LE(ratio, 0.97429);
    EXPECT_LE(prism_quality(t.area, t.beta, average), triangle_quality(t.area, t.beta) * (1 + 1e-12));
  }
}

TEST(PrismQuality, F10_ThresholdsAreWhereTwoCutsTie) {
  EXPECT_NEAR(cut_threshold(1), 1.395628, 5e-7);
  EXPECT_NEAR(cut_threshold(2), 2.438363, 5e-7);
  EXPECT_NEAR(cut_threshold(3), 3.45616, 5e-6);
  EXPECT_NEAR(cut_threshold(4), 4.46596, 5e-6);
  EXPECT_NEAR(cut_threshold(5), 5.47217, 5e-6);
  for (int n = 1; n <= 50; ++n) {
    const double r = std::cbrt((n + 1.0) / n * (n + 1.0) / n);
    const double published = std::sqrt(2 * (r - 1) / (1.0 / (n * n) - r / ((n + 1.0) * (n + 1.0))));
    expect_relative(cut_threshold(n), published);
    expect_relative(quality_falloff(published / n), quality_falloff(published / (n + 1)));
  }
}

TEST(PrismQuality, F10_OptimalCutsAgreeWithTryingAll) {
  std::mt19937_64 random(10);
  for (int i = 0; i < 20'000; ++i) {
    const double ratio = 40.0 * static_cast<double>(random() >> 11) * 0x1p-53 + 1e-3, best = 3.7e-4;
    int expected = 1;
    while (quality_falloff(ratio / (expected + 1)) > quality_falloff(ratio / expected)) ++expected;
    ASSERT_EQ(optimal_cuts(ratio * best, best), expected) << ratio;
  }
  for (int n = 1; n < 1000; ++n) {
    EXPECT_EQ(optimal_cuts(cut_threshold(n) * (1 - 1e-12), 1), n);
    EXPECT_EQ(optimal_cuts(cut_threshold(n) * (1 + 1e-12), 1), n + 1);
  }
  EXPECT_EQ(optimal_cuts(1e-9, 1), 1);
  EXPECT_EQ(optimal_cuts(1e6 + 0.25, 1), 1'000'000);
  EXPECT_EQ(optimal_cuts(1e12, 1), 2147483647);
}

TEST(PrismQuality, F11_NineEdgeVariantEqualsTriangleQualityAtItsOptimum) {
  expect_relative(nine_edge_quality(equilateral.area, equilateral.beta, 1.0), 1.0);
  for (const Triangle& t : random_triangles(1000, 11)) {
    const double best = std::sqrt(t.beta / 3);
    expect_relative(nine_edge_quality(t.area, t.beta, best), triangle_quality(t.area, t.beta));
    EXPECT_LT(nine_edge_quality(t.area, t.beta, 1.01 * best), nine_edge_quality(t.area, t.beta, best));
    EXPECT_LT(nine_edge_quality(t.area, t.beta, 0.99 * best), nine_edge_quality(t.area, t.beta, best));
  }
}

TEST(PrismQuality, Table1_TwentyThousandTrianglesOfTheUnitSquare) {
  double sum_best = 0, sum_average = 0, sum_ratio = 0, max_best = 0, max_average = 0;
  const auto triangles = random_triangles(20'000, 2012);
  for (const Triangle& t : triangles) {
    const double best = prism_quality(t.area, t.beta, optimal_height(t.beta));
    const double average = prism_quality(t.area, t.beta, average_edge_height(t.squared));
    sum_best += best;
    sum_average += average;
    sum_ratio += average / best;
    max_best = std::max(max_best, best);
    max_average = std::max(max_average, average);
  }
  const auto count = static_cast<double>(triangles.size());
  EXPECT_NEAR(sum_best / count, 0.5277, 0.0064);  // three standard errors
  EXPECT_NEAR(sum_average / count, 0.5083, 0.0062);
  EXPECT_NEAR(sum_average / sum_best, 0.96320, 0.0003);
  EXPECT_LE(max_best, 1.0264005);
  EXPECT_GT(max_best, 1.02);
  EXPECT_LT(max_average, 1.0);
  EXPECT_GT(sum_ratio / count, 0.9064);
}

TEST(HeightStatistics, AreThoseOfTheTriangles) {
  // Right isosceles halves of 0.2 mm squares: the optimal height of a right triangle is its hypotenuse (paper: 0.282843 mm).
  const auto mesh = testing::grid(4, 3, 2e-4, 2e-4, [](int, int) { return 0; }, {{}});
  const HeightStatistics heights = height_statistics(mesh);
  EXPECT_NEAR(heights.minimum, 2.82842712e-4, 1e-12);
  EXPECT_NEAR(heights.average, 2.82842712e-4, 1e-12);
  EXPECT_NEAR(heights.maximum, 2.82842712e-4, 1e-12);
  EXPECT_NEAR(heights.mean_triangle_quality, std::sqrt(3.0) / 2, 1e-12);
}

TEST(HeightStatistics, CountsTrianglesBelowAverage) {
  mesh::PlanarMeshParts parts;
  parts.points_m = {{0, 0}, {3, 0}, {0, 4}, {-1, 0}, {0, -1}};
  parts.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}};  // hypotenuses 5, sqrt 17, sqrt 2
  parts.regions = {0, 0, 0};
  parts.region_body_offsets = {0, 0};
  const HeightStatistics heights = height_statistics(mesh::PlanarMesh::from_parts(parts));
  EXPECT_NEAR(heights.minimum, std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(heights.maximum, 5.0, 1e-12);
  EXPECT_NEAR(heights.average, (5 + std::sqrt(17.0) + std::sqrt(2.0)) / 3, 1e-12);
  EXPECT_EQ(heights.num_below_average, 1);
  // sum of q*/h* over sum of q*/h*^2; q* goes with area / (2 h*^2)
  const double a = 6 / 25.0, b = 2 / 17.0, c = 0.5 / 2.0;
  EXPECT_NEAR(heights.weighted, (a / 5 + b / std::sqrt(17.0) + c / std::sqrt(2.0)) / (a / 25 + b / 17 + c / 2), 1e-12);
  double area = 0, count = 0;
  for (const HeightBin& bin : heights.bins) {
    area += bin.area_m2;
    count += bin.count;
  }
  EXPECT_NEAR(area, 8.5, 1e-12);
  EXPECT_EQ(count, 3);
}

/// Prism mesh of one region per row of squares, void where asked; the boundary is left to a single tag.
mesh::PrismMesh quality_mesh(const mesh::PlanarMesh& planar, const mesh::LayerPlan& plan,
                             const std::vector<std::int32_t>& tags) {
  mesh::PrismMeshParts parts;
  parts.planar = planar;
  parts.plan = plan;
  parts.layers = {"L"};
  parts.materials.push_back({"m"});
  parts.volume_tags.push_back({1, "L|m|none"});
  parts.face_tags.push_back({1, "side"});
  parts.column_tags = tags;
  testing::add_boundary_by_neighbours(parts);
  return mesh::PrismMesh::from_parts(std::move(parts));
}

/// The mesh with its columns ever wider, so that no two columns have triangles of one shape.
mesh::PlanarMesh stretched(const mesh::PlanarMesh& even) {
  mesh::PlanarMeshParts parts;
  for (const auto& [x, y] : even.points_m()) parts.points_m.push_back({x + 400 * x * x, y});
  parts.triangles.assign(even.triangles().begin(), even.triangles().end());
  parts.regions.assign(even.regions().begin(), even.regions().end());
  parts.region_body_offsets.assign(static_cast<std::size_t>(even.num_regions()) + 1, 0);
  return mesh::PlanarMesh::from_parts(std::move(parts));
}

TEST(QualityStatistics, MatchEveryPrismOneByOne) {
  const auto planar =
      stretched(testing::grid(12, 9, 1.1e-3, 0.7e-3, [](int i, int j) { return i >= 7  ? 2
                                                                               : j < 3 ? 0
                                                                                       : 1; }, {{}, {}, {}}));
  mesh::LayerPlanParts plan;
  plan.z_m = {0, 1e-3, 2e-3, 2.2e-3, 2.5e-3, 2.6e-3, 5e-3};
  plan.slab = {0, 0, 1, 2, 2, 3};
  const std::vector<std::int32_t> tags{0, 0, -1, 0, 0, -1, 0, 0, -1, -1, -1, -1};  // region 2 carries nothing
  const mesh::PrismMesh mesh = quality_mesh(planar, mesh::LayerPlan::from_parts(plan), tags);
  std::vector<double> qualities, triangles;
  double sum = 0, weighted = 0, volume = 0, longest = 0, shortest = 1, smallest_angle = 180;
  for (std::int32_t t = 0; t < planar.num_triangles(); ++t) {
    const auto e = planar.squared_edges_m2(t);
    const double area = planar.area_m2(t), beta = e[0] + e[1] + e[2];
    bool carries_prisms = false;
    for (std::int32_t k = 0; k < 6; ++k) {
      if (mesh.tag_of(plan.slab[static_cast<std::size_t>(k)], t) < 0) continue;
      carries_prisms = true;
      const double height = mesh.plan().height_m(k), quality = prism_quality(area, beta, height);
      qualities.push_back(quality);
      sum += quality;
      weighted += quality * area * height;
      volume += area * height;
    }
    if (!carries_prisms) continue;
    triangles.push_back(triangle_quality(area, beta));
    for (std::size_t i = 0; i < 3; ++i) {
      longest = std::max(longest, std::sqrt(e[i]));
      shortest = std::min(shortest, std::sqrt(e[i]));
      const double b = e[(i + 1) % 3], c = e[(i + 2) % 3];
      smallest_angle = std::min(smallest_angle, std::acos((b + c - e[i]) / (2 * std::sqrt(b * c))) * 180 / std::acos(-1.0));
    }
  }
  const QualityStatistics found = quality_statistics(mesh);
  std::sort(qualities.begin(), qualities.end());
  ASSERT_EQ(static_cast<std::int64_t>(qualities.size()), mesh.num_prisms());
  expect_relative(found.mean_prism, sum / static_cast<double>(qualities.size()));
  expect_relative(found.volume_weighted_prism, weighted / volume);
  expect_relative(found.min_prism, qualities.front());
  expect_relative(found.quantile1_prism, qualities[qualities.size() / 100], 2.5e-4);
  double triangle_sum = 0;
  for (double quality : triangles) triangle_sum += quality;
  expect_relative(found.mean_triangle, triangle_sum / static_cast<double>(triangles.size()));
  expect_relative(found.min_triangle, *std::min_element(triangles.begin(), triangles.end()));
  expect_relative(found.longest_edge_m, longest);
  expect_relative(found.shortest_edge_m, shortest);
  expect_relative(found.min_angle_deg, smallest_angle);
}

TEST(QualityStatistics, OnePercentQuantileOfManyQualities) {
  // Columns of growing width: thousands of different triangles.
  mesh::PlanarMeshParts parts;
  const std::int32_t columns = 3000;
  double x = 0;
  for (std::int32_t i = 0; i <= columns; ++i) {
    parts.points_m.push_back({x, 0});
    parts.points_m.push_back({x, 1});
    x += 0.01 + 1e-3 * i;
    if (i == columns) break;
    const std::int32_t a = 2 * i;
    parts.triangles.insert(parts.triangles.end(), {{a, a + 2, a + 3}, {a, a + 3, a + 1}});
    parts.regions.insert(parts.regions.end(), 2, 0);
  }
  parts.region_body_offsets = {0, 0};
  const auto planar = mesh::PlanarMesh::from_parts(std::move(parts));
  const mesh::PrismMesh mesh = quality_mesh(planar, testing::even_plan({3}, 0.2), {0});
  std::vector<double> qualities;
  for (std::int32_t t = 0; t < planar.num_triangles(); ++t) {
    const auto e = planar.squared_edges_m2(t);
    qualities.insert(qualities.end(), 3, prism_quality(planar.area_m2(t), e[0] + e[1] + e[2], 0.2));
  }
  std::sort(qualities.begin(), qualities.end());
  expect_relative(quality_statistics(mesh).quantile1_prism, qualities[qualities.size() / 100], 2.5e-4);
}

TEST(QualityStatistics, EmptyMeshGivesZeros) {
  const auto planar = testing::grid(2, 2, 1, 1, [](int, int) { return 0; }, {{}});
  const QualityStatistics found = quality_statistics(quality_mesh(planar, testing::even_plan({1}, 1), {-1}));
  EXPECT_EQ(found.mean_prism, 0);
  EXPECT_EQ(found.longest_edge_m, 0);
}

}  // namespace
}  // namespace pcbmesh::layering
