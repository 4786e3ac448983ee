// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "formats/kicad/format.hpp"
#include "unit/kicad_text.hpp"
#include "unit/union_area.hpp"

namespace {

using namespace pcbmesh;
using namespace pcbmesh::tests;
using board::Board;
using board::ShapeKind;

std::string pad(const std::string& shape, const std::string& rest, const std::string& at = "(at 0 0)",
                const std::string& footprint = "(at 10 5)") {
  return "(footprint \"f\" (layer \"F.Cu\") " + footprint +
         " (property \"Reference\" \"U3\" (at 0 0) (layer \"F.SilkS\")) (pad \"7\" smd " + shape + " " + at +
         " (layers \"F.Cu\" \"F.Mask\") (net 1 \"GND\") " + rest + "))";
}
double area(const Board& board, int layer, int net = -2) {
  tests::UnionArea sum;
  for (const board::Shape& shape : board.shapes())
    if (shape.copper_layer == layer && (net == -2 || shape.net == net)) sum.add(shape.figure, {.sagitta_nm = 10});
  return sum.mm2();
}
geometry::Box box(const Board& board, int layer = 0) {
  geometry::Box all;
  for (const board::Shape& shape : board.shapes())
    if (shape.copper_layer == layer) all.add(geometry::bounds(shape.figure));
  return all;
}
constexpr double pi = 3.14159265358979;

TEST(KicadReader, NegatesYAndKeepsNetsLinesAndKinds) {
  const auto [board, said] = read(edge + "\n(segment (start 1 2) (end 4 6) (width 0.2) (layer \"In2.Cu\") (net 2))");
  ASSERT_EQ(board.shapes().size(), 1U);
  const board::Shape& s = board.shapes()[0];
  EXPECT_EQ(s.figure.path.points, (geometry::Ring{{1'000'000, -2'000'000}, {4'000'000, -6'000'000}}));
  EXPECT_EQ(s.figure.pen, 200'000);
  EXPECT_EQ(s.copper_layer, 2);
  EXPECT_EQ(s.kind, ShapeKind::track);
  EXPECT_EQ(board.net_name(s.net), "/a b");
  EXPECT_EQ(s.line, 7);
  EXPECT_EQ(board.name(), "test");
  EXPECT_EQ(said.count("kicad.unknown_construct"), 0);
}

TEST(KicadReader, TakesNetsByNameWithoutCodes) {
  const auto board = read(
                         "(segment (start 1 2) (end 4 6) (width 0.2) (layer \"F.Cu\") (net \"GND\")) (via (at 1 1) (size 0.6) "
                         "(drill 0.3) (layers \"F.Cu\" \"B.Cu\") (net \"new\"))",
                         "20260206")
                         .board;
  EXPECT_EQ(board.net_name(board.shapes()[0].net), "GND");
  EXPECT_EQ(board.net_name(board.shapes()[1].net), "new");
  EXPECT_EQ(board.nets().size(), 3U);
}

TEST(KicadReader, ReadsArcsAndAlmostStraightOnes) {
  const auto board = read(
                         "(arc (start 0 0) (mid 1 -1) (end 2 0) (width 0.2) (layer \"F.Cu\") (net 1)) (arc (start 0 0) (mid 1 "
                         "0.000001) (end 2 0) (width 0.2) (layer \"B.Cu\") (net 1))")
                         .board;
  EXPECT_NEAR(area(board, 0), pi * 0.2 + pi * 0.01, 1e-4);
  EXPECT_NEAR(area(board, 3), 0.4 + pi * 0.01, 1e-4);
}

TEST(KicadReader, ViasOfEverySpan) {
  const auto board = read(
                         "(via (at 1 1) (size 0.6) (drill 0.3) (layers \"F.Cu\" \"B.Cu\") (net 1))"
                         "(via blind (at 2 1) (size 0.6) (drill 0.3) (layers \"In1.Cu\" \"In2.Cu\") (net 1))"
                         "(via micro (at 3 1) (size 0.4) (drill 0.1) (layers \"B.Cu\" \"In2.Cu\") (net 1))"
                         "(via buried (at 4 1) (size 0.4) (drill 0.1) (layers \"In1.Cu\" \"In2.Cu\") (net 1))")
                         .board;
  ASSERT_EQ(board.drills().size(), 4U);
  const int spans[4][2] = {{0, 3}, {1, 2}, {2, 3}, {1, 2}};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(board.drills()[i].first_copper, spans[i][0]) << i;
    EXPECT_EQ(board.drills()[i].last_copper, spans[i][1]) << i;
    EXPECT_TRUE(board.drills()[i].plated);
  }
  EXPECT_EQ(board.shapes().size(), 4U + 2 + 2 + 2);
}

TEST(KicadReader, ViaPadstacks) {
  const auto inner = read(
                         "(via (at 1 1) (size 1) (drill 0.3) (layers \"F.Cu\" \"B.Cu\") (net 1) (padstack (mode "
                         "front_inner_back) (layer \"Inner\" (size 0.6)) (layer \"B.Cu\" (size 0.8))))")
                         .board;
  const auto custom = read(
                          "(via (at 1 1) (size 1) (drill 0.3) (layers \"F.Cu\" \"B.Cu\") (net 1) (padstack (mode custom) "
                          "(layer \"In2.Cu\" (size 0.5))))")
                          .board;
  const double d_inner[4] = {1, 0.6, 0.6, 0.8}, d_custom[4] = {1, 1, 0.5, 1};
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(area(inner, i), pi / 4 * d_inner[i] * d_inner[i], 1e-3) << i;
    EXPECT_NEAR(area(custom, i), pi / 4 * d_custom[i] * d_custom[i], 1e-3) << i;
  }
}

TEST(KicadReader, UnusedRingsNeedAConnection) {
  const std::string via = "(via (at 5 5) (size 0.6) (drill 0.3) (layers \"F.Cu\" \"B.Cu\") (net 1) (remove_unused_layers yes) ";
  const std::string track =
      "(segment (start 5 5) (end 8 5) (width 0.2) (layer \"In1.Cu\") (net 1)) (segment (start 5 5) (end 5 8) (width 0.2) "
      "(layer \"In2.Cu\") (net 2))";
  const auto rings = [](const Board& board) {
    std::string layers;
    for (const board::Shape& s : board.shapes())
      if (s.kind == ShapeKind::via) layers += static_cast<char>('0' + s.copper_layer);
    std::sort(layers.begin(), layers.end());
    return layers;
  };
  EXPECT_EQ(rings(read(via + "(keep_end_layers yes))" + track).board), "013");
  EXPECT_EQ(rings(read(via + "(keep_end_layers no))" + track).board), "1");
  EXPECT_EQ(rings(read(via + "(keep_end_layers yes) (zone_layer_connections \"In2.Cu\"))").board), "023");
  const std::string fill =
      "(zone (net 1) (net_name \"GND\") (layer \"In2.Cu\") (fill yes) (polygon (pts (xy 0 0) (xy 9 0) (xy 9 9))) "
      "(filled_polygon (layer \"In2.Cu\") (pts (xy 0 0) (xy 9 0) (xy 9 9) (xy 0 9))))";
  EXPECT_EQ(rings(read(via + "(keep_end_layers yes))" + fill).board), "023");
  EXPECT_EQ(rings(read(via + "(keep_end_layers yes) (zone_layer_connections))" + fill).board), "03");
  const std::string other =
      "(via (at 5.5 5) (size 0.6) (drill 0.3) (layers \"F.Cu\" \"B.Cu\") (net 1) (remove_unused_layers) (keep_end_layers))";
  const std::string kissing =
      "(via (at 5.6 5) (size 0.6) (drill 0.3) (layers \"F.Cu\" \"B.Cu\") (net 1) (remove_unused_layers) (keep_end_layers))";
  EXPECT_EQ(rings(read(via + "(keep_end_layers yes))" + other).board), "00112233");
  EXPECT_EQ(rings(read(via + "(keep_end_layers yes))" + kissing).board), "0033");
}

TEST(KicadReader, BackdrillsAreUnplatedHoles) {
  const auto board = read(
                         "(via (at 5 5) (size 0.6) (drill 0.3) (backdrill (size 0.5) (layers \"B.Cu\" \"In2.Cu\")) (layers "
                         "\"F.Cu\" \"B.Cu\") (net \"GND\"))",
                         "20260206")
                         .board;
  ASSERT_EQ(board.drills().size(), 2U);
  EXPECT_FALSE(board.drills()[1].plated);
  EXPECT_TRUE(board.drills()[1].is_backdrill);
  EXPECT_EQ(board.drills()[1].first_copper, 2);
  EXPECT_EQ(board.drills()[1].figure.pen, 500'000);
}

TEST(KicadReader, OldViasTakeTheirDrillFromTheNetClass) {
  const auto [board, said] = read(
      "(net_class Default \"\" (via_dia 0.8) (via_drill 0.4) (add_net GND)) (net_class Thin \"\" (via_drill 0.2) (add_net \"/a "
      "b\"))"
      "(via (at 1 1) (size 0.8) (layers F.Cu B.Cu) (net 1)) (via (at 3 1) (size 0.8) (layers F.Cu B.Cu) (net 2))",
      "4");
  EXPECT_EQ(board.drills()[0].figure.pen, 400'000);
  EXPECT_EQ(board.drills()[1].figure.pen, 200'000);
  EXPECT_EQ(said.count("kicad.via_default_drill"), 2);
}

TEST(KicadReader, PadShapesHaveTheirAreas) {
  const auto of = [](const std::string& shape, const std::string& rest) { return area(read(pad(shape, rest)).board, 0); };
  EXPECT_NEAR(of("circle", "(size 2 1)"), pi, 1e-3);
  EXPECT_NEAR(of("rect", "(size 2 1)"), 2, 1e-9);
  EXPECT_NEAR(of("oval", "(size 2 1)"), 1 + pi / 4, 1e-3);
  EXPECT_NEAR(of("roundrect", "(size 2 1) (roundrect_rratio 0.25)"), 2 - (4 - pi) * 0.0625, 1e-3);
  EXPECT_NEAR(of("roundrect", "(size 2 1) (roundrect_rratio 0.5)"), 1 + pi / 4, 1e-3);
  EXPECT_NEAR(of("roundrect", "(size 2 1) (roundrect_rratio 0) (chamfer_ratio 0.2) (chamfer top_left bottom_right)"), 2 - 0.04,
              1e-6);
  EXPECT_NEAR(of("roundrect", "(size 2 1) (roundrect_rratio 0.25) (chamfer_ratio 0.2) (chamfer top_left)"),
              2 - (4 - pi) * 0.0625 * 0.75 - 0.02, 1e-3);
  EXPECT_NEAR(of("trapezoid", "(size 2 1) (rect_delta 0 0.5)"), 2, 1e-9);
  EXPECT_NEAR(of("custom",
                 "(size 1 1) (options (anchor circle)) (primitives (gr_poly (pts (xy 2 0) (xy 3 0) (xy 3 1) (xy 2 1)) (width "
                 "0) (fill yes)))"),
              pi / 4 + 1, 1e-3);
  EXPECT_NEAR(of("custom",
                 "(size 1 1) (options (anchor rect)) (primitives (gr_line (start 2 0) (end 4 0) (width 0.5)) (gr_circle "
                 "(center 6 0) (end 7 0) (width 0.2)))"),
              1 + 1 + pi / 16 + pi * (1.1 * 1.1 - 0.9 * 0.9), 1e-2);
}

TEST(KicadReader, CornersAndTrapezoidsPointTheRightWay) {
  // Top left in KiCad's y-down frame is (-1, -0.5), which is (-1, +0.5) on our board.
  const auto cut =
      read(pad("roundrect", "(size 2 1) (roundrect_rratio 0) (chamfer_ratio 0.2) (chamfer top_left)", "(at 0 0)", "(at 0 0)"))
          .board;
  const auto& p = cut.shapes()[0].figure.path.points;
  EXPECT_EQ(std::count(p.begin(), p.end(), geometry::Point{-1'000'000, 500'000}), 0);
  EXPECT_EQ(std::count(p.begin(), p.end(), geometry::Point{-800'000, 500'000}), 1);
  EXPECT_EQ(std::count(p.begin(), p.end(), geometry::Point{1'000'000, 500'000}), 1);
  // (rect_delta 0 dy): narrower at y = -h/2, which is our top.
  const auto wedge = read(pad("trapezoid", "(size 2 1) (rect_delta 0 0.5)", "(at 0 0)", "(at 0 0)")).board;
  const auto& w = wedge.shapes()[0].figure.path.points;
  EXPECT_EQ(std::count(w.begin(), w.end(), geometry::Point{-750'000, 500'000}), 1);
  EXPECT_EQ(std::count(w.begin(), w.end(), geometry::Point{1'250'000, -500'000}), 1);
}

TEST(KicadReader, FootprintsTurnPositionsAndPadsKeepTheirOwnAngle) {
  // Footprint at (10, 5) turned by 90: the pad at (2, 0) lands at (10, 3); its own angle, absolute, is 90.
  const auto board = read(pad("rect", "(size 2 1)", "(at 2 0 90)", "(at 10 5 90)")).board;
  const geometry::Box b = box(board);
  EXPECT_EQ(b.min, (geometry::Point{9'500'000, -4'000'000}));
  EXPECT_EQ(b.max, (geometry::Point{10'500'000, -2'000'000}));
  const auto level = read(pad("rect", "(size 2 1)", "(at 2 0)", "(at 10 5 90)")).board;
  EXPECT_EQ(box(level).min, (geometry::Point{9'000'000, -3'500'000}));
}

TEST(KicadReader, PinsNameComponentNumberNetAndSide) {
  const auto board = read(pad("rect", "(size 2 1)", "(at 2 0 90)", "(at 10 5 90)")).board;
  ASSERT_EQ(board.pins().size(), 1U);
  const board::Pin& pin = board.pins()[0];
  EXPECT_EQ(pin.component, "U3");
  EXPECT_EQ(pin.number, "7");
  EXPECT_EQ(board.net_name(pin.net), "GND");
  EXPECT_EQ(pin.at, (geometry::Point{10'000'000, -3'000'000}));
  EXPECT_EQ(pin.copper_layer, 0);
  const auto below = read(
                         "(module old (layer B.Cu) (at 1 1) (fp_text reference R9 (at 0 0) (layer B.SilkS)) (pad 1 smd rect "
                         "(at 0 0) (size 1 1) (layers B.Cu B.Mask) (net 1 GND)))",
                         "20171130")
                         .board;
  EXPECT_EQ(below.pins()[0].component, "R9");
  EXPECT_EQ(below.pins()[0].copper_layer, 3);
}

TEST(KicadReader, HolesOfPads) {
  const std::string before = "(footprint \"f\" (layer \"F.Cu\") (at 0 0) (pad \"1\" ",
                    after = " (layers \"*.Cu\" \"*.Mask\")))";
  const auto slot = read(before + "thru_hole oval (at 3 0 90) (size 3 2) (drill oval 2 0.8)" + after).board;
  EXPECT_EQ(slot.drills()[0].figure.pen, 800'000);
  EXPECT_EQ(slot.drills()[0].figure.path.points, (geometry::Ring{{3'000'000, -600'000}, {3'000'000, 600'000}}));
  // The offset moves the copper, not the hole; it turns with the pad.
  const auto offset = read(before + "thru_hole circle (at 3 0 90) (size 2 2) (drill 0.8 (offset 0.5 0))" + after).board;
  EXPECT_EQ(offset.drills()[0].figure.path.points, (geometry::Ring{{3'000'000, 0}}));
  EXPECT_EQ(offset.shapes()[0].figure.path.points, (geometry::Ring{{3'000'000, 500'000}}));
  EXPECT_EQ(offset.shapes().size(), 4U);
  const auto bare = read(before + "np_thru_hole circle (at 3 0) (size 2 2) (drill 2)" + after).board;
  EXPECT_TRUE(bare.shapes().empty());
  EXPECT_FALSE(bare.drills()[0].plated);
  const auto outer = read(
                         "(footprint \"f\" (layer \"F.Cu\") (at 0 0) (pad \"1\" thru_hole circle (at 0 0) (size 2 2) (drill 1) "
                         "(layers \"F&B.Cu\")))")
                         .board;
  ASSERT_EQ(outer.shapes().size(), 2U);
  EXPECT_EQ(outer.shapes()[1].copper_layer, 3);
}

TEST(KicadReader, PadstackLayersHaveTheirOwnShape) {
  const auto board =
      read(
          "(footprint \"f\" (layer \"F.Cu\") (at 0 0) (pad \"1\" thru_hole circle (at 0 0) (size 2 2) (drill 1) (layers "
          "\"*.Cu\") (padstack (mode front_inner_back)"
          " (layer \"Inner\" (shape rect) (size 1.2 1.2)) (layer \"B.Cu\" (shape oval) (size 2 1) (offset 1 0)))))")
          .board;
  EXPECT_NEAR(area(board, 0), pi, 1e-3);
  EXPECT_NEAR(area(board, 1), 1.44, 1e-9);
  EXPECT_NEAR(area(board, 2), 1.44, 1e-9);
  EXPECT_NEAR(area(board, 3), 1 + pi / 4, 1e-3);
  EXPECT_EQ(box(board, 3).max.x, 2'000'000);
}

std::string zone(const std::string& more, const std::string& fill =
                                              "(filled_polygon (layer \"In1.Cu\") (pts (xy 0 0) (xy 10 0) (xy 10 10) (xy 0 10) "
                                              "(xy 0 0) (xy 4 4) (xy 4 6) (xy 6 6) (xy 6 4) (xy 4 4)))") {
  return "(zone (net 1) (net_name \"GND\") (layer \"In1.Cu\") (min_thickness 0.2) " + more +
         " (polygon (pts (xy -1 -1) (xy 11 -1) (xy 11 11) (xy -1 11)))" + fill + ")";
}

TEST(KicadReader, FillsKeepTheHolesHungOnSlits) {
  const auto board = read(zone("(fill yes)")).board;
  EXPECT_EQ(board.shapes()[0].kind, ShapeKind::fill);
  EXPECT_NEAR(area(board, 1), 96, 1e-9);
  const auto arc =
      read(zone("(fill yes)", "(filled_polygon (layer \"In1.Cu\") (pts (arc (start 0 0) (mid 1 -1) (end 2 0))))")).board;
  EXPECT_NEAR(area(arc, 1), pi / 2, 1e-4);
}

TEST(KicadReader, OldFillsAreStroked) {
  const double stroked = 96 + 0.1 * 40 + pi * 0.01 + 4 - 1.8 * 1.8;
  EXPECT_NEAR(area(read(zone("(fill yes)"), "20211014").board, 1), stroked, 1e-3);
  EXPECT_NEAR(area(read(zone("(fill yes) (filled_areas_thickness no)"), "20211014").board, 1), 96, 1e-9);
  EXPECT_NEAR(area(read(zone("(fill yes)"), "20220211").board, 1), 96, 1e-9);
  const auto v5 = read(zone("(fill yes)", "(filled_polygon (pts (xy 0 0) (xy 1 0) (xy 1 1)))"), "20171130").board;
  EXPECT_EQ(v5.shapes()[0].copper_layer, 1);
  EXPECT_EQ(v5.shapes()[0].figure.pen, 200'000);
  const auto segments =
      read(zone("(fill yes (mode segment))", "(fill_segments (pts (xy 0 0) (xy 1 0)) (pts (xy 0 1) (xy 1 1)))"), "20171130")
          .board;
  EXPECT_NEAR(area(segments, 1), 2 * (0.2 + pi * 0.01), 1e-4);
}

TEST(KicadReader, SaysWhichZonesAreNotFilled) {
  const std::string unfilled = zone("(fill (thermal_gap 0.5))", ""), empty = zone("(fill yes)", "");
  const auto [board, said] = read(unfilled + empty + zone("(keepout (tracks allowed))", ""));
  EXPECT_TRUE(board.shapes().empty());
  EXPECT_EQ(said.count("kicad.unfilled_zone"), 1);
  EXPECT_EQ(said.count("kicad.empty_zone"), 1);
  const auto entry = std::find_if(said.entries().begin(), said.entries().end(),
                                  [](const Diagnostic& d) { return d.code == "kicad.unfilled_zone"; });
  EXPECT_EQ(entry->spots[0].text(), "test.kicad_pcb:6, layer In1.Cu, net GND, at (-1, 1) mm");
}

TEST(KicadReader, DrawingsOnCopper) {
  const auto of = [](const std::string& item, const std::string& version = "20241229") {
    return area(read(item, version).board, 0);
  };
  EXPECT_NEAR(of("(gr_line (start 0 0) (end 2 0) (stroke (width 0.5) (type dash)) (layer \"F.Cu\") (net 1))"), 1 + pi / 16,
              1e-3);
  EXPECT_NEAR(of("(gr_circle (center 0 0) (end 1 0) (stroke (width 0.2)) (fill yes) (layer \"F.Cu\"))"), pi * 1.21, 1e-3);
  EXPECT_NEAR(of("(gr_circle (center 0 0) (end 1 0) (stroke (width 0.2)) (fill no) (layer \"F.Cu\"))"), pi * 0.4, 1e-3);
  EXPECT_NEAR(of("(gr_rect (start 2 3) (end 0 0) (stroke (width 0)) (fill solid) (layer \"F.Cu\"))"), 6, 1e-9);
  EXPECT_NEAR(of("(gr_rect (start 0 0) (end 4 2) (stroke (width 0)) (fill yes) (radius 1) (layer \"F.Cu\"))"), 4 + pi, 1e-3);
  EXPECT_NEAR(of("(gr_poly (pts (xy 0 0) (xy 2 0) (xy 2 2)) (layer F.Cu) (width 0))", "20171130"), 2, 1e-9);
  // The old arc: start is the centre, end the arc's start, 90 degrees clockwise on the screen: from (1, 0) to (0, 1), y down.
  const auto old_arc = read("(gr_arc (start 0 0) (end 1 0) (angle 90) (layer F.Cu) (width 0.2))", "20171130").board;
  EXPECT_EQ(old_arc.shapes()[0].figure.path.points.back(), (geometry::Point{0, -1'000'000}));
  EXPECT_NEAR(area(old_arc, 0), pi / 2 * 0.2 + pi * 0.01, 1e-3);
  const double quarter_of_circle = 0.5522847498;
  const std::string k = std::to_string(quarter_of_circle);
  EXPECT_NEAR(of("(gr_curve (pts (xy 1 0) (xy 1 " + k + ") (xy " + k + " 1) (xy 0 1)) (stroke (width 0.2)) (layer \"F.Cu\"))"),
              pi / 2 * 0.2 + pi * 0.01, 1e-3);
  const auto turned = read(
                          "(footprint \"f\" (layer \"F.Cu\") (at 10 5 90) (fp_line (start 0 0) (end 2 0) (stroke (width 0.5)) "
                          "(layer \"F.Cu\")))")
                          .board;
  EXPECT_EQ(turned.shapes()[0].figure.path.points, (geometry::Ring{{10'000'000, -5'000'000}, {10'000'000, -3'000'000}}));
}

TEST(KicadReader, DrawingsAdoptTheNetTheyTouch) {
  const std::string track = "(segment (start 0 0) (end 1 0) (width 0.2) (layer \"F.Cu\") (net 1))";
  const std::string chain =
      "(gr_line (start 5 0) (end 9 0) (stroke (width 0.2)) (layer \"F.Cu\"))"
      "(gr_rect (start 0.5 -1) (end 5 1) (stroke (width 0)) (fill yes) (layer \"F.Cu\"))";
  const auto adopted = read(track + chain).board;
  EXPECT_EQ(adopted.shapes()[1].net, 0);
  EXPECT_EQ(adopted.shapes()[2].net, 0);
  const auto apart = read(track + "(gr_line (start 1.2 0) (end 9 0) (stroke (width 0.2)) (layer \"F.Cu\"))").board;
  EXPECT_EQ(apart.shapes()[1].net, board::no_net);
  const auto shorted = read(track + chain + "(segment (start 9 0) (end 9 1) (width 0.2) (layer \"F.Cu\") (net 2))");
  EXPECT_EQ(shorted.board.shapes()[1].net, board::no_net);
  EXPECT_EQ(shorted.diagnostics.count("kicad.drawing_joins_nets"), 2);
  const auto tie =
      read(
          track +
          "(footprint \"tie\" (layer \"F.Cu\") (at 0 0) (fp_line (start 0 0) (end 5 0) (stroke (width 0.2)) (layer \"F.Cu\")))")
          .board;
  EXPECT_EQ(tie.shapes()[1].net, board::no_net);
}

TEST(KicadReader, CountsTextOnCopper) {
  const auto said =
      read(
          "(gr_text \"HI\" (at 1 2) (layer \"F.Cu\" knockout) (effects (font))) (gr_text \"HI\" (at 1 2) (layer \"F.SilkS\"))"
          "(footprint \"f\" (layer \"F.Cu\") (at 0 0) (fp_text user \"x\" (at 0 0) (layer \"B.Cu\")) (fp_text user \"x\" (at 0 "
          "0) (layer \"B.Cu\") hide) (property \"P\" \"x\" (at 0 0) (layer \"B.Cu\") (hide yes)))"
          "(dimension (type aligned) (layer \"F.Cu\"))")
          .diagnostics;
  EXPECT_EQ(said.count("kicad.text_on_copper"), 2);
  EXPECT_EQ(said.count("kicad.annotation_on_copper"), 1);
}

TEST(KicadReader, UnknownConstructsAreSkippedAndCounted) {
  const auto [board, said] = read(
      "(frobnicate (deep (deeper 1)) (segment)) (frobnicate) (segment (start 0 0) (end 1 0) (width 0.1) (layer \"F.Cu\") (net "
      "1) (sparkle 3))"
      "(embedded_files (file (data |abc(((|))) (generated (type tuning_pattern)) (group \"g\" (members a b))");
  EXPECT_EQ(board.shapes().size(), 1U);
  EXPECT_EQ(said.count("kicad.unknown_construct.frobnicate"), 2);
  EXPECT_EQ(said.count("kicad.unknown_construct.sparkle"), 1);
  EXPECT_EQ(said.count("kicad.unknown_construct.group"), 0);
}

TEST(KicadReader, OutlinesWithCutOutsAndSeveralBoards) {
  const auto board = read(edge +
                          "(gr_circle (center 5 5) (end 6 5) (stroke (width 0.1)) (fill no) (layer \"Edge.Cuts\"))"
                          "(footprint \"f\" (layer \"F.Cu\") (at 15 5 90) (fp_rect (start -1 -2) (end 1 2) (stroke (width "
                          "0.1)) (layer \"Edge.Cuts\")))"
                          "(gr_line (start 30 0) (end 40 0) (layer \"Edge.Cuts\")) (gr_line (start 40.0005 0) (end 40 10) "
                          "(layer \"Edge.Cuts\"))"
                          "(gr_line (start 40 10) (end 40.0005 0) (layer \"Edge.Cuts\")) (gr_arc (start 40 10) (mid 35 15) "
                          "(end 30 10) (layer \"Edge.Cuts\")) (gr_line (start 30 0.003) (end 30 10) (layer \"Edge.Cuts\"))")
                         .board;
  ASSERT_EQ(board.outlines().size(), 2U);
  EXPECT_EQ(board.outlines()[0].cutouts.size(), 2U);
  const auto size = [](const geometry::Path& path) {
    return std::abs(geometry::area_mm2(geometry::flatten(path, {.sagitta_nm = 100})));
  };
  EXPECT_NEAR(size(board.outlines()[0].outer), 200, 1e-9);
  EXPECT_NEAR(size(board.outlines()[0].cutouts[0]) + size(board.outlines()[0].cutouts[1]), pi + 8, 1e-3);
  EXPECT_NEAR(size(board.outlines()[1].outer), 100 + pi * 12.5, 0.04);
}

TEST(KicadReader, ReportsOpenCrossingAndAbsentOutlines) {
  const auto open = read(
      "(gr_line (start 0 0) (end 40 0) (layer \"Edge.Cuts\")) (gr_line (start 40 0) (end 40 10) (layer \"Edge.Cuts\")) "
      "(gr_line (start 40 10) (end 0 0.02) (layer \"Edge.Cuts\"))");
  EXPECT_TRUE(open.board.outlines().empty());
  EXPECT_EQ(open.diagnostics.count("kicad.outline_open"), 1);
  EXPECT_EQ(open.diagnostics.count("kicad.no_outline"), 1);
  EXPECT_NE(open.diagnostics.entries()[1].text.find("gap of 0.0200 mm"), std::string::npos)
      << open.diagnostics.entries()[1].text;
  const auto crossing =
      read("(gr_poly (pts (xy 0 0) (xy 10 10) (xy 10 0) (xy 0 10)) (stroke (width 0.1)) (fill no) (layer \"Edge.Cuts\"))");
  EXPECT_EQ(crossing.diagnostics.count("kicad.outline_crosses_itself"), 1);
  EXPECT_EQ(crossing.board.outlines().size(), 1U);
  EXPECT_EQ(read("").diagnostics.count("kicad.no_outline"), 1);
}

TEST(KicadReader, StackupIsReadAndPliesAreSummed) {
  const auto [board, said] = read(
      edge, "20241229",
      "(stackup (layer \"F.SilkS\" (type \"Top Silk Screen\")) (layer \"F.Mask\" (type \"Top Solder Mask\") (thickness 0.01))"
      "(layer \"F.Cu\" (type \"copper\") (thickness 0.035)) (layer \"dielectric 1\" (type \"prepreg\") (thickness 0.1) "
      "(material \"A\") (epsilon_r 4) (loss_tangent 0.01) addsublayer (thickness 0.1 locked) (material \"B\") (epsilon_r 2) "
      "(loss_tangent 0.02))"
      "(layer \"In1.Cu\" (type \"copper\") (thickness 0.0175)) (layer \"dielectric 2\" (type \"core\") (thickness 1) (material "
      "\"FR4\") (epsilon_r 4.5) (loss_tangent 0.02))"
      "(layer \"In2.Cu\" (type \"copper\") (thickness 0)) (layer \"dielectric 3\" (type \"prepreg\") (thickness 0.2) (material "
      "\"FR4\"))"
      "(layer \"B.Cu\" (type \"copper\") (thickness 0.035)) (layer \"B.Mask\" (type \"Bottom Solder Mask\") (thickness 0)) "
      "(copper_finish \"ENIG\"))");
  ASSERT_EQ(board.stackup().size(), 8U);
  const board::StackupLayer& plies = board.stackup()[2];
  EXPECT_EQ(plies.thickness_nm, 200'000);
  const board::Material& material = board.materials()[static_cast<std::size_t>(plies.material)];
  EXPECT_EQ(material.name, "A + B");
  EXPECT_NEAR(material.eps_r, 0.2 / (0.1 / 4 + 0.1 / 2), 1e-9);
  EXPECT_EQ(board.stackup()[3].name, "In1.Cu");
  EXPECT_EQ(board.stackup()[3].user_name, "ground");
  EXPECT_EQ(board.stackup()[0].kind, board::LayerKind::solder_mask);
  EXPECT_EQ(board.materials()[static_cast<std::size_t>(board.stackup()[0].material)].eps_r, 3.3);
  EXPECT_EQ(board.stackup()[5].thickness_nm, 35'000);
  EXPECT_EQ(said.count("kicad.copper_thickness"), 1);
  EXPECT_EQ(said.count("kicad.zero_thickness"), 1);
  EXPECT_EQ(said.count("kicad.epsilon_r"), 1);
  EXPECT_EQ(said.count("kicad.loss_tangent"), 1);
}

TEST(KicadReader, AbsentStackupGetsTheDocumentedDefault) {
  const auto [board, said] = read(edge);
  ASSERT_EQ(board.stackup().size(), 7U);
  EXPECT_EQ(board.stackup()[0].thickness_nm, 35'000);
  EXPECT_EQ(board.stackup()[1].thickness_nm, (1'600'000 - 4 * 35'000) / 3);
  EXPECT_EQ(said.count("kicad.default_stackup"), 1);
}

TEST(KicadReader, CopperLayersMustNotTouch) {
  const Error error = error_of(text_of(edge, "20241229",
                                       "(stackup (layer \"F.Cu\" (type \"copper\") (thickness 0.035)) (layer \"dielectric 1\" "
                                       "(type \"core\") (thickness 0) (epsilon_r 4.5))"
                                       "(layer \"In1.Cu\" (type \"copper\") (thickness 0.035)) (layer \"In2.Cu\" (type "
                                       "\"copper\") (thickness 0.035)) (layer \"B.Cu\" (type \"copper\") (thickness 0.035)))"));
  EXPECT_EQ(error.code(), ErrorCode::stackup_invalid);
  EXPECT_EQ(error.spot().line, 4);
  EXPECT_EQ(error.spot().layer, "F.Cu");
}

TEST(KicadReader, RenamedLayersOfVersion5RankByOrdinal) {
  const auto board = read_text(
                         "(kicad_pcb (version 20171130) (general (thickness 1.6)) (layers (31 Bottom signal) (0 \"Top\" "
                         "signal) (2 PWR power) (1 GND1 power) (44 Edge.Cuts user))"
                         "(net 0 \"\") (net 1 GND) (segment (start 0 0) (end 1 0) (width 0.1) (layer PWR) (net 1))"
                         "(via (at 1 1) (size 0.6) (drill 0.3) (layers Top Bottom) (net 1)))")
                         .board;
  ASSERT_EQ(board.copper_layers().size(), 4U);
  EXPECT_EQ(board.copper_name(1), "In1.Cu");
  EXPECT_EQ(board.stackup()[2].user_name, "GND1");
  EXPECT_EQ(board.shapes()[0].copper_layer, 2);
  EXPECT_EQ(board.drills()[0].last_copper, 3);
}

TEST(KicadReader, RepairsTheBracketThe9Point0WriterForgets) {
  const auto [board, said] = read(
      "(footprint \"f\" (layer \"F.Cu\") (at 0 0) (pad \"1\" smd rect (at 0 0) (size 1 1) (layers \"F.Cu\") (teardrops "
      "(curved_edges no)filter_ratio 0.9) (enabled yes)) (net 1 \"GND\")))"
      "(segment (start 0 0) (end 1 0) (width 0.1) (layer \"F.Cu\") (net 1))");
  EXPECT_EQ(board.shapes().size(), 2U);
  EXPECT_EQ(said.count("kicad.bracket_repaired"), 1);
}

TEST(KicadReader, SniffsByItsFirstWord) {
  const auto sniff = formats::kicad::board_format.sniff;
  EXPECT_EQ(sniff("(kicad_pcb (version 4)", "x"), formats::Match::yes);
  EXPECT_EQ(sniff("  \n(kicad_pcb", "x"), formats::Match::yes);
  EXPECT_EQ(sniff("(kicad_sch", "x.kicad_sch"), formats::Match::no);
  EXPECT_EQ(sniff("", "x.kicad_pcb"), formats::Match::maybe);
}

}  // namespace
