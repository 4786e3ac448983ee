// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "overlay_oracle.hpp"
#include "pcbmesh/overlay/overlay.hpp"

namespace pcbmesh::overlay {
namespace {

class RandomBoards : public testing::TestWithParam<unsigned> {};

TEST_P(RandomBoards, O1_O3_AreSound) {
  test::expect_sound_random_board(GetParam());
}

TEST_P(RandomBoards, O2_TurnedOnesHaveTheSameNets) {
  test::Layout layout = test::random_layout(GetParam());
  Diagnostics diagnostics;
  const OverlayOptions options{.tolerance_nm = 15 * nm_per_um};
  const OverlayResult straight = overlay(layout.model(), options, diagnostics);
  layout.turn_deg = 10.0 + 7.3 * static_cast<double>(GetParam() % 11);
  const OverlayResult turned = overlay(layout.model(), options, diagnostics);
  EXPECT_EQ(straight.net_pieces, turned.net_pieces);
  EXPECT_EQ(straight.touching_nets, turned.touching_nets);
  test::expect_sound(layout, turned);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomBoards, testing::Range(1u, 31u));

}  // namespace
}  // namespace pcbmesh::overlay
