// SPDX-License-Identifier: GPL-3.0-or-later
// Broken, absurd and malicious boards: a clear error or a counted warning, never a crash.
#include <gtest/gtest.h>

#include <random>
#include <string>

#include "formats/syntax/input_file.hpp"
#include "test_data.hpp"
#include "unit/kicad_text.hpp"

namespace {

using namespace pcbmesh;
using namespace pcbmesh::tests;

TEST(KicadHostile, HostileNumbersAreErrorsWithALine) {
  for (const std::string number : {"nan", "inf", "1e300", "9223372036854775808", "1001", "abc", "", "(x)", "\"\""}) {
    const Error error =
        error_of(text_of("\n(segment (start 0 0) (end 1 " + number + ") (width 0.1) (layer \"F.Cu\") (net 1))"));
    EXPECT_TRUE(error.code() == ErrorCode::input_number || error.code() == ErrorCode::file_syntax)
        << number << ": " << error.what();
    EXPECT_EQ(error.spot().line, 7) << number << ": " << error.what();
  }
  EXPECT_EQ(error_of(text_of("(segment (start 0 0) (end 1 1) (width 1e300) (layer \"F.Cu\") (net 1))")).code(),
            ErrorCode::input_number);
  EXPECT_EQ(error_of(text_of("(segment (start 0 0) (end 1 1) (width 1) (layer \"F.Cu\") (net 9223372036854775808))")).code(),
            ErrorCode::input_number);
  EXPECT_EQ(error_of(text_of("(via (at 0 0) (size 1) (drill nan) (layers \"F.Cu\" \"B.Cu\") (net 1))")).code(),
            ErrorCode::input_number);
  EXPECT_EQ(error_of(text_of("(segment (width 1) (layer \"F.Cu\") (net 1))")).code(), ErrorCode::file_syntax);
}

TEST(KicadHostile, HostileFilesAreErrors) {
  EXPECT_EQ(error_of("").code(), ErrorCode::file_truncated);
  EXPECT_EQ(error_of("hello").code(), ErrorCode::file_syntax);
  EXPECT_EQ(error_of("(footprint \"x\")").code(), ErrorCode::file_syntax);
  EXPECT_EQ(error_of("(kicad_pcb)").code(), ErrorCode::file_syntax);
  EXPECT_EQ(error_of("(kicad_pcb (version 3))").code(), ErrorCode::file_syntax);
  EXPECT_EQ(error_of("(kicad_pcb (version 20241229))").code(), ErrorCode::board_invalid);
  EXPECT_EQ(error_of("(kicad_pcb (version 20241229) (layers (25 \"Edge.Cuts\" user)))").code(), ErrorCode::board_invalid);
  EXPECT_EQ(error_of("(kicad_pcb (version 20241229) (layers (0 \"F.Cu\" signal) (0 \"F.Cu\" signal)))").code(),
            ErrorCode::board_invalid);
  EXPECT_EQ(error_of(text_of(edge) + ")").code(), ErrorCode::file_syntax);
  EXPECT_EQ(read_text(text_of("", "20990101")).diagnostics.count("kicad.newer_version"), 1);
  const auto deep = read("(deep " + std::string(10000, '(') + std::string(10000, ')') + ")" + edge);
  EXPECT_EQ(deep.board.outlines().size(), 1U);
  EXPECT_EQ(deep.diagnostics.count("kicad.unknown_construct.deep"), 1);
}

/// Cut and corrupted files must be read or refused, never crash or hang.
TEST(KicadHostile, SurvivesDamagedFiles) {
  PCBMESH_NEEDS_TEST_DATA();
  const std::string whole =
      formats::syntax::read_whole_file(tests::test_data() / "kicad" / "19_edgecases_padstack_4L_v9.kicad_pcb");
  std::mt19937 random(7);
  int refused = 0, read_all_the_same = 0;
  const std::string spice = "()\"|-e9. \n\\";
  for (int round = 0; round < 400; ++round) {
    std::string text = whole;
    if (round % 4 == 0) {
      text.resize(random() % whole.size());
    } else {
      for (int k = 0; k < 1 + round % 5; ++k) text[random() % text.size()] = spice[random() % spice.size()];
    }
    try {
      (void)read_text(text);
      ++read_all_the_same;
    } catch (const Error& error) {
      EXPECT_NE(error.code(), ErrorCode::internal) << error.what();
      EXPECT_FALSE(error.spot().file.empty()) << error.what();
      ++refused;
    }
  }
  EXPECT_GT(refused, 100);
  EXPECT_GT(read_all_the_same, 10);
}

TEST(KicadHostile, TinyDrillsAreClampedWithAWord) {
  const auto [board, said] = read(
      "(via (at 3 4) (size 0.6) (drill 0.00001) (layers \"F.Cu\" \"B.Cu\") (net 1)) (via (at 3 8) (size 0.1) (drill 0.00001) "
      "(layers \"F.Cu\" \"B.Cu\") (net 1))");
  EXPECT_EQ(board.drills()[0].figure.pen, 100'000);
  EXPECT_EQ(board.drills()[1].figure.pen, 50'000);
  EXPECT_EQ(said.count("kicad.tiny_drill"), 2);
}

TEST(KicadHostile, UnknownNetsAndLayersAreWarned) {
  const auto [board, said] = read(
      "(segment (start 0 0) (end 1 0) (width 0.1) (layer \"F.Cu\") (net 99)) (segment (start 0 0) (end 1 0) (width 0.1) (layer "
      "\"In7.Cu\") (net 1))"
      "(via blind (at 3 4) (size 0.6) (drill 0.3) (layers \"F.Cu\" \"In7.Cu\") (net 1)) (segment (start 0 0) (end 1 0) (width "
      "0) (layer \"F.Cu\") (net 1))");
  EXPECT_EQ(board.shapes()[0].net, board::no_net);
  EXPECT_EQ(said.count("kicad.unknown_net"), 1);
  EXPECT_EQ(said.count("kicad.unknown_layer"), 1);
  EXPECT_EQ(said.count("kicad.track_off_copper"), 1);
  EXPECT_EQ(said.count("kicad.via_span"), 1);
  EXPECT_EQ(said.count("kicad.no_area"), 1);
}

}  // namespace
