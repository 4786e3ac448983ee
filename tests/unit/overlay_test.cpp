// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/overlay/overlay.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "overlay_oracle.hpp"
#include "pcbmesh/base/error.hpp"

namespace pcbmesh::overlay {
namespace {

using geometry::Point;
using geometry::Ring;
using test::expect_sound;
using test::Layout;

constexpr Nm um = nm_per_um;
constexpr Nm mm = nm_per_mm;

OverlayResult overlaid(const Layout& layout, Nm tolerance = 20 * um) {
  Diagnostics diagnostics;
  return overlay(layout.model(), {.tolerance_nm = tolerance}, diagnostics);
}

double area_of(const OverlayResult& result, std::int32_t body) {
  for (const SnapRecord& record : result.ledger) {
    if (record.body == body) return record.area_after_mm2;
  }
  return -1;
}

TEST(Overlay, ABareRectangleStaysThatRectangle) {
  Layout layout(10 * mm, 6 * mm);
  const OverlayResult result = overlaid(layout);
  ASSERT_EQ(result.graph.vertices().size(), 4u);
  ASSERT_EQ(result.graph.edges().size(), 4u);
  const std::set<Point> corners(result.graph.vertices().begin(), result.graph.vertices().end());
  EXPECT_EQ(corners, (std::set<Point>{{0, 0}, {10 * mm, 0}, {10 * mm, 6 * mm}, {0, 6 * mm}}));
  EXPECT_EQ(result.graph.increments(0).size(), 2u) << "domain and board share their edges";
}

TEST(Overlay, CopperNearTheRimDoesNotBendIt) {
  Layout layout(10 * mm, 6 * mm);
  const auto gnd = layout.copper("GND", 1);
  layout.box(gnd, 7 * um, 12 * um, 3 * mm, 6 * mm - 9 * um);  // three sides within the tolerance of the rim
  layout.box(gnd, 5 * mm, -1 * mm, 6 * mm, 2 * mm);           // over the rim
  layout.disc(gnd, {9 * mm, 500 * um + 11 * um}, 500 * um);   // nearly touches it from inside
  const OverlayResult result = overlaid(layout);
  std::set<Point> rim;
  for (std::size_t e = 0; e < result.graph.edges().size(); ++e) {
    if (result.graph.increments(e)[0].body != 0) continue;
    for (const auto v : result.graph.edges()[e]) rim.insert(result.graph.vertices()[static_cast<std::size_t>(v)]);
  }
  for (const Point p : rim) EXPECT_TRUE(p.x == 0 || p.x == 10 * mm || p.y == 0 || p.y == 6 * mm) << p.x << " " << p.y;
  for (const Point corner : {Point{0, 0}, Point{10 * mm, 0}, Point{10 * mm, 6 * mm}, Point{0, 6 * mm}})
    EXPECT_TRUE(rim.contains(corner));
  EXPECT_NEAR(area_of(result, gnd), 3 * 6 + 1 * 2 + 0.25 * std::numbers::pi, 0.12);
  expect_sound(layout, result);
}

TEST(Overlay, ThreeAltitudesBelowTheToleranceSettle) {
  // Sides of 22 um, altitudes of 19 um: every vertex is within the tolerance of the opposite side.
  Layout layout(4 * mm, 4 * mm);
  const auto a = layout.copper("A", 1), b = layout.copper("B", 3), c = layout.copper("C", 5);
  const Point p{2 * mm, 2 * mm}, q{2 * mm + 22 * um, 2 * mm}, r{2 * mm + 11 * um, 2 * mm + 19 * um};
  layout.ring(a, {p, q, {2 * mm, 1 * mm}});
  layout.ring(b, {q, r, {3 * mm, 2 * mm}});
  layout.ring(c, {r, p, {1 * mm, 3 * mm}});
  expect_sound(layout, overlaid(layout));
}

TEST(Overlay, FracturedZoneHealsByItself) {
  Layout layout(10 * mm, 10 * mm);
  const auto gnd = layout.copper("GND", 1);
  // Outer square, a slit of no width to the hole, round the hole clockwise, and back through the slit.
  layout.ring(gnd,
              {{1 * mm, 1 * mm},
               {9 * mm, 1 * mm},
               {9 * mm, 9 * mm},
               {1 * mm, 9 * mm},
               {1 * mm, 5 * mm},
               {3 * mm, 5 * mm},
               {3 * mm, 7 * mm},
               {7 * mm, 7 * mm},
               {7 * mm, 3 * mm},
               {3 * mm, 3 * mm},
               {3 * mm, 5 * mm},
               {1 * mm, 5 * mm}},
              false);
  const OverlayResult result = overlaid(layout);
  EXPECT_NEAR(area_of(result, gnd), 64 - 16, 1e-9);
  EXPECT_EQ(result.graph.vertices().size(), 12u) << "four corners each of rim, zone and hole; the slit leaves nothing";
  expect_sound(layout, result);
}

TEST(Overlay, NanometreJitterVanishes) {
  Layout layout(10 * mm, 10 * mm);
  const auto gnd = layout.copper("GND", 1);
  std::mt19937 random(7);
  Ring ring;
  const auto jitter = [&] { return static_cast<Nm>(random() % 3) - 1; };
  for (Nm x = 1 * mm; x < 9 * mm; x += 100 * um)
    ring.push_back({x, 2 * mm + jitter()}), ring.push_back({x + 1, 2 * mm + jitter()});
  for (Nm x = 9 * mm; x > 1 * mm; x -= 100 * um)
    ring.push_back({x, 8 * mm + jitter()}), ring.push_back({x - 1, 8 * mm + jitter()});
  layout.ring(gnd, ring, false);
  const OverlayResult result = overlaid(layout);
  EXPECT_LE(result.graph.vertices().size(), 16u);
  EXPECT_NEAR(area_of(result, gnd), 48.0 - 0.6, 0.7);
  expect_sound(layout, result);
}

TEST(Overlay, TheSameViaOnFourLayersIsOneCircle) {
  Layout layout(4 * mm, 4 * mm);
  for (const std::int32_t slab : {1, 3, 5, 7}) layout.disc(layout.copper("A", slab), {2 * mm, 2 * mm}, 300 * um);
  const OverlayResult result = overlaid(layout);
  std::size_t round = 0;
  for (std::size_t e = 0; e < result.graph.edges().size(); ++e) {
    if (result.graph.increments(e)[0].body < 2) continue;
    ++round;
    EXPECT_EQ(result.graph.increments(e).size(), 4u);
  }
  EXPECT_EQ(round + 4, result.graph.edges().size());
  EXPECT_GE(round, 8u);
  expect_sound(layout, result);
}

TEST(Overlay, TracksCrossingAtHalfADegree) {
  Layout layout(40 * mm, 4 * mm);
  const auto a = layout.copper("A", 1), b = layout.copper("B", 3);
  layout.track(a, {2 * mm, 2 * mm}, {38 * mm, 2 * mm}, 200 * um);
  const Nm rise = std::llround(18e6 * std::tan(0.5 * std::numbers::pi / 180));
  layout.track(b, {2 * mm, 2 * mm - rise}, {38 * mm, 2 * mm + rise}, 200 * um);
  const OverlayResult result = overlaid(layout);
  expect_sound(layout, result);
  EXPECT_GT(test::Oracle(layout.model(), result).least_angle_deg(), 5.0) << "blunting removes the needles";
}

TEST(Overlay, NearlyEqualArcsOfDifferentSampling) {
  Layout layout(12 * mm, 12 * mm);
  const auto a = layout.copper("A", 1), b = layout.copper("B", 3);
  layout.disc(a, {6 * mm, 6 * mm}, 4 * mm, 5 * um);
  layout.disc(b, {6 * mm + 3 * um, 6 * mm - 2 * um}, 4 * mm, 1 * um);
  const OverlayResult result = overlaid(layout);
  expect_sound(layout, result);
  EXPECT_LT(result.graph.vertices().size(), 150u);
  EXPECT_NEAR(area_of(result, a), 16 * std::numbers::pi, 0.1);
  EXPECT_NEAR(area_of(result, b), 16 * std::numbers::pi, 0.1);
}

TEST(Overlay, TipsSharingAVertex) {
  Layout layout(10 * mm, 10 * mm);
  const auto a = layout.copper("A", 1), b = layout.copper("B", 1), c = layout.copper("C", 3);
  const Point tip{5 * mm, 5 * mm};
  layout.ring(a, {tip, {9 * mm, 5 * mm}, {9 * mm, 5 * mm + 400 * um}});
  layout.ring(b, {tip, {1 * mm, 5 * mm}, {1 * mm, 5 * mm - 400 * um}});
  layout.ring(c, {tip, {9 * mm, 5 * mm + 900 * um}, {9 * mm, 5 * mm + 1300 * um}});
  const OverlayResult result = overlaid(layout);
  expect_sound(layout, result);
  EXPECT_TRUE(result.touching_nets.empty()) << "a common point is no contact";
}

TEST(Overlay, O2_NetsSixtyMicrometresApartStayApart) {
  Layout layout(10 * mm, 10 * mm);
  const auto a = layout.copper("A", 1), b = layout.copper("B", 1);
  layout.track(a, {1 * mm, 2 * mm}, {9 * mm, 7 * mm}, 200 * um);
  layout.disc(a, {9 * mm, 7 * mm}, 400 * um);
  const Vector2 across = test::unit_normal({1 * mm, 2 * mm}, {9 * mm, 7 * mm});
  const Nm dx = std::llround(across.x * 260e3), dy = std::llround(across.y * 260e3);
  layout.track(b, {1 * mm + dx, 2 * mm + dy}, {7 * mm + dx, 5'750'000 + dy}, 200 * um);
  const OverlayResult result = overlaid(layout);
  expect_sound(layout, result);
  EXPECT_EQ(result.statistics.tolerance_nm, 20 * um);
  EXPECT_TRUE(result.touching_nets.empty());
  EXPECT_EQ(result.net_pieces, (std::vector<std::int32_t>{1, 1}));
}

TEST(Overlay, ANegativeLoopDoesNotEatOtherCopper) {
  Layout layout(10 * mm, 10 * mm);
  const auto a = layout.copper("A", 1);
  layout.box(a, 1 * mm, 4 * mm, 5 * mm, 6 * mm);
  // Bow tie: the left half runs clockwise, over the box.
  layout.ring(a, {{2 * mm, 2 * mm}, {8 * mm, 8 * mm}, {8 * mm, 2 * mm}, {2 * mm, 8 * mm}}, false);
  const OverlayResult result = overlaid(layout);
  // Box 8, two triangles of 9, less the box's part of the left triangle: x from 2 to 5 between the diagonals, 4 <= y <= 6.
  EXPECT_NEAR(area_of(result, a), 8 + 18 - 5, 0.01);
  EXPECT_EQ(result.net_pieces, (std::vector<std::int32_t>{2})) << "the halves of the tie meet in a point, no more";
  expect_sound(layout, result);
}

TEST(Overlay, DomainCutsCopper) {
  Layout layout(10 * mm, 10 * mm);
  layout.domain = {{2 * mm, 2 * mm}, {8 * mm, 2 * mm}, {8 * mm, 8 * mm}, {2 * mm, 8 * mm}};
  const auto a = layout.copper("A", 1), b = layout.copper("B", 1);
  layout.track(a, {1 * mm, 5 * mm}, {9 * mm, 5 * mm}, 400 * um);
  // Leaves the domain and comes back: one net, two pieces within.
  layout.ring(b, {{3 * mm, 6 * mm},
                  {9 * mm, 6 * mm},
                  {9 * mm, 7 * mm},
                  {3 * mm, 7 * mm},
                  {3 * mm, 6800 * um},
                  {8500 * um, 6800 * um},
                  {8500 * um, 6200 * um},
                  {3 * mm, 6200 * um}});
  const OverlayResult result = overlaid(layout);
  EXPECT_NEAR(area_of(result, a), 6 * 0.4, 1e-9);
  EXPECT_NEAR(area_of(result, b), 2 * 5 * 0.2, 1e-9);
  EXPECT_EQ(result.net_pieces, (std::vector<std::int32_t>{1, 2}));
  for (const Point p : result.graph.vertices()) {
    const bool outside = p.x < 2 * mm || p.x > 8 * mm || p.y < 2 * mm || p.y > 8 * mm;
    EXPECT_TRUE(!outside) << "nothing outside the domain is drawn";
  }
  expect_sound(layout, result);
}

TEST(Overlay, CopperOffTheBoardDoesNotCount) {
  Layout layout(10 * mm, 10 * mm);
  layout.domain = {{-5 * mm, -5 * mm}, {15 * mm, -5 * mm}, {15 * mm, 15 * mm}, {-5 * mm, 15 * mm}};
  const auto a = layout.copper("A", 1);
  layout.box(a, 8 * mm, 4 * mm, 12 * mm, 5 * mm);
  layout.box(a, 12 * mm, 12 * mm, 13 * mm, 13 * mm);
  const OverlayResult result = overlaid(layout);
  EXPECT_NEAR(area_of(result, a), 2.0, 1e-9);
  EXPECT_EQ(result.net_pieces, (std::vector<std::int32_t>{1}));
}

TEST(Overlay, ShapesDrawnTwiceAreDrawnOnce) {
  Layout once(10 * mm, 10 * mm), twice(10 * mm, 10 * mm);
  for (Layout* layout : {&once, &twice}) {
    const auto a = layout->copper("A", 1);
    for (int k = 0; k < (layout == &twice ? 3 : 1); ++k) {
      layout->track(a, {1 * mm, 1 * mm}, {8 * mm, 7 * mm}, 300 * um);
      layout->disc(a, {8 * mm, 7 * mm}, 500 * um);
      layout->ring(a, {{2 * mm, 6 * mm}, {4 * mm, 6 * mm}, {4 * mm, 8 * mm}}, false);
    }
  }
  const OverlayResult first = overlaid(once), second = overlaid(twice);
  EXPECT_TRUE(std::ranges::equal(first.graph.vertices(), second.graph.vertices()));
  EXPECT_TRUE(std::ranges::equal(first.graph.edges(), second.graph.edges()));
}

TEST(Overlay, O2_BarrelsJoinThePiecesOfANet) {
  Layout layout(10 * mm, 10 * mm);
  const auto top = layout.copper("A", 7), bottom = layout.copper("A", 1), inner = layout.copper("B", 3);
  layout.track(top, {1 * mm, 5 * mm}, {5 * mm, 5 * mm}, 300 * um);
  layout.track(bottom, {5 * mm, 5 * mm}, {9 * mm, 5 * mm}, 300 * um);
  layout.box(inner, 4 * mm, 7 * mm, 6 * mm, 9 * mm);
  EXPECT_EQ(overlaid(layout).net_pieces, (std::vector<std::int32_t>{2, 1}));
  const auto barrel = layout.barrel("A", 1, 7);
  layout.disc(barrel, {5 * mm, 5 * mm}, 150 * um);
  const OverlayResult joined = overlaid(layout);
  EXPECT_EQ(joined.net_pieces, (std::vector<std::int32_t>{1, 1}));
  EXPECT_TRUE(joined.touching_nets.empty());
  // The same barrel through B's plane is a short of the layout: reported, and no error.
  layout.box(inner, 4 * mm, 4 * mm, 6 * mm, 8 * mm);
  const OverlayResult shorted = overlaid(layout);
  EXPECT_EQ(shorted.touching_nets, (std::vector<std::array<std::int32_t, 2>>{{0, 1}}));
  EXPECT_EQ(shorted.net_pieces, (std::vector<std::int32_t>{1, 1}));
}

TEST(Overlay, NearNetsGetASmallerTolerance) {
  Layout layout(10 * mm, 10 * mm);
  const auto a = layout.copper("A", 1), b = layout.copper("B", 1);
  layout.box(a, 1 * mm, 1 * mm, 5 * mm, 9 * mm);
  layout.box(b, 5 * mm + 8 * um, 2 * mm, 9 * mm, 8 * mm);
  Diagnostics diagnostics;
  const OverlayResult result = overlay(layout.model(), {.tolerance_nm = 20 * um}, diagnostics);
  EXPECT_GT(result.statistics.attempts, 1);
  EXPECT_LT(result.statistics.tolerance_nm, 8 * um);
  EXPECT_TRUE(result.touching_nets.empty());
  EXPECT_GT(diagnostics.count("overlay.retry"), 0);
  expect_sound(layout, result);
}

TEST(Overlay, NetsThatCannotBeKeptApartAreNamed) {
  Layout layout(10 * mm, 10 * mm);
  const auto a = layout.copper("LEFT", 1), b = layout.copper("RIGHT", 1);
  layout.box(a, 1 * mm, 1 * mm, 5 * mm, 9 * mm);
  layout.box(b, 5 * mm + 5, 2 * mm, 9 * mm, 8 * mm);
  try {
    (void)overlaid(layout);
    FAIL() << "a gap of 5 nm cannot be meshed";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::overlay_topology);
    EXPECT_NE(std::string(error.what()).find("LEFT"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("RIGHT"), std::string::npos) << error.what();
    ASSERT_TRUE(error.spot().at_mm.has_value());
    EXPECT_NEAR((*error.spot().at_mm)[0], 5.0, 0.1);
  }
}

TEST(Overlay, AutomaticToleranceFollowsTheNarrowestFeature) {
  Layout layout(10 * mm, 10 * mm);
  layout.track(layout.copper("A", 1), {1 * mm, 1 * mm}, {9 * mm, 9 * mm}, 100 * um);
  Diagnostics diagnostics;
  EXPECT_EQ(overlay(layout.model(), {}, diagnostics).statistics.tolerance_nm, 20 * um);
  layout.narrowest = 80 * um;
  EXPECT_EQ(overlay(layout.model(), {}, diagnostics).statistics.tolerance_nm, 10 * um);
  layout.nets_of_interest = {0};
  layout.narrowest_of_interest = 60 * um;
  EXPECT_EQ(overlay(layout.model(), {}, diagnostics).statistics.tolerance_nm, 3 * um);
}

TEST(Overlay, StopsWhenAsked) {
  Layout layout(10 * mm, 10 * mm);
  layout.track(layout.copper("A", 1), {1 * mm, 1 * mm}, {9 * mm, 9 * mm}, 100 * um);
  const std::atomic<bool> stop{true};
  Diagnostics diagnostics;
  try {
    (void)overlay(layout.model(), {}, diagnostics, Progress({}, &stop));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::cancelled);
  }
}

TEST(Overlay, CoordinatesUpToAMetre) {
  Layout layout(10 * mm, 10 * mm);
  const auto a = layout.copper("A", 1), b = layout.copper("B", 3);
  layout.track(a, {1 * mm, 1 * mm}, {9 * mm, 9 * mm}, 300 * um);
  layout.track(b, {1 * mm, 9 * mm}, {9 * mm, 1 * mm}, 300 * um);
  const OverlayResult here = overlaid(layout);
  layout.shift = {max_coordinate_nm - 10 * mm, -max_coordinate_nm};
  const OverlayResult there = overlaid(layout);
  ASSERT_EQ(here.graph.vertices().size(), there.graph.vertices().size());
  for (std::size_t i = 0; i < here.graph.vertices().size(); ++i) {
    const Point p = here.graph.vertices()[i], q = there.graph.vertices()[i];
    EXPECT_EQ((Point{p.x + layout.shift.x, p.y + layout.shift.y}), q);
  }
}

TEST(Overlay, PartsOfOneNetWithinAMicrometreJoinWithAWarning) {
  Layout layout(10 * mm, 10 * mm);
  const auto a = layout.copper("A", 1), b = layout.copper("B", 1);
  layout.box(a, 1 * mm, 1 * mm, 5 * mm, 9 * mm);
  layout.box(a, 5 * mm + 5, 2 * mm, 9 * mm, 8 * mm);
  layout.box(b, 1 * mm, 9200 * um, 9 * mm, 9600 * um);
  Diagnostics diagnostics;
  const OverlayResult result = overlay(layout.model(), {.tolerance_nm = 20 * um}, diagnostics);
  EXPECT_EQ(result.statistics.tolerance_nm, 20 * um) << "the rest of the board must not pay";
  EXPECT_GE(diagnostics.count("overlay.parts_joined"), 1);
  EXPECT_EQ(result.net_pieces, (std::vector<std::int32_t>{1, 1}));
  expect_sound(layout, result);
}

TEST(Overlay, ASliverOfCopperIsLeftOutWithANote) {
  Layout layout(10 * mm, 10 * mm);
  const auto a = layout.copper("A", 1);
  layout.box(a, 1 * mm, 1 * mm, 5 * mm, 9 * mm);
  layout.box(a, 10 * mm - 300, 2 * mm, 12 * mm, 8 * mm);  // 300 nm of it lie on the board
  Diagnostics diagnostics;
  const OverlayResult result = overlay(layout.model(), {.tolerance_nm = 20 * um}, diagnostics);
  EXPECT_EQ(diagnostics.count("overlay.speck"), 1);
  EXPECT_EQ(result.net_pieces, (std::vector<std::int32_t>{1}));
  EXPECT_NEAR(area_of(result, a), 32, 1e-9);
}

class RandomBoards : public testing::TestWithParam<unsigned> {};

TEST_P(RandomBoards, O1_O3_AreSound) {
  test::expect_sound_random_board(GetParam());
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomBoards, testing::Values(1u, 2u, 3u));

}  // namespace
}  // namespace pcbmesh::overlay
