// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/geometry/ring_contact.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace pcbmesh::geometry {
namespace {

Ring square(Nm x, Nm y, Nm side) {
  return {{x, y}, {x + side, y}, {x + side, y + side}, {x, y + side}};
}

TEST(RingContact, TellsCrossingFromTouching) {
  const Ring a = square(0, 0, 10);
  EXPECT_EQ(contact(a, square(20, 0, 10)).kind, ContactKind::none);
  EXPECT_EQ(contact(a, square(2, 2, 3)).kind, ContactKind::none) << "inside";
  EXPECT_EQ(contact(a, square(10, 0, 10)).kind, ContactKind::touching) << "shared edge";
  EXPECT_EQ(contact(a, square(10, 10, 10)).kind, ContactKind::touching) << "shared corner";
  EXPECT_EQ(contact(a, square(0, 0, 10)).kind, ContactKind::touching) << "the same ring";
  EXPECT_EQ(contact(a, square(5, 5, 10)).kind, ContactKind::crossing);
  EXPECT_EQ(contact(a, {{5, 5}, {15, 4}, {15, 6}}).kind, ContactKind::crossing);
  EXPECT_EQ(contact(a, {{10, 5}, {15, 4}, {15, 6}}).kind, ContactKind::touching) << "a tip on an edge";
  EXPECT_EQ(contact(a, {{11, 5}, {15, 4}, {15, 6}}).kind, ContactKind::none) << "one nanometre away";
  EXPECT_EQ(contact({}, a).kind, ContactKind::none);
}

TEST(RingContact, SelfCrossing) {
  EXPECT_FALSE(self_crossing(square(0, 0, 10)));
  EXPECT_TRUE(self_crossing({{0, 0}, {10, 10}, {10, 0}, {0, 10}}));
  EXPECT_FALSE(self_crossing({{0, 0}, {10, 0}, {10, 10}, {5, 0}, {0, 10}})) << "a touch is no crossing";
  EXPECT_FALSE(self_crossing({}));
}

TEST(RingContact, LocationIsExactAtOneNanometre) {
  const Ring triangle{{0, 0}, {1'000'000'000, 1}, {0, 2}};
  EXPECT_EQ(location({500'000'000, 1}, triangle), 1);
  EXPECT_EQ(location({999'999'999, 1}, triangle), 1);
  EXPECT_EQ(location({1'000'000'000, 1}, triangle), 0);
  EXPECT_EQ(location({1'000'000'000, 0}, triangle), -1);
  EXPECT_EQ(location({0, 1}, triangle), 0);
  EXPECT_EQ(location({-1, 1}, triangle), -1);
  EXPECT_EQ(location({5, 5}, square(0, 0, 10)), 1);
  Ring clockwise = square(0, 0, 10);
  std::reverse(clockwise.begin(), clockwise.end());
  EXPECT_EQ(location({5, 5}, clockwise), 1);
}

TEST(RingContact, Inside) {
  EXPECT_TRUE(is_inside(square(2, 2, 3), square(0, 0, 10)));
  EXPECT_FALSE(is_inside(square(0, 0, 10), square(2, 2, 3)));
  EXPECT_FALSE(is_inside(square(20, 2, 3), square(0, 0, 10)));
  EXPECT_TRUE(is_inside(square(0, 0, 10), square(0, 0, 10)));
  EXPECT_TRUE(is_inside(square(0, 0, 3), square(0, 0, 10))) << "sharing a corner";
  EXPECT_TRUE(is_inside({{5, 0}, {10, 5}, {5, 10}, {0, 5}}, square(0, 0, 10))) << "all corners on the edge";
  EXPECT_FALSE(is_inside(square(10, 0, 10), square(0, 0, 10))) << "beside, sharing an edge";
}

}  // namespace
}  // namespace pcbmesh::geometry
