// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/layering/quality_report.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>

#include "pcbmesh/layering/prism_quality.hpp"
#include "sample_prism_mesh.hpp"

namespace pcbmesh::layering {
namespace {

using Vector = std::array<double, 3>;

Vector minus(const Vector& a, const Vector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
double dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double length(const Vector& a) {
  return std::sqrt(dot(a, a));
}

/// The measures by their general definitions on six corners, with nothing taken from the prism being right.
PrismMeasures measures_of_wedge(const std::array<Vector, 6>& p) {
  PrismMeasures out;
  double shortest = 1e30, longest = 0;
  for (const auto& [a, b] :
       std::array<std::pair<int, int>, 9>{{{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}}}) {
    const double edge = length(minus(p[static_cast<std::size_t>(b)], p[static_cast<std::size_t>(a)]));
    shortest = std::min(shortest, edge);
    longest = std::max(longest, edge);
  }
  out.aspect_ratio = longest / shortest;
  out.scaled_jacobian = 1;
  for (std::size_t i = 0; i < 6; ++i) {  // at each corner: three edges, right-handed
    const std::size_t ring = i / 3 * 3, next = ring + (i + 1) % 3, last = ring + (i + 2) % 3, other = (i + 3) % 6;
    Vector a = minus(p[next], p[i]), b = minus(p[last], p[i]);
    if (i >= 3) std::swap(a, b);
    const Vector c = minus(p[other], p[i]);
    const double jacobian = dot(cross(a, b), c) / (length(a) * length(b) * length(c));
    out.scaled_jacobian = std::min(out.scaled_jacobian, 2 / std::sqrt(3.0) * jacobian);
  }
  const std::array<Vector, 5> outward{cross(minus(p[2], p[0]), minus(p[1], p[0])), cross(minus(p[4], p[3]), minus(p[5], p[3])),
                                      cross(minus(p[1], p[0]), minus(p[3], p[0])), cross(minus(p[2], p[1]), minus(p[4], p[1])),
                                      cross(minus(p[0], p[2]), minus(p[5], p[2]))};
  out.min_dihedral_deg = 180;
  out.max_dihedral_deg = 0;
  for (std::size_t i = 0; i < 5; ++i) {
    for (std::size_t j = i + 1; j < 5; ++j) {
      if (i == 0 && j == 1) continue;  // the caps don't meet
      const double cosine = dot(outward[i], outward[j]) / (length(outward[i]) * length(outward[j]));
      const double dihedral = 180 - std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::acos(-1.0);
      out.min_dihedral_deg = std::min(out.min_dihedral_deg, dihedral);
      out.max_dihedral_deg = std::max(out.max_dihedral_deg, dihedral);
    }
  }
  return out;
}

TEST(QualityReport, MeasuresAgreeWithTheirGeneralDefinitions) {
  std::mt19937_64 random(1);
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  for (int i = 0; i < 1000; ++i) {
    std::array<Vector, 6> p{};
    for (std::size_t k = 0; k < 3; ++k) p[k] = {uniform(), uniform(), 0};
    double area = 0.5 * cross(minus(p[1], p[0]), minus(p[2], p[0]))[2];
    if (area < 0) {
      std::swap(p[1], p[2]);
      area = -area;
    }
    const double height = 0.05 + uniform();
    for (std::size_t k = 0; k < 3; ++k) p[k + 3] = {p[k][0], p[k][1], height};
    std::array<double, 3> squared{};
    for (std::size_t k = 0; k < 3; ++k)
      squared[k] = dot(minus(p[(k + 1) % 3], p[(k + 2) % 3]), minus(p[(k + 1) % 3], p[(k + 2) % 3]));
    const PrismMeasures ours = prism_measures(area, squared, height), expected = measures_of_wedge(p);
    EXPECT_NEAR(ours.scaled_jacobian, expected.scaled_jacobian, 1e-9);
    EXPECT_NEAR(ours.aspect_ratio, expected.aspect_ratio, 1e-9 * expected.aspect_ratio);
    EXPECT_NEAR(ours.min_dihedral_deg, expected.min_dihedral_deg, 1e-6);
    EXPECT_NEAR(ours.max_dihedral_deg, expected.max_dihedral_deg, 1e-6);
  }
}

TEST(QualityReport, RegularPrismIsPerfectByEveryMeasure) {
  const PrismMeasures m = prism_measures(std::sqrt(3.0) / 4, {1, 1, 1}, 1);
  EXPECT_NEAR(m.quality, 1, 1e-12);
  EXPECT_NEAR(m.nine_edge, 1, 1e-12);
  EXPECT_NEAR(m.scaled_jacobian, 1, 1e-12);
  EXPECT_NEAR(m.aspect_ratio, 1, 1e-12);
  EXPECT_NEAR(m.min_dihedral_deg, 60, 1e-9);
  EXPECT_NEAR(m.max_dihedral_deg, 90, 1e-9);
}

TEST(QualityReport, GroupsHistogramsAndWorstComeFromTheSamePrisms) {
  const auto mesh = mesh::PrismMesh::from_parts(testing::sample_parts());
  const QualityReport report = quality_report(mesh, 5);
  const QualityStatistics all = quality_statistics(mesh);
  for (const auto* groups : {&report.layers, &report.materials, &report.nets}) {
    std::int64_t count = 0;
    double quality = 0, weighted = 0, volume = 0, least = 10;
    for (const QualityGroup& group : *groups) {
      count += group.num_prisms;
      quality += group.mean_prism * static_cast<double>(group.num_prisms);
      weighted += group.volume_weighted_prism * group.volume_m3;
      volume += group.volume_m3;
      least = std::min(least, group.min_prism);
    }
    EXPECT_EQ(count, mesh.num_prisms());
    EXPECT_NEAR(quality / static_cast<double>(count), all.mean_prism, 1e-12);
    EXPECT_NEAR(weighted / volume, all.volume_weighted_prism, 1e-12);
    EXPECT_NEAR(least, all.min_prism, 1e-12);
  }
  for (const QualityHistogram& histogram : report.histograms) {
    std::int64_t count = 0;
    for (const std::int64_t bin : histogram.counts) count += bin;
    EXPECT_EQ(count, mesh.num_prisms()) << histogram.measure;
  }
  EXPECT_EQ(report.nets.back().name, "no net");
}

TEST(QualityReport, WorstPrismsAreTheWorstAndTheirPlacesAreRight) {
  const auto mesh = mesh::PrismMesh::from_parts(testing::sample_parts());
  const QualityReport report = quality_report(mesh, 5);
  ASSERT_EQ(report.worst.size(), 5U);
  std::vector<std::tuple<double, std::int32_t, std::int32_t>> all;
  const auto& planar = mesh.planar();
  for (std::int32_t k = 0; k < mesh.plan().num_sublayers(); ++k) {
    const std::int32_t slab = mesh.plan().slab_of_sublayer()[static_cast<std::size_t>(k)];
    const double height = mesh.plan().height_m(k);  // in this sample no two sub-layers of a slab are equal
    for (std::int32_t t = 0; t < planar.num_triangles(); ++t) {
      const auto squared = planar.squared_edges_m2(t);
      if (mesh.tag_of(slab, t) >= 0)
        all.emplace_back(prism_quality(planar.area_m2(t), squared[0] + squared[1] + squared[2], height), slab, t);
    }
  }
  std::sort(all.begin(), all.end());
  for (std::size_t i = 0; i < 5; ++i) {
    const WorstPrism& worst = report.worst[i];
    EXPECT_NEAR(worst.quality, std::get<0>(all[i]), 1e-12);
    const auto& corners = planar.triangles()[static_cast<std::size_t>(worst.triangle)];
    double x = 0;
    for (const std::int32_t c : corners) x += planar.points_m()[static_cast<std::size_t>(c)][0] / 3;
    EXPECT_NEAR(worst.at_m[0], x, 1e-15);
    EXPECT_EQ(worst.num_sublayers, 1);
    EXPECT_GT(worst.z_m, 0);
    EXPECT_FALSE(worst.group.empty());
  }
  EXPECT_TRUE(quality_report(mesh, 0).worst.empty());
}

}  // namespace
}  // namespace pcbmesh::layering
