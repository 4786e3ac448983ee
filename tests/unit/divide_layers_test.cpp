// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/layering/divide_layers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <vector>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/layering/prism_quality.hpp"
#include "sample_prism_mesh.hpp"

namespace pcbmesh::layering {
namespace {

constexpr Nm um = nm_per_um;
constexpr double inf = std::numeric_limits<double>::infinity();

std::vector<model::Slab> slabs_of(const std::vector<Nm>& heights) {
  std::vector<model::Slab> slabs;
  Nm z = 0;
  for (const Nm height : heights) {
    model::Slab slab;
    slab.layer = "L" + std::to_string(slabs.size());
    slab.z_bottom_nm = z;
    slab.z_top_nm = z += height;
    slab.material = 0;
    slabs.push_back(slab);
  }
  return slabs;
}

/// air | copper | FR4 | copper | air, the lower copper hollow; FR4 is magnetic so that mu counts.
model::Model microstrip(double sigma) {
  model::ModelParts parts;
  parts.materials = {{"air"}, {"FR4", 4.0, 0.02, 2.25}, {"copper", 1, 0, 1, sigma}};
  parts.nets = {"A"};
  parts.slabs = slabs_of({1000 * um, 35 * um, 200 * um, 35 * um, 1000 * um});
  for (model::Slab& slab : parts.slabs) slab.kind = model::SlabKind::air;
  parts.slabs[1].kind = parts.slabs[3].kind = model::SlabKind::copper;
  parts.slabs[2].kind = model::SlabKind::dielectric;
  parts.slabs[2].material = 1;
  parts.bodies = {{"domain", model::BodyKind::domain, -1, board::no_net, 0, 4},
                  {"board", model::BodyKind::board, -1, board::no_net, 0, 4},
                  {"lower", model::BodyKind::copper, 2, 0, 1, 1, 0, true},
                  {"upper", model::BodyKind::copper, 2, 0, 3, 3, 0, false},
                  {"barrel", model::BodyKind::barrel, 2, 0, 1, 3, 1, false}};
  return model::Model::from_parts(std::move(parts));
}

void expect_obeyed(const std::vector<double>& h, double height, double bottom, double top, double most, double growth) {
  EXPECT_NEAR(std::accumulate(h.begin(), h.end(), 0.0), height, 1e-9 * height);
  EXPECT_LE(h.front(), bottom * (1 + 1e-9));
  EXPECT_LE(h.back(), top * (1 + 1e-9));
  for (std::size_t k = 0; k < h.size(); ++k) {
    EXPECT_GT(h[k], 0);
    EXPECT_LE(h[k], most * (1 + 1e-9));
    if (k == 0) continue;
    EXPECT_LE(h[k], growth * h[k - 1] * (1 + 1e-8));
    EXPECT_LE(h[k - 1], growth * h[k] * (1 + 1e-8));
  }
}

TEST(DivideLayers, GradedHeightsObeyTheirBoundsForRandomOnes) {
  std::mt19937_64 random(3);
  const auto real = [&](double low, double high) {
    return low * std::pow(high / low, static_cast<double>(random() >> 11) * 0x1p-53);
  };
  for (int round = 0; round < 2000; ++round) {
    const double height = real(1, 1000), most = real(0.01, 2) * height, growth = real(1.1, 5);
    const double bottom = real(1e-3, 2) * height, top = real(1e-3, 2) * height;
    expect_obeyed(graded_heights(height, bottom, top, most, growth), height, bottom, top, most, growth);
  }
}

TEST(DivideLayers, GradedHeightsAreGeometricAndNoMoreThanNeeded) {
  // 1 + 2 + 4 + ... + 64 = 127: seven sub-layers are the fewest that start at 1 and grow by 2.
  const std::vector<double> h = graded_heights(127, 1, 1e9, 1e9, 2);
  ASSERT_EQ(h.size(), 7U);
  for (std::size_t k = 0; k < 7; ++k) EXPECT_NEAR(h[k], std::exp2(static_cast<double>(k)), 1e-9);
  EXPECT_EQ(graded_heights(100, 25, 25, 25, 1.5).size(), 4U);
  const std::vector<double> both = graded_heights(62, 1, 1, 1e9, 2);
  for (std::size_t k = 0; k < both.size(); ++k) EXPECT_NEAR(both[k], both[both.size() - 1 - k], 1e-9) << "symmetric";
}

TEST(DivideLayers, D1_D2_D3_HoldAcrossFacesForRandomStacks) {
  std::mt19937_64 random(5);
  const auto real = [&](double low, double high) {
    return low * std::pow(high / low, static_cast<double>(random() >> 11) * 0x1p-53);
  };
  for (int round = 0; round < 300; ++round) {
    std::vector<Nm> heights;
    for (std::uint64_t i = 0; i < 1 + random() % 9; ++i) heights.push_back(static_cast<Nm>(real(500, 3e6)));
    const std::vector<model::Slab> slabs = slabs_of(heights);
    std::vector<int> counts;
    std::vector<SlabLimits> limits(slabs.size());
    for (SlabLimits& limit : limits) {
      counts.push_back(static_cast<int>(1 + random() % 5));
      if (random() % 3 == 0) limit.face_height_m = real(1e-8, 1e-4);
      if (random() % 3 == 0) limit.wavelength_height_m = real(1e-5, 1e-2);
      limit.least_count = static_cast<int>(1 + random() % 4);
    }
    const double growth = round % 3 == 0 ? 1.1 : real(1.1, 4);
    const DividedLayers divided = divide_layers(slabs, counts, limits, growth);
    const mesh::LayerPlan& plan = divided.plan;
    for (std::int32_t k = 0; k < plan.num_sublayers(); ++k) {
      const auto s = static_cast<std::size_t>(plan.slab_of_sublayer()[static_cast<std::size_t>(k)]);
      const double height = plan.height_m(k);
      const double layer = static_cast<double>(heights[s]) * 1e-9;
      EXPECT_LE(height, layer / std::max(counts[s], limits[s].least_count) * (1 + 1e-8)) << "D1";
      EXPECT_LE(height, limits[s].wavelength_height_m * (1 + 1e-8)) << "D1";
      if (k == plan.first_sublayer(static_cast<std::int32_t>(s)) ||
          k + 1 == plan.first_sublayer(static_cast<std::int32_t>(s) + 1)) {
        EXPECT_LE(height, limits[s].face_height_m * (1 + 1e-8)) << "D2";
      }
      if (k > 0) {
        const double ratio = height / plan.height_m(k - 1);
        EXPECT_LE(std::max(ratio, 1 / ratio), growth * (1 + 1e-6)) << "D3";
      }
    }
    for (std::size_t s = 0; s < slabs.size(); ++s) {
      const auto id = static_cast<std::int32_t>(s);
      EXPECT_EQ(plan.z_m()[static_cast<std::size_t>(plan.first_sublayer(id + 1))],
                static_cast<double>(slabs[s].z_top_nm) * 1e-9);
      EXPECT_EQ(divided.layers[s].count, plan.first_sublayer(id + 1) - plan.first_sublayer(id));
    }
  }
}

TEST(DivideLayers, EachBoundIsNamedWhereItDecides) {
  const auto slabs = slabs_of({100 * um, 100 * um, 100 * um, 100 * um, 100 * um, 100 * um});
  std::vector<SlabLimits> limits(6);
  limits[5].port_count = 2;
  limits[1].wavelength_height_m = 30e-6;
  limits[2].least_count = 3;
  const std::vector<int> counts{1, 2, 2, 2, 1, 1};
  const DividedLayers equal = divide_layers(slabs, counts, limits, std::nullopt);
  const auto cause = [](const DividedLayers& d, std::size_t s) { return d.layers[s].cause; };
  EXPECT_EQ(cause(equal, 0), HeightCause::slab);
  EXPECT_EQ(cause(equal, 1), HeightCause::wavelength);
  EXPECT_EQ(equal.layers[1].count, 4);
  EXPECT_EQ(cause(equal, 2), HeightCause::across);
  EXPECT_EQ(equal.layers[2].count, 3);
  EXPECT_EQ(cause(equal, 3), HeightCause::policy);
  EXPECT_EQ(cause(equal, 5), HeightCause::port);
  EXPECT_EQ(equal.layers[5].count, 2);
  limits[4].face_height_m = 1e-6;
  const DividedLayers graded = divide_layers(slabs, counts, limits, std::nullopt);
  EXPECT_EQ(cause(graded, 4), HeightCause::skin_depth);
  EXPECT_EQ(cause(graded, 3), HeightCause::growth);
  EXPECT_EQ(graded.layers[3].policy_count, 2);
  EXPECT_GT(graded.layers[3].count, 2);
  EXPECT_LE(graded.layers[4].lowest_m, 1e-6);
}

TEST(DivideLayers, TooManySubLayersAreRefusedWithTheLayer) {
  const auto slabs = slabs_of({100 * um});
  std::vector<SlabLimits> limits(1);
  limits[0].wavelength_height_m = 1e-12;
  try {
    (void)divide_layers(slabs, std::vector<int>{1}, limits, std::nullopt);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::layering_invalid);
    EXPECT_EQ(error.spot().layer, "L0");
  }
  EXPECT_THROW((void)divide_layers({}, std::vector<int>{}, {}, std::nullopt), Error);
}

TEST(SlabLimits, WavelengthIsOfTheLocalMaterial) {
  study::Study study;
  study.frequency_hz = 10e9;
  study.height_bounds.elements_per_wavelength = 10;
  const auto limits = slab_limits(microstrip(5.8e7), study);
  const double vacuum = 299'792'458.0 / 10e9 / 10;
  EXPECT_NEAR(limits[0].wavelength_height_m, vacuum, 1e-12);
  EXPECT_NEAR(limits[2].wavelength_height_m, vacuum / 3, 1e-12) << "sqrt(4 x 2.25)";
  EXPECT_NEAR(limits[3].wavelength_height_m, vacuum, 1e-12);
  EXPECT_EQ(limits[3].face_height_m, inf) << "skin depth not asked for";
  study.frequency_hz.reset();
  EXPECT_EQ(slab_limits(microstrip(5.8e7), study)[2].wavelength_height_m, inf);
}

TEST(SlabLimits, ElementsAcrossADielectricLeaveCopperAndAirAlone) {
  study::Study study;
  study.height_bounds.elements_per_dielectric = 3;
  const auto limits = slab_limits(microstrip(0), study);
  EXPECT_EQ(limits[0].least_count, 1);
  EXPECT_EQ(limits[1].least_count, 1);
  EXPECT_EQ(limits[2].least_count, 3);
}

TEST(SlabLimits, SkinDepthGradesMeshedCopperAndWhatLiesNextToIt) {
  study::Study study;
  study.frequency_hz = 10e9;
  study.height_bounds.skin_depth_layers = 3;
  const model::Model model = microstrip(5.8e7);
  const auto limits = slab_limits(model, study);
  const double depth = std::sqrt(2 / (2 * std::numbers::pi * 10e9 * 4e-7 * std::numbers::pi * 5.8e7));
  EXPECT_NEAR(limits[3].skin_depth_m, depth, 1e-12);
  EXPECT_NEAR(limits[3].skin_depth_m, 0.66e-6, 0.005e-6) << "copper at 10 GHz, as every handbook has it";
  EXPECT_NEAR(limits[3].face_height_m, depth / 7, 1e-12) << "1 + 2 + 4";
  EXPECT_EQ(limits[1].skin_depth_m, 0) << "hollow copper holds no field";
  EXPECT_EQ(limits[2].skin_depth_m, 0) << "a barrel's wall is upright";
  const mesh::LayerPlan plan = divide_layers(model.slabs(), std::vector<int>(5, 1), limits, std::nullopt).plan;
  const std::int32_t copper = plan.first_sublayer(3);
  EXPECT_LE(plan.z_m()[static_cast<std::size_t>(copper) + 3] - plan.z_m()[static_cast<std::size_t>(copper)], depth * (1 + 1e-9))
      << "three sub-layers in the first skin depth";
  EXPECT_LE(plan.height_m(copper - 1), 2 * plan.height_m(copper) * (1 + 1e-9)) << "the dielectric below starts as fine";
}

TEST(SlabLimits, CopperWithoutConductivityIsRefusedByName) {
  study::Study study;
  study.frequency_hz = 1e9;
  study.height_bounds.skin_depth_layers = 2;
  try {
    (void)slab_limits(microstrip(0), study);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::layering_invalid);
    EXPECT_NE(error.text().find("'copper'"), std::string::npos) << error.text();
    EXPECT_EQ(error.spot().layer, "L3");
  }
}

TEST(ExplainLayers, CountsAndQualityAreThoseOfTheMesh) {
  const auto mesh = mesh::PrismMesh::from_parts(testing::sample_parts());
  const mesh::LayerPlan& plan = mesh.plan();
  std::vector<LayerChoice> layers;
  for (std::int32_t s = 0; s < plan.num_slabs(); ++s) {
    const double height = plan.z_m()[static_cast<std::size_t>(plan.first_sublayer(s + 1))] -
                          plan.z_m()[static_cast<std::size_t>(plan.first_sublayer(s))];
    const int count = plan.first_sublayer(s + 1) - plan.first_sublayer(s);
    LayerChoice choice;
    choice.height_m = height;
    choice.count = count;
    choice.lowest_m = inf;
    for (std::int32_t k = plan.first_sublayer(s); k < plan.first_sublayer(s + 1); ++k) {
      choice.lowest_m = std::min(choice.lowest_m, plan.height_m(k));
      choice.highest_m = std::max(choice.highest_m, plan.height_m(k));
    }
    layers.push_back(choice);
  }
  const auto explained = explain_layers(mesh, layers);
  std::int64_t prisms = 0;
  double quality = 0;
  for (std::size_t s = 0; s < explained.size(); ++s) {
    const LayerExplanation& e = explained[s];
    prisms += e.prisms_after;
    quality += e.quality_after * static_cast<double>(e.prisms_after);
    EXPECT_EQ(e.prisms_before, e.num_triangles);
    EXPECT_LT(e.sensitivity_per_m2, 0);
  }
  EXPECT_EQ(prisms, mesh.num_prisms());
  EXPECT_NEAR(quality / static_cast<double>(prisms), quality_statistics(mesh).mean_prism, 1e-4);
}

}  // namespace
}  // namespace pcbmesh::layering
