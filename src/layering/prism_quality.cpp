// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/layering/prism_quality.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>

#include "pcbmesh/base/running_sum.hpp"

namespace pcbmesh::layering {
namespace {

constexpr double sqrt3 = 1.7320508075688772;

double power_three_halves(double x) {
  return x * std::sqrt(x);
}

[[gnu::always_inline]] inline double quality_of(double area, double beta, double height) {
  return 32.0 * sqrt3 / 3.0 * area * height / power_three_halves(beta + height * height);
}

}  // namespace

double triangle_quality(double area, double beta) {
  return 4.0 * sqrt3 * area / beta;
}

double prism_quality(double area, double beta, double height) {
  return quality_of(area, beta, height);
}

void prism_qualities(std::span<const mesh::PrismBase> bases, double height, std::span<double> qualities) {
  for (std::size_t i = 0; i < bases.size(); ++i) qualities[i] = quality_of(bases[i][0], bases[i][1], height);
}

double optimal_height(double beta) {
  return std::sqrt(0.5 * beta);
}

double quality_falloff(double s) {
  return s * power_three_halves(3.0 / (2.0 + s * s));
}

double cut_threshold(int n) {
  // The published form 2 (r - 1) / (1/n^2 - r/(n+1)^2) cancels for large n; this is the same without differences.
  const double r = std::exp(2.0 / 3.0 * std::log1p(1.0 / n));
  return (n + 1.0) * std::sqrt(2.0 / (r * (r + 1.0)));
}

int optimal_cuts(double layer_height, double optimal_height) {
  const double ratio = layer_height / optimal_height;
  if (ratio >= 2147483646.0) return std::numeric_limits<int>::max();
  // s_n lies between n and n + 1/2, so the answer is floor(ratio) or one more, never less.
  int n = std::max(1, static_cast<int>(ratio));
  while (ratio > cut_threshold(n)) ++n;
  return n;
}

double average_edge_height(const std::array<double, 3>& squared_edges) {
  return (std::sqrt(squared_edges[0]) + std::sqrt(squared_edges[1]) + std::sqrt(squared_edges[2])) / 3.0;
}

double nine_edge_quality(double area, double beta, double height) {
  return 36.0 * sqrt3 * area * height / power_three_halves(2.0 * beta + 3.0 * height * height);
}

double mean_quality_at(const HeightStatistics& heights, double height) {
  RunningSum sum;
  for (const HeightBin& bin : heights.bins) sum.add(bin.sum_quality * quality_falloff(height / bin.height));
  return sum.total() / static_cast<double>(heights.num_triangles);
}

double area_quality_at(const HeightStatistics& heights, double height) {
  RunningSum sum, area;
  for (const HeightBin& bin : heights.bins) {
    sum.add(bin.sum_area_quality * quality_falloff(height / bin.height));
    area.add(bin.area_m2);
  }
  return sum.total() / area.total();
}

HeightStatistics height_statistics(const mesh::PlanarMesh& mesh) {
  HeightStatistics result;
  const std::int32_t num_triangles = mesh.num_triangles();
  if (num_triangles == 0) return result;
  const auto height_of = [&](std::int32_t t) {
    const auto squared = mesh.squared_edges_m2(t);
    return optimal_height(squared[0] + squared[1] + squared[2]);
  };
  RunningSum height_sum, quality_sum, over_height, over_square;
  std::map<std::uint32_t, HeightBin> sums;  // few hundred at most; ascending. Heights are summed first, then averaged
  result.minimum = std::numeric_limits<double>::max();
  for (std::int32_t t = 0; t < num_triangles; ++t) {
    const double height = height_of(t);
    result.minimum = std::min(result.minimum, height);
    result.maximum = std::max(result.maximum, height);
    height_sum.add(height);
    const double area = mesh.area_m2(t), quality = triangle_quality(area, 2.0 * height * height);
    quality_sum.add(quality);
    over_height.add(quality / height);
    over_square.add(quality / (height * height));
    // The upper bits of a positive float grow with its value: exponent and 7 bits of mantissa are the bin.
    HeightBin& bin = sums[std::bit_cast<std::uint32_t>(static_cast<float>(height)) >> 16U];
    bin.height += height;
    bin.sum_quality += max_prism_quality * quality;
    bin.count += 1;
    bin.area_m2 += area;
    bin.sum_area_quality += area * max_prism_quality * quality;
  }
  result.num_triangles = num_triangles;
  for (auto [key, bin] : sums) {
    bin.height /= bin.count;
    result.bins.push_back(bin);
  }
  result.weighted = over_height.total() / over_square.total();
  result.average = height_sum.total() / num_triangles;
  result.mean_triangle_quality = quality_sum.total() / num_triangles;
  for (std::int32_t t = 0; t < num_triangles; ++t) result.num_below_average += height_of(t) < result.average ? 1 : 0;
  return result;
}

}  // namespace pcbmesh::layering
