// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/base/units.hpp"

#include <gtest/gtest.h>

#include "pcbmesh/base/diagnostics.hpp"
#include "pcbmesh/base/error.hpp"

namespace pcbmesh {
namespace {

TEST(ParseLength, KnowsTheTradesUnits) {
  EXPECT_EQ(parse_length("35um"), 35'000);
  EXPECT_EQ(parse_length("0.2 mm"), 200'000);
  EXPECT_EQ(parse_length("1.5"), 1'500'000);
  EXPECT_EQ(parse_length("1mil"), 25'400);
  EXPECT_EQ(parse_length("-0.1in"), -2'540'000);
  EXPECT_EQ(parse_length("7nm"), 7);
}

TEST(ParseLength, RefusesWhatIsNoLength) {
  for (const char* text : {"", "mm", "1furlong", "nan", "inf", "1e300", "2m", "12mmx"})
    EXPECT_THROW((void)parse_length(text), Error) << text;
}

TEST(ParseFrequency, KnowsPrefixes) {
  EXPECT_DOUBLE_EQ(parse_frequency_hz("10GHz"), 1e10);
  EXPECT_DOUBLE_EQ(parse_frequency_hz("2.4e9"), 2.4e9);
  EXPECT_THROW((void)parse_frequency_hz("-1GHz"), Error);
  EXPECT_THROW((void)parse_frequency_hz("0"), Error);
}

TEST(FormatLength, PicksAReadableUnit) {
  EXPECT_EQ(format_length(35'000), "35 um");
  EXPECT_EQ(format_length(1'600'000), "1.6 mm");
  EXPECT_EQ(format_length(12), "12 nm");
}

TEST(NmFromMm, RoundsAndRefuses) {
  EXPECT_EQ(nm_from_mm(0.0000005), 1);
  EXPECT_THROW((void)nm_from_mm(1e300), Error);
  EXPECT_THROW((void)nm_from_mm(0.0 / 0.0), Error);
}

TEST(Diagnostics, GroupAndCountEverything) {
  Diagnostics d;
  for (int i = 0; i < 20; ++i) d.warn("kicad.text_on_copper", "text skipped", {.file = "a.kicad_pcb", .line = i + 1});
  d.note("x", "once");
  EXPECT_EQ(d.entries().size(), 2U);
  EXPECT_EQ(d.count("kicad.text_on_copper"), 20);
  EXPECT_EQ(d.entries()[0].spots.size(), Diagnostic::max_spots);
  EXPECT_EQ(d.num_warnings(), 20);
  Diagnostics both;
  both.merge(d);
  both.merge(d);
  EXPECT_EQ(both.count("kicad.text_on_copper"), 40);
}

TEST(Error, TellsPlaceThenTextThenCode) {
  const Error error(ErrorCode::board_invalid, "it is wrong",
                    {.file = "b.kicad_pcb", .line = 12, .layer = "F.Cu", .net = "GND", .at_mm = {{1.5, -2}}});
  EXPECT_STREQ(error.what(), "b.kicad_pcb:12, layer F.Cu, net GND, at (1.5, -2) mm: it is wrong (error 301)");
}

TEST(ExitCode, FollowsTheRanges) {
  EXPECT_EQ(exit_code(ErrorCode::usage), 2);
  EXPECT_EQ(exit_code(ErrorCode::file_syntax), 3);
  EXPECT_EQ(exit_code(ErrorCode::overlay_topology), 4);
  EXPECT_EQ(exit_code(ErrorCode::write_failed), 5);
  EXPECT_EQ(exit_code(ErrorCode::internal), 70);
}

}  // namespace
}  // namespace pcbmesh
