// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/layering/choose_layers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/layering/divide_layers.hpp"

namespace pcbmesh::layering {
namespace {

using study::HeightPolicy;
using study::SublayerRule;

constexpr int most_sublayers_of_slab = 1'000'000;
// Heights come from divisions and sums of decimal lengths: 0.4 / 0.1 must count as 4 although it may fall an ulp short.
constexpr double ratio_tolerance = 1e-9;

double height_m(const model::Slab& slab) {
  return static_cast<double>(slab.z_top_nm - slab.z_bottom_nm) * metres_per_nm;
}

void require_positive(double height, const char* what) {
  if (height > 0 && std::isfinite(height)) return;
  throw Error(
      ErrorCode::layering_invalid,
      fmt::format("{} is {} m, but sub-layers need a positive height; check the stackup and the height policy", what, height));
}

double thinnest_board_slab_m(std::span<const model::Slab> slabs) {
  double thinnest = std::numeric_limits<double>::infinity();
  for (const model::Slab& slab : slabs) {
    if (slab.kind != model::SlabKind::air) thinnest = std::min(thinnest, height_m(slab));
  }
  if (!std::isfinite(thinnest)) {
    throw Error(ErrorCode::layering_invalid,
                "the thinnest layer is asked for, but the domain has no board layer; choose height policy none");
  }
  return thinnest;
}

int to_count(double count) {
  if (count >= static_cast<double>(std::numeric_limits<int>::max())) return std::numeric_limits<int>::max();
  return std::max(1, static_cast<int>(count));
}

}  // namespace

std::optional<double> common_height_m(HeightPolicy policy, const HeightStatistics& heights,
                                      std::span<const model::Slab> slabs) {
  const auto from_mesh = [](double height) {
    require_positive(height, "the optimal height of the planar mesh");
    return height;
  };
  switch (policy) {
    case HeightPolicy::none:
    case HeightPolicy::matched:
      return std::nullopt;
    case HeightPolicy::basic:
    case HeightPolicy::thinnest_layer:
      return thinnest_board_slab_m(slabs);
    case HeightPolicy::average:
      return from_mesh(heights.average);
    case HeightPolicy::maximum:
      return from_mesh(heights.maximum);
    case HeightPolicy::minimum:
      return from_mesh(heights.minimum);
    case HeightPolicy::weighted:
      return from_mesh(heights.weighted);
  }
  report_bug("known height policy", __FILE__, __LINE__);
}

std::optional<double> feedback_edge_m(HeightPolicy policy, double common_height_m, double longest_edge_m) {
  const bool feeds_back = policy != HeightPolicy::none && policy != HeightPolicy::basic;
  if (feeds_back && common_height_m < longest_edge_m) return common_height_m;
  return std::nullopt;
}

int num_sublayers(SublayerRule rule, double layer_height_m, double common_height_m, const HeightStatistics& final_heights) {
  if (rule == SublayerRule::none) return 1;
  require_positive(layer_height_m, "a layer height");
  if (rule == SublayerRule::optimal) {
    require_positive(final_heights.average, "the mean optimal height of the final mesh");
    return optimal_cuts(layer_height_m, final_heights.average);
  }
  require_positive(common_height_m, "the common prism height");
  const double ratio = layer_height_m / common_height_m;
  switch (rule) {
    case SublayerRule::floor:
      return to_count(std::floor(ratio + ratio_tolerance));
    case SublayerRule::round:
      return to_count(std::floor(ratio + 0.5 + ratio_tolerance));
    case SublayerRule::ceil:
      return to_count(std::ceil(ratio - ratio_tolerance));
    case SublayerRule::none:
    case SublayerRule::optimal:
    case SublayerRule::best_mean:  // not layer by layer
      break;
  }
  report_bug("known sub-layer rule", __FILE__, __LINE__);
}

std::vector<int> best_mean_counts(std::span<const double> layer_heights_m, const HeightStatistics& final_heights) {
  require_positive(final_heights.average, "the mean optimal height of the final mesh");
  // Quality by count of each layer, well past the count of its best quality: beyond, more cuts only lose.
  std::vector<std::vector<double>> quality;
  for (const double height : layer_heights_m) {
    require_positive(height, "a layer height");
    const int most =
        std::min(2 * optimal_cuts(height, final_heights.minimum) + 2, 2 * optimal_cuts(height, final_heights.average) + 8);
    std::vector<double>& of_layer = quality.emplace_back();
    for (int n = 1; n <= std::min(most, most_sublayers_of_slab); ++n)
      of_layer.push_back(mean_quality_at(final_heights, height / n));
  }
  std::vector<int> counts(quality.size(), 1), best;
  for (int round = 0; round < 100 && counts != best; ++round) {
    best = counts;
    double sum = 0, total = 0;
    for (std::size_t i = 0; i < quality.size(); ++i) {
      sum += best[i] * quality[i][static_cast<std::size_t>(best[i] - 1)];
      total += best[i];
    }
    const double ratio = sum / total;
    for (std::size_t i = 0; i < quality.size(); ++i) {
      double most = -std::numeric_limits<double>::infinity();
      for (std::size_t n = 1; n <= quality[i].size(); ++n) {
        const double gain = static_cast<double>(n) * (quality[i][n - 1] - ratio);
        if (gain > most + 1e-12) {  // on a tie the smaller
          most = gain;
          counts[i] = static_cast<int>(n);
        }
      }
    }
  }
  return best;
}

std::vector<int> sublayer_counts(std::span<const model::Slab> slabs, SublayerRule rule, std::optional<double> common_height_m,
                                 const HeightStatistics& final_heights) {
  std::vector<double> heights;
  for (const model::Slab& slab : slabs) heights.push_back(height_m(slab));
  if (rule == SublayerRule::best_mean) return best_mean_counts(heights, final_heights);
  std::vector<int> counts(slabs.size(), 1);
  if (!common_height_m && rule != SublayerRule::optimal) return counts;
  for (std::size_t s = 0; s < slabs.size(); ++s)
    counts[s] = num_sublayers(rule, heights[s], common_height_m.value_or(0), final_heights);
  return counts;
}

std::vector<int> paper_counts(std::span<const model::Slab> slabs, HeightPolicy policy) {
  std::vector<int> counts(slabs.size(), 1);
  if (policy != HeightPolicy::basic) return counts;
  const auto z_m = [&](Nm z) { return static_cast<float>(static_cast<double>(z - slabs.front().z_bottom_nm) * metres_per_nm); };
  const auto height = [&](const model::Slab& slab) { return z_m(slab.z_top_nm) - z_m(slab.z_bottom_nm); };
  float thinnest = std::numeric_limits<float>::infinity();
  for (const model::Slab& slab : slabs)
    if (slab.kind != model::SlabKind::air) thinnest = std::min(thinnest, height(slab));
  for (std::size_t s = 0; s < slabs.size(); ++s) counts[s] = to_count(static_cast<double>(height(slabs[s]) / thinnest));
  return counts;
}

mesh::LayerPlan choose_layers(std::span<const model::Slab> slabs, SublayerRule rule, std::optional<double> common_height_m,
                              const HeightStatistics& final_heights) {
  const std::vector<SlabLimits> unlimited(slabs.size());
  return divide_layers(slabs, sublayer_counts(slabs, rule, common_height_m, final_heights), unlimited, std::nullopt).plan;
}

}  // namespace pcbmesh::layering
