// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "pcbmesh/geometry/path.hpp"

namespace pcbmesh::geometry {
namespace {

constexpr Nm mm = nm_per_mm;

double area(const Figure& figure, const ArcOptions& options) {
  bool simple = false;
  double sum = 0;
  for (const Ring& ring : outline(figure, options, simple)) sum += area_mm2(ring);
  return sum;
}

TEST(Orientation, IsExactAtTheRimOfTheBoard) {
  const Nm far = max_coordinate_nm;
  EXPECT_EQ(orientation({-far, -far}, {far, far}, {far - 1, far}), 1);
  EXPECT_EQ(orientation({-far, -far}, {far, far}, {far, far - 1}), -1);
  EXPECT_EQ(orientation({-far, -far}, {0, 0}, {far, far}), 0);
}

TEST(Orientation, ChangesSignWhenTwoPointsSwap) {
  const Point a{3, 7}, b{-12, 5}, c{40, -9};
  EXPECT_EQ(orientation(a, b, c), -orientation(b, a, c));
  EXPECT_EQ(orientation(a, b, c), orientation(b, c, a));
}

TEST(ClipToBox, KeepsTheAreaInside) {
  const Ring ring{{0, 0}, {10 * mm, 0}, {10 * mm, 10 * mm}, {0, 10 * mm}};
  const Box box{{5 * mm, 5 * mm}, {20 * mm, 20 * mm}};
  EXPECT_DOUBLE_EQ(area_mm2(clip_to_box(ring, box)), 25.0);
  EXPECT_TRUE(clip_to_box(ring, {{11 * mm, 0}, {12 * mm, mm}}).empty());
  EXPECT_EQ(clip_to_box(ring, {{-mm, -mm}, {11 * mm, 11 * mm}}), ring);
}

TEST(Circle, StaysWithinItsSagittaAndKeepsItsArea) {
  const Nm radius = 500 * nm_per_um;
  const double exact = std::numbers::pi * 0.25;
  for (ArcMode mode : {ArcMode::inscribed, ArcMode::circumscribed, ArcMode::equal_area}) {
    const ArcOptions options{5 * nm_per_um, mode};
    const Ring ring = circle({mm, mm}, radius, options);
    double nearest = 1e18, farthest = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point a = ring[i], b = ring[(i + 1) % ring.size()];
      farthest = std::max(farthest, std::hypot(static_cast<double>(a.x - mm), static_cast<double>(a.y - mm)));
      nearest =
          std::min(nearest, std::hypot(static_cast<double>(a.x + b.x) / 2 - 1e6, static_cast<double>(a.y + b.y) / 2 - 1e6));
    }
    EXPECT_GT(nearest, 0.5e6 - 5e3 - 2);
    EXPECT_LT(farthest, 0.5e6 + 5.2e3);
    const double error = area_mm2(ring) / exact - 1;
    if (mode == ArcMode::inscribed) {
      EXPECT_LT(error, 0);
    }
    if (mode == ArcMode::circumscribed) {
      EXPECT_GT(error, 0);
    }
    if (mode == ArcMode::equal_area) {
      EXPECT_NEAR(error, 0, 1e-5);
    }
  }
  EXPECT_EQ(circle({0, 0}, radius, {5000, ArcMode::octagon}).size(), 8U);
}

TEST(Outline, DiscAndTrackHaveTheRightArea) {
  const ArcOptions fine{20, ArcMode::inscribed};
  EXPECT_NEAR(area(disc({0, 0}, mm), fine), std::numbers::pi / 4, 1e-4);
  EXPECT_NEAR(area(segment({0, 0}, {3 * mm, 4 * mm}, mm), fine), 5 + std::numbers::pi / 4, 1e-4);
  EXPECT_NEAR(area(segment({7, 7}, {7, 7}, mm), fine), std::numbers::pi / 4, 1e-4);
}

TEST(Outline, ArcTrackIsOneRingWithTheAreaOfItsBand) {
  // Three quarters of a turn, radius 2 mm, width 0.5 mm: band plus two half discs.
  const Figure arc{Path{{{2 * mm, 0}, {-1414214, 1414214}, {0, -2 * mm}}, {0}, false}, mm / 2, false};
  bool simple = false;
  const std::vector<Ring> rings = outline(arc, {50, ArcMode::inscribed}, simple);
  ASSERT_EQ(rings.size(), 1U);
  EXPECT_TRUE(simple);
  EXPECT_NEAR(area_mm2(rings[0]), 1.5 * std::numbers::pi * 2 * 0.5 + std::numbers::pi * 0.0625, 1e-3);
}

TEST(Outline, ArcTighterThanItsPenStillCoversItsBand) {
  const Figure arc{Path{{{mm / 10, 0}, {0, mm / 10}, {-mm / 10, 0}}, {0}, false}, mm, false};
  bool simple = false;
  double sum = 0;
  for (const Ring& ring : outline(arc, {500, ArcMode::inscribed}, simple)) {
    EXPECT_GT(area_mm2(ring), 0);
    sum += area_mm2(ring);
  }
  EXPECT_GT(sum, std::numbers::pi / 4);
}

TEST(Outline, SaysWhenAPolygonMayCrossItself) {
  bool simple = true;
  (void)outline(polygon({{0, 0}, {mm, mm}, {mm, 0}, {0, mm}}), {}, simple);
  EXPECT_FALSE(simple);
  (void)outline(polygon({{0, 0}, {mm, 0}, {mm, mm}, {0, mm}}), {}, simple);
  EXPECT_TRUE(simple);
}

TEST(Flatten, TreatsANearlyStraightArcAsASegment) {
  const Path path{{{0, 0}, {5 * mm, 1}, {10 * mm, 0}}, {0}, false};
  EXPECT_EQ(flatten(path, {}).size(), 2U);
}

TEST(Flatten, CutsSharedCirclesAlike) {
  // The same circle as two arcs from different starts: corners of the common division agree.
  const ArcOptions options{nm_per_um, ArcMode::inscribed};
  const Ring a = flatten({{{mm, 0}, {0, mm}, {-mm, 0}, {0, -mm}}, {0, 2}, true}, options);
  const Ring b = flatten({{{0, mm}, {-mm, 0}, {0, -mm}, {mm, 0}}, {0, 2}, true}, options);
  std::vector<Point> sa = a, sb = b;
  std::sort(sa.begin(), sa.end());
  std::sort(sb.begin(), sb.end());
  EXPECT_EQ(sa, sb);
}

TEST(Bounds, HoldThePen) {
  const Box box = bounds(segment({0, 0}, {mm, 0}, mm));
  EXPECT_LE(box.min.x, -mm / 2);
  EXPECT_GE(box.max.y, mm / 2);
}

}  // namespace
}  // namespace pcbmesh::geometry
