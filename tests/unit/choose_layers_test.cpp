// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/layering/choose_layers.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "pcbmesh/base/error.hpp"

namespace pcbmesh::layering {
namespace {

using study::HeightPolicy;
using study::SublayerRule;

constexpr Nm um = nm_per_um;

/// Slabs of the given heights from z = 0 up; board layers unless named "air".
std::vector<model::Slab> slabs_of(const std::vector<std::pair<const char*, Nm>>& heights, Nm z = 0) {
  std::vector<model::Slab> slabs;
  for (const auto& [name, height] : heights) {
    model::Slab slab;
    slab.layer = name;
    slab.kind = std::string_view(name) == "air" ? model::SlabKind::air : model::SlabKind::dielectric;
    slab.z_bottom_nm = z;
    slab.z_top_nm = z += height;
    slab.material = 0;
    slabs.push_back(slab);
  }
  return slabs;
}

/// The paper's serpentine: 0.1 / 0.4 / 0.1 / 0.4 / 0.1 mm.
std::vector<model::Slab> serpentine() {
  return slabs_of({{"L1", 100 * um}, {"L2", 400 * um}, {"L3", 100 * um}, {"L4", 400 * um}, {"L5", 100 * um}});
}

HeightStatistics paper_heights() {
  HeightStatistics heights;
  heights.minimum = 2.82843e-4;
  heights.average = 6.59132e-4;
  heights.maximum = 2.32849e-3;
  return heights;
}

std::vector<int> sublayers_per_slab(const mesh::LayerPlan& plan) {
  std::vector<int> counts(static_cast<std::size_t>(plan.num_slabs()), 0);
  for (std::int32_t slab : plan.slab_of_sublayer()) ++counts[static_cast<std::size_t>(slab)];
  return counts;
}

TEST(ChooseLayers, PaperCountsTruncateInSinglePrecisionAndLeaveOtherCasesWhole) {
  const auto slabs = slabs_of({{"L4", 400 * um}, {"L3", 100 * um}, {"L2", 400 * um}, {"L1", 100 * um}});
  EXPECT_EQ(paper_counts(slabs, HeightPolicy::basic), (std::vector<int>{3, 1, 3, 1}))
      << "Table 3, case 1: 8 sub-layers, not 10";
  for (const HeightPolicy policy :
       {HeightPolicy::average, HeightPolicy::maximum, HeightPolicy::minimum, HeightPolicy::thinnest_layer})
    EXPECT_EQ(paper_counts(slabs, policy), (std::vector<int>{1, 1, 1, 1}));
}

TEST(ChooseLayers, WeightedHeightLiesWhereTheParabolasSumIsHighest) {
  HeightStatistics heights = paper_heights();
  heights.weighted = 4.4e-4;
  EXPECT_EQ(common_height_m(HeightPolicy::weighted, heights, serpentine()), 4.4e-4);
  EXPECT_TRUE(feedback_edge_m(HeightPolicy::weighted, 4.4e-4, 2e-3));
  EXPECT_FALSE(common_height_m(HeightPolicy::matched, heights, serpentine()));
  heights.weighted = 0;
  EXPECT_THROW(std::ignore = common_height_m(HeightPolicy::weighted, heights, serpentine()), Error);
}

TEST(ChooseLayers, BestMeanIsTheBestOfAllCounts) {
  HeightStatistics heights;
  heights.bins = {{0.5e-4, 900}, {1.0e-4, 2000}, {1.7e-4, 1500}, {4.0e-4, 300}};
  heights.num_triangles = 5200;
  heights.minimum = 0.5e-4;
  heights.average = 1.3e-4;
  const std::vector<double> layers{0.9e-4, 1.4e-4, 4.1e-4};
  const auto mean = [&](const std::vector<int>& counts) {
    double sum = 0, total = 0;
    for (std::size_t i = 0; i < layers.size(); ++i) {
      sum += counts[i] * mean_quality_at(heights, layers[i] / counts[i]);
      total += counts[i];
    }
    return sum / total;
  };
  double best = 0;
  for (int a = 1; a <= 12; ++a) {
    for (int b = 1; b <= 12; ++b) {
      for (int c = 1; c <= 12; ++c) best = std::max(best, mean({a, b, c}));
    }
  }
  EXPECT_NEAR(mean(best_mean_counts(layers, heights)), best, 1e-12);
  EXPECT_THROW(std::ignore = best_mean_counts(layers, {}), Error);
}

TEST(ChooseLayers, CommonHeightOfTheFivePolicies) {
  const auto slabs = serpentine();
  const auto h = [&](HeightPolicy policy) { return common_height_m(policy, paper_heights(), slabs); };
  EXPECT_EQ(h(HeightPolicy::none), std::nullopt);
  EXPECT_DOUBLE_EQ(h(HeightPolicy::basic).value(), 1e-4);
  EXPECT_DOUBLE_EQ(h(HeightPolicy::average).value(), 6.59132e-4);
  EXPECT_DOUBLE_EQ(h(HeightPolicy::maximum).value(), 2.32849e-3);
  EXPECT_DOUBLE_EQ(h(HeightPolicy::minimum).value(), 2.82843e-4);
  EXPECT_DOUBLE_EQ(h(HeightPolicy::thinnest_layer).value(), 1e-4);
}

TEST(ChooseLayers, AirIsNotTheThinnestLayer) {
  const auto slabs = slabs_of({{"air", 10 * um}, {"L1", 35 * um}, {"L2", 200 * um}, {"air", 5 * um}});
  EXPECT_DOUBLE_EQ(common_height_m(HeightPolicy::basic, {}, slabs).value(), 35e-6);
  EXPECT_THROW(std::ignore = common_height_m(HeightPolicy::basic, {}, slabs_of({{"air", 1000}})), Error);
}

TEST(ChooseLayers, HeightsOfAnEmptyMeshAreRefused) {
  EXPECT_THROW(std::ignore = common_height_m(HeightPolicy::average, {}, serpentine()), Error);
  EXPECT_THROW(std::ignore = num_sublayers(SublayerRule::optimal, 1e-3, 1e-4, {}), Error);
  EXPECT_THROW(std::ignore = num_sublayers(SublayerRule::floor, 1e-3, 0, {}), Error);
  EXPECT_THROW(std::ignore = num_sublayers(SublayerRule::floor, 1e-3, std::nan(""), {}), Error);
}

TEST(ChooseLayers, FeedbackIsForPoliciesTwoToFiveAndShorterHeights) {
  for (HeightPolicy policy :
       {HeightPolicy::average, HeightPolicy::maximum, HeightPolicy::minimum, HeightPolicy::thinnest_layer}) {
    EXPECT_EQ(feedback_edge_m(policy, 1e-4, 2e-3), 1e-4);
    EXPECT_EQ(feedback_edge_m(policy, 2e-3, 2e-3), std::nullopt);
    EXPECT_EQ(feedback_edge_m(policy, 2.32849e-3, 2e-3), std::nullopt);  // Table 3, row 3: the mesh stays
  }
  EXPECT_EQ(feedback_edge_m(HeightPolicy::basic, 1e-4, 2e-3), std::nullopt);
  EXPECT_EQ(feedback_edge_m(HeightPolicy::none, 1e-4, 2e-3), std::nullopt);
}

TEST(ChooseLayers, FloorToleratesRounding) {
  EXPECT_EQ(num_sublayers(SublayerRule::floor, 0.4, 0.1, {}), 4);
  // Differences of levels fall an ulp short of 4: plain truncation gives the paper's 3.
  const double layer = 0.0005 - 0.0001, h = 0.0001;
  ASSERT_LT(std::nextafter(layer, 0.0) / h, 4.0);
  EXPECT_EQ(num_sublayers(SublayerRule::floor, std::nextafter(layer, 0.0), h, {}), 4);
  EXPECT_EQ(num_sublayers(SublayerRule::ceil, std::nextafter(0.4, 1.0), 0.1, {}), 4);
  EXPECT_EQ(num_sublayers(SublayerRule::round, std::nextafter(0.35, 0.0), 0.1, {}), 4);
  EXPECT_EQ(num_sublayers(SublayerRule::floor, 0.4 * (1 - 1e-6), 0.1, {}), 3);
  EXPECT_EQ(num_sublayers(SublayerRule::ceil, 0.4 * (1 + 1e-6), 0.1, {}), 5);
}

TEST(ChooseLayers, RulesRoundAsNamed) {
  const auto count = [](SublayerRule rule, double ratio) { return num_sublayers(rule, ratio * 1e-4, 1e-4, {}); };
  const std::vector<double> ratios{0.2, 1.0, 1.4, 1.6, 2.9, 10.0};
  const std::vector<int> floors{1, 1, 1, 1, 2, 10}, rounds{1, 1, 1, 2, 3, 10}, ceils{1, 1, 2, 2, 3, 10};
  for (std::size_t i = 0; i < ratios.size(); ++i) {
    EXPECT_EQ(count(SublayerRule::floor, ratios[i]), floors[i]);
    EXPECT_EQ(count(SublayerRule::round, ratios[i]), rounds[i]);
    EXPECT_EQ(count(SublayerRule::ceil, ratios[i]), ceils[i]);
    EXPECT_EQ(count(SublayerRule::none, ratios[i]), 1);
  }
  EXPECT_EQ(count(SublayerRule::floor, 1e30), std::numeric_limits<int>::max());
}

TEST(ChooseLayers, OptimalUsesTheFinalMeshNotTheCommonHeight) {
  HeightStatistics heights;
  heights.average = 1e-4;
  for (double h : {1e-5, 1e-3}) {
    EXPECT_EQ(num_sublayers(SublayerRule::optimal, 1.39e-4, h, heights), 1);
    EXPECT_EQ(num_sublayers(SublayerRule::optimal, 1.40e-4, h, heights), 2);
    EXPECT_EQ(num_sublayers(SublayerRule::optimal, 2.44e-4, h, heights), 3);
  }
}

TEST(ChooseLayers, PaperCasesOneAndFiveCutTheThickLayersInFour) {
  const auto plan = choose_layers(serpentine(), SublayerRule::floor, 1e-4, paper_heights());
  EXPECT_EQ(sublayers_per_slab(plan), (std::vector<int>{1, 4, 1, 4, 1}));
  const auto coarse = choose_layers(serpentine(), SublayerRule::floor, 6.59132e-4, paper_heights());
  EXPECT_EQ(sublayers_per_slab(coarse), (std::vector<int>{1, 1, 1, 1, 1}));
}

TEST(ChooseLayers, WithoutCommonHeightOnlyOptimalCuts) {
  HeightStatistics heights;
  heights.average = 1e-4;
  for (SublayerRule rule : {SublayerRule::floor, SublayerRule::round, SublayerRule::ceil, SublayerRule::none}) {
    EXPECT_EQ(choose_layers(serpentine(), rule, std::nullopt, heights).num_sublayers(), 5);
  }
  const auto plan = choose_layers(serpentine(), SublayerRule::optimal, std::nullopt, heights);
  EXPECT_EQ(sublayers_per_slab(plan), (std::vector<int>{1, 4, 1, 4, 1}));
  EXPECT_EQ(choose_layers(serpentine(), SublayerRule::none, 1e-5, heights).num_sublayers(), 5);
}

TEST(ChooseLayers, SlabFacesAreLevelsExactly) {
  const auto slabs = slabs_of({{"air", 1'000'001}, {"a", 35'003}, {"b", 200'057}, {"c", 7}}, -1'000'001);
  const auto plan = choose_layers(slabs, SublayerRule::ceil, 1e-8, paper_heights());
  for (std::int32_t s = 0; s < plan.num_slabs(); ++s) {
    const auto& slab = slabs[static_cast<std::size_t>(s)];
    const auto first = static_cast<std::size_t>(plan.first_sublayer(s)),
               last = static_cast<std::size_t>(plan.first_sublayer(s + 1));
    EXPECT_EQ(plan.z_m()[first], static_cast<double>(slab.z_bottom_nm) * metres_per_nm);
    EXPECT_EQ(plan.z_m()[last], static_cast<double>(slab.z_top_nm) * metres_per_nm);
    const double even = (plan.z_m()[last] - plan.z_m()[first]) / static_cast<double>(last - first);
    for (std::size_t k = first; k < last; ++k) EXPECT_NEAR(plan.height_m(static_cast<std::int32_t>(k)), even, 1e-9 * even);
  }
}

TEST(ChooseLayers, TooManySublayersAreRefusedWithTheLayer) {
  try {
    std::ignore = choose_layers(slabs_of({{"L1", 1'000'000'000}}), SublayerRule::floor, 1e-10, paper_heights());
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::layering_invalid);
    EXPECT_EQ(error.spot().layer, "L1");
  }
  EXPECT_EQ(choose_layers(slabs_of({{"L1", 1'000'000}}), SublayerRule::floor, 1e-9, paper_heights()).num_sublayers(),
            1'000'000);
  EXPECT_THROW(std::ignore = choose_layers({}, SublayerRule::floor, 1e-9, paper_heights()), Error);
}

}  // namespace
}  // namespace pcbmesh::layering
