// SPDX-License-Identifier: GPL-3.0-or-later
// The domain: polygons, perfectly matched layers, periodic pairs.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "formats/native_json/format.hpp"
#include "pcbmesh/base/error.hpp"
#include "pcbmesh/compose/compose.hpp"
#include "pcbmesh/pipeline/mesh_board.hpp"

namespace pcbmesh {
namespace {

/// Lines from side to side, one of them bent but whole after a period of 10 mm, over a plane with holes.
board::Board make_board() {
  return formats::native_json::parse_board(R"({"pcbmesh_board": 1, "outline": {"rect": [[0, 0], [40, 20]]},
    "materials": [{"name": "core", "eps_r": 4}],
    "stackup": [{"name": "top", "kind": "copper", "thickness": "35um"},
      {"name": "core", "kind": "dielectric", "thickness": "500um", "material": "core"},
      {"name": "bottom", "kind": "copper", "thickness": "35um"}],
    "nets": ["GND", "A", "B"],
    "tracks": [{"layer": "top", "net": "A", "width": "0.5mm", "points": [[2, 8], [38, 8]]},
      {"layer": "top", "net": "B", "width": "0.3mm",
       "points": [[2, 11], [10, 11], [14, 12], [16, 10], [20, 11], [24, 12], [26, 10], [30, 11], [38, 11]]}],
    "planes": [{"layer": "bottom", "net": "GND", "rect": [[1, 1], [39, 19]],
      "holes": [{"circle": {"at": [20, 9], "diameter": 2}}]}]})",
                                           "lines.json")
      .board;
}

study::Study parsed(const std::string& members) {
  return study::parse_study(R"({"schema_version": 1, )" + members + "}", "s.json");
}

model::Model composed(const std::string& members) {
  Diagnostics ignored;
  return compose::compose(make_board(), parsed(members), ignored);
}

/// Ids of the planar vertices on a side, by their place along it.
std::vector<std::int32_t> on_side(const mesh::PlanarMesh& planar, std::size_t axis, double at_m) {
  std::vector<std::int32_t> ids;
  for (std::int32_t v = 0; v < planar.num_points(); ++v)
    if (planar.points_m()[static_cast<std::size_t>(v)][axis] == at_m) ids.push_back(v);
  std::ranges::sort(ids, {}, [&](std::int32_t v) { return planar.points_m()[static_cast<std::size_t>(v)][1 - axis]; });
  return ids;
}

TEST(PeriodicSides, T6_BothSidesHaveTheSameVerticesInTheSameOrder) {
  for (const char* more :
       {"", R"(, "mesh": {"seed": "hex", "smooth": true})", R"(, "mesh": {"edge_at_copper": 0.1, "longest_edge": 1})",
        R"(, "mesh": {"longest_edge": 0.4, "height_policy": "none"}, "conductors": {"mode": "sheet"})"}) {
    const study::Study study = parsed(R"("region": {"box": {"min": [15, 4], "max": [25, 14]}},
      "boundaries": {"xmin": "periodic", "xmax": "periodic"})" +
                                      std::string(more));
    const mesh::PlanarMesh planar = pipeline::mesh_board(make_board(), study).mesh.planar();
    const auto low = on_side(planar, 0, 15e6 * metres_per_nm), high = on_side(planar, 0, 25e6 * metres_per_nm);
    ASSERT_GT(low.size(), 8U) << more;
    ASSERT_EQ(low.size(), high.size()) << more;
    for (std::size_t i = 0; i < low.size(); ++i) {
      EXPECT_EQ(planar.points_m()[static_cast<std::size_t>(low[i])][1],
                planar.points_m()[static_cast<std::size_t>(high[i])][1]);
      if (i > 0) {
        EXPECT_EQ(low[i - 1] < low[i], high[i - 1] < high[i]) << more;
      }
    }
  }
}

/// Lines that wander and repeat after 10 mm, wherever the cell is cut out of them.
std::string random_cell(std::mt19937& random, double& x) {
  const auto between = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  std::string nets = R"("GND")", tracks;
  const int num_lines = 1 + static_cast<int>(random() % 4);
  for (int line = 0; line < num_lines; ++line) {
    std::array<std::array<double, 2>, 3> base{};
    for (std::size_t i = 0; i < 3; ++i)
      base[i] = {3 * static_cast<double>(i) + between(-0.5, 0.5), -6 + 4 * line + between(-1.2, 1.2)};
    std::string points;
    for (int period = -1; period < 4; ++period)
      for (const auto& [px, py] : base)
        points += fmt::format("{}[{:.5f}, {:.5f}]", points.empty() ? "" : ", ", px + 10 * period, py);
    nets += fmt::format(", \"N{}\"", line);
    tracks += fmt::format(R"({}{{"layer": "top", "net": "N{}", "width": {:.3f}, "points": [{}]}})", tracks.empty() ? "" : ", ",
                          line, between(0.15, 0.5), points);
  }
  x = std::round(between(0, 9) * 1e4) * 1e-4;
  return fmt::format(R"({{"pcbmesh_board": 1, "units": "mm", "outline": {{"rect": [[-30, -30], [60, 30]]}},
    "materials": [{{"name": "core", "eps_r": 4}}],
    "stackup": [{{"name": "top", "kind": "copper", "thickness": "35um"}},
      {{"name": "core", "kind": "dielectric", "thickness": "500um", "material": "core"}}, {{"name": "bottom", "kind": "copper", "thickness": "35um"}}],
    "nets": [{}], "tracks": [{}], "planes": [{{"layer": "bottom", "net": "GND", "rect": [[-29, -29], [59, 29]], "holes": [
      {{"circle": {{"at": [-5, 9], "diameter": 1.2}}}}, {{"circle": {{"at": [5, 9], "diameter": 1.2}}}},
      {{"circle": {{"at": [15, 9], "diameter": 1.2}}}}, {{"circle": {{"at": [25, 9], "diameter": 1.2}}}}]}}]}})",
                     nets, tracks);
}

TEST(PeriodicSides, RandomCellsMatchWhereverTheyAreCut) {
  std::mt19937 random(7);
  for (int round = 0; round < 40; ++round) {
    double x = 0;
    const board::Board board = formats::native_json::parse_board(random_cell(random, x), "cell.json").board;
    constexpr const char* modes[] = {"solid", "hollow", "sheet"};
    const study::Study study = parsed(fmt::format(
        R"("region": {{"box": {{"min": [{}, -9], "max": [{}, 12]}}}}, "boundaries": {{"xmin": "periodic", "xmax": "periodic"}},
           "conductors": {{"mode": "{}"}}, "mesh": {{"longest_edge": {}, "height_policy": "none", "seed": "{}"}})",
        x, x + 10, modes[round % 3], round % 2 == 0 ? 3 : 0.7, round % 5 == 0 ? "hex" : "delaunay"));
    try {
      const mesh::PlanarMesh planar = pipeline::mesh_board(board, study).mesh.planar();
      const auto low = on_side(planar, 0, std::round(x * 1e6) * metres_per_nm),
                 high = on_side(planar, 0, std::round(x * 1e6 + 1e7) * metres_per_nm);
      ASSERT_GT(low.size(), 6U) << round;
      ASSERT_EQ(low.size(), high.size()) << round;
      for (std::size_t i = 0; i < low.size(); ++i)
        EXPECT_EQ(planar.points_m()[static_cast<std::size_t>(low[i])][1],
                  planar.points_m()[static_cast<std::size_t>(high[i])][1]);
    } catch (const Error& error) {
      ADD_FAILURE() << "round " << round << " at " << x << ": " << error.what();
    }
  }
}

TEST(PeriodicSides, WhatDiffersIsNamedWithItsPlace) {
  const study::Study study = parsed(R"("region": {"box": {"min": [15, 4], "max": [24, 14]}},
    "boundaries": {"xmin": "periodic", "xmax": "periodic"})");
  try {
    (void)pipeline::mesh_board(make_board(), study);
    FAIL() << "B crosses the two sides at different places";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::study_invalid);
    EXPECT_EQ(error.spot().layer, "top");
    ASSERT_TRUE(error.spot().at_mm);
    EXPECT_NEAR((*error.spot().at_mm)[0], 15, 1e-9);
    EXPECT_NE(error.text().find("copper of B"), std::string::npos) << error.text();
  }
}

TEST(MatchedLayers, WhatLiesAtTheInnerFaceGoesStraightOn) {
  const model::Model m = composed(R"("region": {"box": {"min": [15, 4], "max": [25, 14]}},
    "boundaries": {"all": "none", "xmax": {"kind": "pml", "thickness": 2, "layers": 2},
                   "ymin": {"kind": "pml", "thickness": 1, "layers": 1}, "zmax": {"kind": "pml", "thickness": 3, "layers": 3}})");
  ASSERT_TRUE(m.shell());
  EXPECT_EQ(m.shell()->outer.max.x, 27 * nm_per_mm);
  EXPECT_EQ(m.shell()->outer.min.y, 3 * nm_per_mm);
  EXPECT_EQ(m.shell()->outer.min.x, 15 * nm_per_mm);
  EXPECT_EQ(m.first_guide_body(), static_cast<std::int32_t>(m.bodies().size()) - 3) << "two strips at xmax, one at ymin";
  std::int32_t num_stretched = 0;
  for (const model::Slab& slab : m.slabs()) num_stretched += slab.is_stretched ? 1 : 0;
  EXPECT_EQ(num_stretched, 3);
  const auto guide = m.first_guide_body();
  const auto stretch = [&](std::int32_t slab, std::vector<std::int32_t> present) { return m.resolve(slab, present).stretched; };
  const auto top = static_cast<std::int32_t>(m.slabs().size()) - 1;
  EXPECT_EQ(stretch(0, {0, 1}), 0);
  EXPECT_EQ(stretch(0, {0, 1, guide}), model::stretched_x);
  EXPECT_EQ(stretch(0, {0, 1, guide, guide + 2}), model::stretched_x | model::stretched_y);
  EXPECT_EQ(stretch(top, {0, 1, guide + 2}), model::stretched_y | model::stretched_z);
  EXPECT_TRUE(m.resolve(0, std::vector<std::int32_t>{guide}).is_void()) << "outside the domain";
}

TEST(MatchedLayers, CopperInThemIsThatOfTheInnerFace) {
  const study::Study study = parsed(R"("region": {"box": {"min": [15, 4], "max": [25, 14]}},
    "boundaries": {"all": "none", "xmin": {"kind": "pml", "thickness": 2}, "xmax": {"kind": "pml", "thickness": 2},
                   "ymin": {"kind": "pml", "thickness": 1}, "ymax": {"kind": "pml", "thickness": 1}})");
  const mesh::PrismMesh m = pipeline::mesh_board(make_board(), study).mesh;
  std::map<std::pair<std::string, int>, double> volumes;
  for (const mesh::VolumeTag& tag : m.volume_tags())
    volumes[{tag.net < 0 ? "" : m.nets()[static_cast<std::size_t>(tag.net)], tag.stretched}] += tag.volume_m3;
  constexpr double copper = 35e-6;
  EXPECT_NEAR((volumes[{"A", 1}]), 4e-3 * 0.5e-3 * copper, 1e-15);
  EXPECT_EQ(volumes.count({"A", 2}), 0U) << "A crosses xmin and xmax alone";
  EXPECT_NEAR((volumes[{"GND", 3}]), 8e-6 * copper, 1e-15) << "corners are filled";
  // B is slanted where it crosses: its section is wider than the line.
  EXPECT_GT((volumes[{"B", 1}]), 1.05 * 4e-3 * 0.3e-3 * copper);
}

TEST(Polygon, WhatLiesOutsideIsNotMeshedAndSidesHaveNumbers) {
  const std::string region =
      R"("region": {"polygon": [[15, 4], [25, 4], [20, 14]]}, "boundaries": {"side_2": "pmc", "side": "pec"})";
  const mesh::PrismMesh m = pipeline::mesh_board(make_board(), parsed(region)).mesh;
  std::map<std::string, mesh::BoundaryCondition> sides;
  for (const mesh::FaceTag& tag : m.face_tags()) sides[tag.name] = tag.condition;
  EXPECT_EQ(sides.at("side_1"), mesh::BoundaryCondition::pec);
  EXPECT_EQ(sides.at("side_2"), mesh::BoundaryCondition::pmc);
  EXPECT_EQ(sides.count("xmin"), 0U);
  double area = 0;
  for (std::int32_t t = 0; t < m.planar().num_triangles(); ++t) area += m.planar().area_m2(t);
  // Vertices on slanted sides are rounded to the nanometre: half of one along two sides of 11 mm.
  EXPECT_NEAR(area, 50e-6, 1.2e-11);
}

}  // namespace
}  // namespace pcbmesh
