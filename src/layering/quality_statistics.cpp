// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include "pcbmesh/base/running_sum.hpp"
#include "pcbmesh/layering/prism_quality.hpp"

namespace pcbmesh::layering {
namespace {

std::size_t index(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

/// Counts of values in (0, 2) in bins of relative width 2^-12, and their quantiles.
class QualityHistogram {
 public:
  void add(double value, std::int64_t count) { counts_[bin_of(static_cast<float>(value))] += count; }

  /// Value below which `rank` of the counted values lie, interpolated inside its bin.
  [[nodiscard]] double value_at(double rank) const {
    double before = 0;
    for (std::size_t bin = 0; bin < counts_.size(); ++bin) {
      const auto count = static_cast<double>(counts_[bin]);
      if (count > 0 && before + count > rank) {
        const double low = edge(bin), high = edge(bin + 1);
        return low + (high - low) * (rank - before) / count;
      }
      before += count;
    }
    return 2.0;
  }

 private:
  // The upper bits of a positive float grow with its value: exponent and 12 bits of mantissa are the bin.
  static constexpr std::uint32_t shift = 11;
  static constexpr std::uint32_t first = (127U - 20U) << 23U >> shift;  ///< 2^-20; smaller values share bin 0
  static constexpr std::uint32_t last = 128U << 23U >> shift;           ///< 2
  static std::size_t bin_of(float value) {
    return std::clamp(std::bit_cast<std::uint32_t>(value) >> shift, first, last - 1) - first;
  }
  static double edge(std::size_t bin) {
    return static_cast<double>(std::bit_cast<float>((first + static_cast<std::uint32_t>(bin)) << shift));
  }
  std::vector<std::int64_t> counts_ = std::vector<std::int64_t>(last - first, 0);
};

/// Distinct sub-layer heights, ascending, and how many sub-layers of each height stand on each region.
struct HeightTable {
  std::vector<double> heights;
  std::vector<std::int64_t> counts;  ///< [region * heights.size() + height]
};

HeightTable tabulate_heights(const mesh::PrismMesh& mesh) {
  const mesh::LayerPlan& plan = mesh.plan();
  HeightTable table;
  std::vector<double> all;
  for (std::int32_t k = 0; k < plan.num_sublayers(); ++k) all.push_back(plan.height_m(k));
  std::sort(all.begin(), all.end());
  for (double height : all) {
    if (table.heights.empty() || height > table.heights.back() * (1.0 + 1e-9)) table.heights.push_back(height);
  }
  const std::size_t num_heights = table.heights.size();
  std::vector<std::int64_t> per_slab(index(plan.num_slabs()) * num_heights, 0);
  for (std::int32_t k = 0; k < plan.num_sublayers(); ++k) {
    const auto found =
        std::upper_bound(table.heights.begin(), table.heights.end(), plan.height_m(k)) - table.heights.begin() - 1;
    ++per_slab[index(plan.slab_of_sublayer()[index(k)]) * num_heights + static_cast<std::size_t>(found)];
  }
  table.counts.assign(index(mesh.planar().num_regions()) * num_heights, 0);
  std::vector<bool> is_done(index(mesh.planar().num_regions()), false);
  for (std::int32_t t = 0; t < mesh.planar().num_triangles(); ++t) {
    const std::size_t region = index(mesh.planar().regions()[index(t)]);
    if (is_done[region]) continue;
    is_done[region] = true;
    for (std::int32_t slab = 0; slab < plan.num_slabs(); ++slab) {
      if (mesh.tag_of(slab, t) < 0) continue;
      for (std::size_t h = 0; h < num_heights; ++h) {
        table.counts[region * num_heights + h] += per_slab[index(slab) * num_heights + h];
      }
    }
  }
  return table;
}

/// Extremes of the planar triangles that carry prisms.
struct PlanarExtremes {
  double longest_squared = 0, shortest_squared = std::numeric_limits<double>::max();
  double largest_cotangent = 0;  ///< of the smallest angle
  void add(const std::array<double, 3>& squared, double area) {
    const auto [low, high] = std::minmax({squared[0], squared[1], squared[2]});
    longest_squared = std::max(longest_squared, high);
    shortest_squared = std::min(shortest_squared, low);
    const double beta = squared[0] + squared[1] + squared[2];
    largest_cotangent = std::max(largest_cotangent, (beta - 2.0 * low) / (4.0 * area));
  }
};

}  // namespace

QualityStatistics quality_statistics(const mesh::PrismMesh& mesh) {
  QualityStatistics result;
  if (mesh.num_prisms() == 0) return result;
  const mesh::PlanarMesh& planar = mesh.planar();
  const HeightTable table = tabulate_heights(mesh);
  const std::size_t num_heights = table.heights.size();
  QualityHistogram histogram;
  PlanarExtremes extremes;
  RunningSum triangle_sum, prism_sum, weighted_sum, volume_sum;
  std::int64_t num_triangles = 0;
  result.min_triangle = result.min_prism = std::numeric_limits<double>::max();
  for (std::int32_t t = 0; t < planar.num_triangles(); ++t) {
    const std::int64_t* counts = table.counts.data() + index(planar.regions()[index(t)]) * num_heights;
    const auto squared = planar.squared_edges_m2(t);
    const double area = planar.area_m2(t), beta = squared[0] + squared[1] + squared[2];
    bool carries_prisms = false;
    for (std::size_t h = 0; h < num_heights; ++h) {
      if (counts[h] == 0) continue;
      carries_prisms = true;
      const double quality = prism_quality(area, beta, table.heights[h]);
      const auto count = static_cast<double>(counts[h]);
      const double volume = count * area * table.heights[h];
      result.min_prism = std::min(result.min_prism, quality);
      prism_sum.add(count * quality);
      weighted_sum.add(volume * quality);
      volume_sum.add(volume);
      histogram.add(quality, counts[h]);
    }
    if (!carries_prisms) continue;
    const double quality = triangle_quality(area, beta);
    ++num_triangles;
    triangle_sum.add(quality);
    result.min_triangle = std::min(result.min_triangle, quality);
    extremes.add(squared, area);
  }
  result.mean_triangle = triangle_sum.total() / static_cast<double>(num_triangles);
  result.mean_prism = prism_sum.total() / static_cast<double>(mesh.num_prisms());
  result.volume_weighted_prism = weighted_sum.total() / volume_sum.total();
  result.quantile1_prism = std::max(result.min_prism, histogram.value_at(0.01 * static_cast<double>(mesh.num_prisms())));
  result.min_angle_deg = std::atan2(1.0, extremes.largest_cotangent) * 180.0 / std::numbers::pi;
  result.longest_edge_m = std::sqrt(extremes.longest_squared);
  result.shortest_edge_m = std::sqrt(extremes.shortest_squared);
  return result;
}

}  // namespace pcbmesh::layering
