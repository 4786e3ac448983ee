// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/layering/match_quality.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>
#include <vector>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/formats/registry.hpp"
#include "pcbmesh/pipeline/mesh_board.hpp"
#include "sample_prism_mesh.hpp"

namespace pcbmesh::layering {
namespace {

/// Ideal mesh of the predictor: one bin.
HeightStatistics ideal(double edge_m, double area_m2, const TriangleShape& shape) {
  HeightStatistics h;
  const double count = std::round(area_m2 / (shape.area * edge_m * edge_m)), quality = max_prism_quality * shape.triangle_quality;
  h.bins = {{shape.height * edge_m, quality * count, count, area_m2, quality * area_m2}};
  h.num_triangles = std::llround(count);
  h.minimum = h.average = h.maximum = h.weighted = shape.height * edge_m;
  return h;
}

HeightStatistics spread() {
  HeightStatistics h;
  for (const double height : {0.4e-4, 0.9e-4, 1.3e-4, 2.6e-4}) {
    const double count = 500, area = count * height * height;
    h.bins.push_back({height, 0.95 * count, count, area, 0.95 * area});
    h.num_triangles += 500;
  }
  h.minimum = 0.4e-4;
  h.average = h.weighted = 1.3e-4;
  h.maximum = 2.6e-4;
  return h;
}

pipeline::MeshBoardResult mesh_example(const char* name, const study::MatchGoal& goal, study::Study study = {}) {
  study.air_above = study.air_below = 0;
  study.policy = study::HeightPolicy::matched;
  study.match = goal;
  study.seed = study::TriangleSeed::hex;
  study.smooth = true;
  const auto file = std::string(PCBMESH_SOURCE_DIR) + "/examples/" + name + ".json";
  return pipeline::mesh_board(formats::read_board(file).board, study);
}

study::MatchGoal target(double quality) {
  return {quality, std::nullopt, std::nullopt};
}
study::MatchGoal prism_budget(std::int64_t prisms) {
  return {std::nullopt, prisms, std::nullopt};
}
study::MatchGoal unknown_budget(std::int64_t unknowns) {
  return {std::nullopt, std::nullopt, unknowns};
}

double least_of(const QualityStatistics& q) {
  return std::min(q.mean_prism, q.volume_weighted_prism);
}

TEST(MatchQuality, PredictorIsTheOneOfTheEvidenceForAnIdealMesh) {
  const TriangleShape shape = triangle_shape(study::TriangleSeed::delaunay, false);
  const HeightStatistics from = ideal(1e-3, 1e-4, shape), to = predict_heights(from, 1e-3, 2.5e-4, shape);
  EXPECT_NEAR(static_cast<double>(to.num_triangles), 1e-4 / (0.198 * 2.5e-4 * 2.5e-4), 0.01 * static_cast<double>(to.num_triangles));
  // q ~ .912 x 1.0264 x f((H/n) / (.86 L))
  EXPECT_NEAR(mean_quality_at(to, 1e-4), 0.912 * 1.0264 * quality_falloff(1e-4 / (0.86 * 2.5e-4)), 1e-3);
  EXPECT_NEAR(area_quality_at(to, 1e-4), mean_quality_at(to, 1e-4), 1e-6);
}

TEST(MatchQuality, PredictionAtTheMeasuredEdgeIsTheMeasurement) {
  const HeightStatistics from = spread(), to = predict_heights(from, 3e-4, 3e-4, {});
  EXPECT_EQ(to.num_triangles, from.num_triangles);
  for (const double height : {0.2e-4, 1e-4, 5e-4}) {
    EXPECT_NEAR(mean_quality_at(to, height), mean_quality_at(from, height), 1e-3);
    EXPECT_NEAR(area_quality_at(to, height), area_quality_at(from, height), 1e-3);
  }
}

TEST(MatchQuality, SmallTrianglesOfOutlinesStayAndLargeOnesAreCut) {
  const HeightStatistics from = spread(), to = predict_heights(from, 3e-4, 1e-4, {});
  EXPECT_GT(to.num_triangles, from.num_triangles);
  EXPECT_NEAR(to.minimum, 0.4e-4, 1e-9);
  EXPECT_LT(to.maximum, 1e-4);
  double before = 0, after = 0;
  for (const HeightBin& bin : from.bins) before += bin.area_m2;
  for (const HeightBin& bin : to.bins) after += bin.area_m2;
  EXPECT_NEAR(after, before, 1e-9 * before);
}

TEST(MatchQuality, BestCountsAreNearTheBestOfAllCounts) {
  const HeightStatistics heights = spread();
  std::mt19937_64 random(11);
  for (int round = 0; round < 40; ++round) {
    std::vector<double> layers;
    for (int i = 0; i < 3; ++i) layers.push_back(0.3e-4 * std::pow(20.0, static_cast<double>(random() >> 11) * 0x1p-53));
    const std::vector<int> least{1, 1, 1 + static_cast<int>(random() % 2)};
    std::vector<double> best(20, 0);
    for (int a = 1; a <= 6; ++a)
      for (int b = 1; b <= 6; ++b)
        for (int c = least[2]; c <= 6; ++c) {
          const double quality = plan_quality(heights, layers, std::array{a, b, c}).least();
          double& known = best[static_cast<std::size_t>(a + b + c)];
          known = std::max(known, quality);
        }
    for (std::size_t n = 1; n < best.size(); ++n) best[n] = std::max(best[n], best[n - 1]);
    const auto found = best_counts(heights, layers, least);
    for (std::size_t i = 0; i < found.size(); ++i) {
      const CountChoice& choice = found[i];
      EXPECT_GE(choice.counts[2], least[2]);
      EXPECT_NEAR(plan_quality(heights, layers, choice.counts).least(), choice.quality.least(), 1e-9);
      if (i > 0) {
        EXPECT_GT(choice.quality.least(), found[i - 1].quality.least());
        EXPECT_GT(choice.num_sublayers, found[i - 1].num_sublayers);
      }
      if (choice.num_sublayers < 8) {
        EXPECT_GE(choice.quality.least(), best[static_cast<std::size_t>(choice.num_sublayers)] - 0.01);
      }
    }
  }
}

TEST(MatchQuality, FrontAscendsAndItsKneeLiesInside) {
  const MeasuredEdge measured{1e-3, ideal(1e-3, 1e-4, {})};
  const std::vector<double> layers{1e-4, 4e-4, 1e-4};
  const auto front = pareto_front(std::array{measured}, layers, std::array{1, 1, 1}, {}, 0, 1e7);
  ASSERT_GT(front.size(), 10U);
  for (std::size_t i = 1; i < front.size(); ++i) {
    EXPECT_GT(front[i].prisms, front[i - 1].prisms);
    EXPECT_GT(front[i].choice.quality.least(), front[i - 1].choice.quality.least());
  }
  EXPECT_LE(front.back().prisms, 1e7);
  const std::size_t knee = knee_of(front);
  EXPECT_GT(knee, 0U);
  EXPECT_LT(knee, front.size() - 1);
  EXPECT_TRUE(pareto_front(std::array{measured}, layers, std::array{1, 1, 1}, {}, 0, 10).empty());
}

TEST(MatchQuality, EdgesAreThoseOfTheMesh) {
  const auto mesh = mesh::PrismMesh::from_parts(testing::sample_parts());
  std::vector<std::array<std::int64_t, 6>> prisms(static_cast<std::size_t>(mesh.num_prisms()));
  mesh.fill_prisms(0, prisms);
  std::set<std::pair<std::int64_t, std::int64_t>> edges;
  for (const auto& p : prisms)
    for (const auto& [i, j] : {std::pair{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}})
      edges.insert(std::minmax(p[static_cast<std::size_t>(i)], p[static_cast<std::size_t>(j)]));
  EXPECT_EQ(num_edges(mesh), static_cast<std::int64_t>(edges.size()));
}

TEST(MatchQuality, TargetIsMetOnTheMeshWithFewerPrismsThanThePaper) {
  const auto result = mesh_example("via", target(0.7614));
  EXPECT_GE(least_of(result.quality), 0.7614);
  EXPECT_LE(result.mesh.num_prisms(), 90'000) << "the paper's policy: 937,860";
  ASSERT_TRUE(result.match);
  const pipeline::MatchStep& chosen = result.match->steps[result.match->chosen];
  EXPECT_EQ(chosen.prisms, result.mesh.num_prisms()) << "the mesh verified is the mesh given";
  EXPECT_EQ(chosen.mean_prism, result.quality.mean_prism);
  EXPECT_EQ(chosen.unknowns, num_edges(result.mesh));
  for (const pipeline::MatchStep& step : result.match->steps)
    if (step.meets) {
      EXPECT_GE(step.prisms, chosen.prisms);
    }
}

TEST(MatchQuality, BudgetsAreKeptAndSpent) {
  const auto prisms = mesh_example("serpentine", prism_budget(20'000));
  EXPECT_LE(prisms.mesh.num_prisms(), 20'000);
  EXPECT_GE(prisms.mesh.num_prisms(), 16'000);
  EXPECT_GE(least_of(prisms.quality), 0.78);
  const auto unknowns = mesh_example("serpentine", unknown_budget(40'000));
  EXPECT_LE(num_edges(unknowns.mesh), 40'000);
  EXPECT_GE(num_edges(unknowns.mesh), 32'000);
}

TEST(MatchQuality, GoalAndBoundsHoldTogetherAndVoidsAreSeen) {
  study::Study study;
  study.conductors = study::ConductorMode::hollow;
  study.height_bounds.elements_per_dielectric = 3;
  study.height_bounds.height_growth = 2;
  const auto result = mesh_example("serpentine", target(0.85), study);
  EXPECT_GE(least_of(result.quality), 0.85);
  for (const LayerChoice& layer : result.layers)
    if (layer.layer == "L2" || layer.layer == "L4") {
      EXPECT_GE(layer.count, 3);
    }
  for (std::int32_t k = 1; k < result.mesh.plan().num_sublayers(); ++k) {
    const double ratio = result.mesh.plan().height_m(k) / result.mesh.plan().height_m(k - 1);
    EXPECT_LE(std::max(ratio, 1 / ratio), 2 * (1 + 1e-6));
  }
}

TEST(MatchQuality, WhatCannotBeReachedIsRefusedWithWhatCan) {
  study::Study study;
  study.max_prisms = 200'000;
  for (const study::MatchGoal& goal : {target(1.02), prism_budget(100)}) {
    try {
      (void)mesh_example("serpentine", goal, study);
      ADD_FAILURE() << "accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::target_unreachable);
      EXPECT_NE(error.text().find("the best has quality"), std::string::npos) << error.text();
    }
  }
}

TEST(MatchQuality, WithoutAGoalTheKneeIsTaken) {
  const auto result = mesh_example("serpentine", {});
  ASSERT_TRUE(result.match);
  const double knee = result.match->front[result.match->knee].prisms;
  EXPECT_NEAR(std::log(static_cast<double>(result.mesh.num_prisms()) / knee), 0, 0.2);
}

}  // namespace
}  // namespace pcbmesh::layering
