// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/compose/compose.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

#include "formats/native_json/format.hpp"
#include "model_places.hpp"
#include "pcbmesh/base/error.hpp"
#include "pcbmesh/geometry/ring_contact.hpp"

namespace pcbmesh {
namespace {

using board::Board;
using formats::native_json::board_format;
using formats::native_json::parse_board;
using model::BodyKind;
using model::Label;
using model::Model;
using study::ConductorMode;
using study::RegionKind;
using study::Study;
using testing::label_at;

const std::filesystem::path examples = std::filesystem::path(PCBMESH_SOURCE_DIR) / "examples";

/// Board of 20 x 10 mm, four copper layers, with these further members.
Board board_with(const std::string& members, const std::string& outline = R"({"rect": [[0, 0], [20, 10]]})") {
  return parse_board(R"({"pcbmesh_board": 1, "outline": )" + outline + R"(,
    "materials": [{"name": "PP", "eps_r": 4}, {"name": "core", "eps_r": 4.5}, {"name": "ink", "eps_r": 3.3}],
    "stackup": [{"name": "mask", "kind": "solder_mask", "thickness": "20um", "material": "ink"},
      {"name": "L1", "kind": "copper", "thickness": "40um"},
      {"name": "prepreg 1", "kind": "dielectric", "thickness": "100um", "material": "PP"},
      {"name": "L2", "kind": "copper", "thickness": "30um"},
      {"name": "core 1", "kind": "dielectric", "thickness": "1mm", "material": "core"},
      {"name": "L3", "kind": "copper", "thickness": "30um"},
      {"name": "prepreg 2", "kind": "dielectric", "thickness": "100um", "material": "PP"},
      {"name": "L4", "kind": "copper", "thickness": "40um"},
      {"name": "mask below", "kind": "solder_mask", "thickness": "20um", "material": "ink"}])" +
                         (members.empty() ? "" : ", " + members) + "}",
                     "b.json")
      .board;
}

Study study_without_air() {
  Study s;
  s.air_above = s.air_below = s.air_around = 0;
  return s;
}

Model composed(const Board& board, const Study& s) {
  Diagnostics ignored;
  return compose::compose(board, s, ignored);
}

const model::Body* body_named(const Model& m, std::string_view name) {
  for (const model::Body& body : m.bodies())
    if (body.name == name) return &body;
  return nullptr;
}

void expect_error(const Board& board, const Study& s, ErrorCode code, std::initializer_list<std::string_view> words) {
  try {
    (void)composed(board, s);
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(static_cast<int>(error.code()), static_cast<int>(code)) << error.what();
    for (std::string_view word : words)
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << word << " in: " << error.what();
  }
}

geometry::Box domain_box(const Model& m) {
  geometry::Box box;
  for (const model::BodyShape& shape : m.shapes())
    if (shape.body == 0)
      for (const geometry::Ring& ring : shape.rings) box.add(geometry::bounds(ring));
  return box;
}

TEST(Compose, SlabsStandBottomToTopWithMaskLeftOut) {
  Diagnostics diagnostics;
  const Model m = compose::compose(board_with(""), Study{}, diagnostics);
  ASSERT_EQ(m.slabs().size(), 9U);
  const char* names[] = {"air below", "L4", "prepreg 2", "L3", "core 1", "L2", "prepreg 1", "L1", "air above"};
  for (std::size_t i = 0; i < 9; ++i) EXPECT_EQ(m.slabs()[i].layer, names[i]);
  EXPECT_EQ(m.slabs()[0].z_bottom_nm, -1'000'000);
  EXPECT_EQ(m.slabs()[1].z_bottom_nm, 0) << "z = 0 is the bottom of the lowest layer kept";
  EXPECT_EQ(m.slabs()[8].z_bottom_nm, 40'000 * 2 + 100'000 * 2 + 30'000 * 2 + 1'000'000);
  EXPECT_EQ(m.slabs()[8].z_top_nm, m.slabs()[8].z_bottom_nm + 1'000'000);
  EXPECT_EQ(m.slabs()[1].kind, model::SlabKind::copper);
  EXPECT_EQ(diagnostics.count("compose.solder_mask_left_out"), 2);
  EXPECT_EQ(diagnostics.count("compose.no_copper"), 1);
  EXPECT_EQ(composed(board_with(""), study_without_air()).slabs().size(), 7U);
}

TEST(Compose, CopperGapsTakePrepregInsideAndAirOutside) {
  const Model m = composed(board_with(""), Study{});
  EXPECT_EQ(label_at(m, "L1", 5, 5), "air|no net");
  EXPECT_EQ(label_at(m, "L2", 5, 5), "PP|no net") << "prepreg above, core below";
  EXPECT_EQ(label_at(m, "L3", 5, 5), "PP|no net") << "prepreg below, core above";
  EXPECT_EQ(label_at(m, "L4", 5, 5), "air|no net");
  EXPECT_EQ(label_at(m, "core 1", 5, 5), "core|no net");
}

TEST(Compose, WithoutTheWordPrepregTheLayerBelowFills) {
  const Board board = parse_board(R"({"pcbmesh_board": 1, "outline": {"rect": [[0, 0], [5, 5]]},
    "materials": [{"name": "X"}, {"name": "Y"}], "stackup": [
      {"name": "above", "kind": "dielectric", "thickness": 0.1, "material": "X"}, {"name": "cu", "kind": "copper", "thickness": 0.1},
      {"name": "below", "kind": "dielectric", "thickness": 0.1, "material": "Y"}]})",
                                  "b.json")
                          .board;
  EXPECT_EQ(label_at(composed(board, Study{}), "cu", 1, 1), "Y|no net");
}

TEST(Compose, AirIsReusedOrAddedUnderAFreeName) {
  const auto with_material = [](const char* material) {
    return composed(parse_board(fmt::format(R"({{"pcbmesh_board": 1, "outline": {{"rect": [[0, 0], [5, 5]]}}, "materials": [{}],
      "stackup": [{{"name": "cu", "kind": "copper", "thickness": 0.1}}]}})",
                                            material),
                                "b")
                        .board,
                    Study{});
  };
  EXPECT_EQ(with_material(R"({"name": "air"})").materials().size(), 2U);
  EXPECT_EQ(label_at(with_material(R"({"name": "air", "eps_r": 1.1})"), "cu", 1, 1), "air 2|no net");
}

TEST(Compose, WithAirTheDomainIsABoxWithoutItTheOutline) {
  const std::string triangle = R"({"points": [[0, 0], [20, 0], [0, 10]]})";
  Study s;
  s.air_around = 2 * nm_per_mm;
  const Model air = composed(board_with("", triangle), s);
  EXPECT_EQ(domain_box(air).min, (geometry::Point{-2'000'000, -2'000'000}));
  EXPECT_EQ(domain_box(air).max, (geometry::Point{22'000'000, 12'000'000}));
  EXPECT_EQ(label_at(air, "core 1", 19, 9), "air|no net");
  EXPECT_EQ(label_at(air, "core 1", 5, 5), "core|no net");
  EXPECT_EQ(label_at(air, "core 1", 22.5, 5), "void");
  const Model bare = composed(board_with("", triangle), study_without_air());
  EXPECT_EQ(label_at(bare, "core 1", 19, 9), "void");
  EXPECT_EQ(label_at(bare, "core 1", 5, 5), "core|no net");
  EXPECT_EQ(label_at(bare, "L1", 5, 5), "air|no net") << "the gap of an outer layer is air all the same";
}

TEST(Compose, BodiesAreOnePerLayerAndNet) {
  const Board board = board_with(R"("nets": ["A", "B"], "tracks": [
      {"layer": "L4", "net": "A", "width": 1, "points": [[2, 2], [8, 2]]},
      {"layer": "L1", "net": "B", "width": 1, "points": [[2, 2], [8, 2]]},
      {"layer": "L1", "net": "A", "width": 1, "points": [[2, 5], [8, 5]]},
      {"layer": "L1", "net": "A", "width": 1, "points": [[2, 5], [2, 8]]},
      {"layer": "L1", "width": 1, "points": [[15, 5], [18, 5]]}])");
  const Model m = composed(board, Study{});
  std::vector<std::string> names;
  for (const model::Body& body : m.bodies()) names.push_back(body.name);
  EXPECT_EQ(names, (std::vector<std::string>{"domain", "board", "copper none on L1", "copper A on L1", "copper B on L1",
                                             "copper A on L4"}));
  EXPECT_EQ(label_at(m, "L1", 5, 2), "copper|B");
  EXPECT_EQ(label_at(m, "L4", 5, 2), "copper|A");
  EXPECT_EQ(label_at(m, "L1", 16, 5), "copper|no net");
  EXPECT_EQ(label_at(m, "prepreg 1", 5, 2), "PP|no net");
  EXPECT_EQ(std::count_if(m.shapes().begin(), m.shapes().end(), [](const auto& s) { return s.body == 3; }), 2);
  EXPECT_EQ(m.bodies()[2].priority, 2);
}

TEST(Compose, BarrelsAreFilledAndHolesAreAir) {
  const Board board = board_with(R"("nets": ["A", "B"], "vias": [
      {"at": [2, 5], "drill": 1, "pad": 2, "net": "A"}, {"at": [6, 5], "drill": 1, "net": "A", "layers": ["L2", "L3"]},
      {"at": [10, 5], "drill": 1, "net": "B"}],
    "holes": [{"at": [14, 5], "diameter": 1}, {"at": [17, 5], "diameter": 1, "layers": ["L3", "L4"]}],
    "planes": [{"layer": "L3", "net": "B", "rect": [[8, 1], [19, 9]], "clearance": 0}])");
  const Model m = composed(board, Study{});
  for (const char* layer : {"L1", "prepreg 1", "L2", "core 1", "L3", "prepreg 2", "L4"}) {
    EXPECT_EQ(label_at(m, layer, 2, 5), "copper|A") << layer;
    EXPECT_EQ(label_at(m, layer, 10, 5), "copper|B") << layer;
    EXPECT_EQ(label_at(m, layer, 14, 5), "air|no net") << layer;
  }
  EXPECT_EQ(label_at(m, "air above", 2, 5), "air|no net");
  EXPECT_EQ(label_at(m, "L1", 6, 5), "air|no net");
  EXPECT_EQ(label_at(m, "L2", 6, 5), "copper|A");
  EXPECT_EQ(label_at(m, "core 1", 6, 5), "copper|A");
  EXPECT_EQ(label_at(m, "prepreg 2", 6, 5), "PP|no net");
  EXPECT_EQ(label_at(m, "prepreg 2", 17, 5), "air|no net");
  EXPECT_EQ(label_at(m, "core 1", 17, 5), "core|no net");
  EXPECT_EQ(label_at(m, "L3", 12, 5), "copper|B");
  ASSERT_NE(body_named(m, "barrel A L1 to L4"), nullptr);
  EXPECT_EQ(body_named(m, "barrel A L1 to L4")->priority, 4);
  EXPECT_EQ(body_named(m, "hole L1 to L4")->priority, 3);
}

TEST(Compose, HolesThroughAllCopperGoOnThroughOuterDielectric) {
  const Board board =
      parse_board(R"({"pcbmesh_board": 1, "outline": {"rect": [[0, 0], [9, 5]]}, "materials": [{"name": "X"}], "stackup": [
      {"name": "cover", "kind": "dielectric", "thickness": 0.1, "material": "X"}, {"name": "L1", "kind": "copper", "thickness": 0.1},
      {"name": "core", "kind": "dielectric", "thickness": 0.1, "material": "X"}, {"name": "L2", "kind": "copper", "thickness": 0.1},
      {"name": "base", "kind": "dielectric", "thickness": 0.1, "material": "X"}],
    "holes": [{"at": [1, 1], "diameter": 1}, {"at": [3, 1], "diameter": 1, "layers": ["L1", "L1"]}], "vias": [{"at": [5, 1], "drill": 1}]})",
                  "b.json")
          .board;
  const Model m = composed(board, Study{});
  const auto column = [&](double x) {
    std::string out;
    for (const char* layer : {"base", "L2", "core", "L1", "cover"}) out += label_at(m, layer, x, 1).substr(0, 3) + " ";
    return out;
  };
  EXPECT_EQ(column(1), "air air air air air ");
  EXPECT_EQ(column(3), "X|n X|n X|n air air ") << "from the top copper on, the cover is drilled as well";
  EXPECT_EQ(column(5), "X|n cop cop cop X|n ") << "the barrel ends at its copper";
}

TEST(Compose, HollowRulesLaterWin) {
  const Board board = board_with(R"("nets": ["A", "B"], "tracks": [
      {"layer": "L1", "net": "A", "width": 1, "points": [[2, 2], [8, 2]]}, {"layer": "L4", "net": "A", "width": 1, "points": [[2, 2], [8, 2]]},
      {"layer": "L1", "net": "B", "width": 1, "points": [[2, 5], [8, 5]]}, {"layer": "L1", "width": 1, "points": [[2, 8], [8, 8]]}],
    "vias": [{"at": [5, 2], "drill": 0.4, "net": "A"}])");
  const auto labels = [&](ConductorMode mode, std::vector<study::ConductorRule> rules) {
    Study s;
    s.conductors = mode;
    s.conductor_rules = std::move(rules);
    const Model m = composed(board, s);
    return fmt::format("{} {} {} {} {}", label_at(m, "L1", 3, 2), label_at(m, "L4", 3, 2), label_at(m, "L1", 3, 5),
                       label_at(m, "L1", 3, 8), label_at(m, "core 1", 5, 2));
  };
  constexpr auto hollow = ConductorMode::hollow, solid = ConductorMode::solid;
  EXPECT_EQ(labels(solid, {}), "copper|A copper|A copper|B copper|no net copper|A");
  EXPECT_EQ(labels(hollow, {}), "hollow|A hollow|A hollow|B hollow|no net hollow|A");
  EXPECT_EQ(labels(solid, {{"A", "", hollow}}), "hollow|A hollow|A copper|B copper|no net hollow|A");
  EXPECT_EQ(labels(solid, {{"", "L1", hollow}}), "hollow|A copper|A hollow|B hollow|no net copper|A");
  EXPECT_EQ(labels(solid, {{"A", "L1", hollow}}), "hollow|A copper|A copper|B copper|no net copper|A");
  EXPECT_EQ(labels(solid, {{"A", "", hollow}, {"", "L1", solid}}), "copper|A hollow|A copper|B copper|no net hollow|A");
  EXPECT_EQ(labels(solid, {{"", "L1", solid}, {"A", "", hollow}}), "hollow|A hollow|A copper|B copper|no net hollow|A");
  EXPECT_EQ(labels(hollow, {{"", "", solid}}), labels(solid, {}));
}

TEST(Compose, RegionByNetsIsTheirBoxAndTheMargin) {
  const Board board = board_with(R"("nets": ["A", "B", "bare"], "tracks": [
      {"layer": "L1", "net": "A", "width": 1, "points": [[5, 5], [8, 5]]}, {"layer": "L2", "net": "B", "width": 1, "points": [[0.5, 9], [19.5, 9]]},
      {"layer": "L2", "net": "B", "width": 1, "points": [[15, 2], [19, 2]]}],
    "vias": [{"at": [5, 5], "drill": 0.3, "pad": 1.4, "net": "A"}])");
  Study s;
  s.region = RegionKind::nets;
  s.nets = {"A"};
  s.margin = 4 * nm_per_mm;
  const Model m = composed(board, s);
  EXPECT_EQ(domain_box(m).min, (geometry::Point{300'000, 300'000}));
  EXPECT_EQ(domain_box(m).max, (geometry::Point{12'500'000, 9'700'000}));
  EXPECT_EQ(std::vector<std::int32_t>(m.nets_of_interest().begin(), m.nets_of_interest().end()), std::vector<std::int32_t>{0});
  EXPECT_EQ(label_at(m, "L2", 6, 9), "copper|B") << "all copper in the box stays";
  EXPECT_EQ(label_at(m, "L2", 13, 9), "void");
  // Everything was cut close to the box.
  for (const model::BodyShape& shape : m.shapes())
    for (const geometry::Ring& ring : shape.rings)
      EXPECT_TRUE(domain_box(m).grown(50'000).contains(geometry::bounds(ring).max));
  EXPECT_EQ(std::count_if(
                m.shapes().begin(), m.shapes().end(),
                [&](const auto& shape) { return m.bodies()[static_cast<std::size_t>(shape.body)].name == "copper B on L2"; }),
            1);
  // Larger than the board: cut down to it and the air beside it.
  s.margin = 100 * nm_per_mm;
  s.air_around = nm_per_mm;
  EXPECT_EQ(domain_box(composed(board, s)).max, (geometry::Point{21'000'000, 11'000'000}));
  s.nets = {"bare"};
  expect_error(board, s, ErrorCode::region_empty, {"bare", "no net of the region has copper"});
  s.nets = {"bare", "A"};
  Diagnostics diagnostics;
  (void)compose::compose(board, s, diagnostics);
  EXPECT_EQ(diagnostics.count("compose.net_without_copper"), 1);
}

TEST(Compose, RegionByBox) {
  const Board board = board_with(R"("planes": [{"layer": "L1", "net": "G"}])");
  Study s;
  s.region = RegionKind::box;
  s.box = geometry::Box{{-5'000'000, 2'000'000}, {3'000'000, 30'000'000}};
  const Model m = composed(board, s);
  EXPECT_EQ(domain_box(m).min, (geometry::Point{0, 2'000'000}));
  EXPECT_EQ(domain_box(m).max, (geometry::Point{3'000'000, 10'000'000}));
  EXPECT_EQ(label_at(m, "L1", 1, 5), "copper|G");
  EXPECT_EQ(label_at(m, "L1", 4, 5), "void");
  s.box = geometry::Box{{50'000'000, 0}, {60'000'000, 1'000'000}};
  expect_error(board, s, ErrorCode::region_empty, {"(50, 0)", "does not meet the board"});
  s.box = geometry::Box{{20'000'000, 0}, {60'000'000, 1'000'000}};
  expect_error(board, s, ErrorCode::region_empty, {"does not meet the board"});
  s.air_around = 5 * nm_per_mm;
  s.box = geometry::Box{{21'000'000, 0}, {60'000'000, 1'000'000}};
  expect_error(board, s, ErrorCode::region_empty, {"beside the board"});
  // A corner of the box in the notch of an L-shaped board.
  const Board bent = board_with("", R"({"points": [[0, 0], [20, 0], [20, 2], [2, 2], [2, 10], [0, 10]]})");
  s.box = geometry::Box{{5'000'000, 5'000'000}, {9'000'000, 9'000'000}};
  expect_error(bent, s, ErrorCode::region_empty, {"beside the board"});
}

TEST(Compose, UnknownNamesComeAllAtOnceWithNearMisses) {
  const Board board = board_with(R"("nets": ["USB_P", "USB_N", "GND"])");
  Study s;
  s.region = RegionKind::nets;
  s.nets = {"USB_O", "GND", "zzzzzzzz"};
  s.conductor_rules = {{"GDN", "", ConductorMode::hollow},
                       {"", "l1", ConductorMode::hollow},
                       {"", "core 1", ConductorMode::hollow},
                       {"GDN", "L2", ConductorMode::hollow}};
  expect_error(board, s, ErrorCode::name_unknown,
               {"'USB_O'", "'USB_P'", "'zzzzzzzz'", "'GDN'", "'GND'", "'l1'", "did you mean 'L1'", "'core 1'", "L1, L2, L3, L4",
                "b.json"});
}

TEST(Compose, CutoutsAreOutside) {
  const char* outline = R"({"rect": [[0, 0], [20, 10]], "cutouts": [{"circle": {"at": [5, 5], "diameter": 2}}]})";
  const Board board = board_with(R"("planes": [{"layer": "L1", "net": "G"}])", outline);
  const Model air = composed(board, Study{});
  EXPECT_EQ(label_at(air, "L1", 5, 5), "air|no net") << "copper over a cut-out is cut away";
  EXPECT_EQ(label_at(air, "core 1", 5, 5), "air|no net");
  EXPECT_EQ(label_at(air, "core 1", 7, 5), "core|no net");
  EXPECT_EQ(air.bodies().size(), 3U);
  EXPECT_EQ(label_at(composed(board, study_without_air()), "L1", 5, 5), "void");
}

TEST(Compose, CutoutsThatMeetAreUnitedAndNestedOnesCountOnce) {
  const char* outline = R"({"rect": [[0, 0], [20, 10]], "cutouts": [
    {"rect": [[3, 3], [6, 6]]}, {"rect": [[5, 5], [8, 8]]},
    {"rect": [[10, 2], [14, 6]]}, {"circle": {"at": [12, 4], "diameter": 1}},
    {"rect": [[18, 4], [22, 6]]}, {"rect": [[30, 4], [32, 6]]}]})";
  Diagnostics diagnostics;
  Study bare = study_without_air();
  for (const Study& s : {Study{}, bare}) {
    const std::string outside = s == bare ? "void" : "air|no net";
    diagnostics = {};
    const Model m = compose::compose(board_with("", outline), s, diagnostics);
    for (const auto& [x, y] : {std::pair{4.0, 4.0}, {5.5, 5.5}, {7.0, 7.0}, {11.0, 4.0}, {12.0, 4.0}, {19.0, 5.0}})
      EXPECT_EQ(label_at(m, "core 1", x, y), outside) << x << ' ' << y;
    for (const auto& [x, y] : {std::pair{1.0, 1.0}, {7.0, 4.0}, {17.0, 5.0}})
      EXPECT_EQ(label_at(m, "core 1", x, y), "core|no net") << x << ' ' << y;
    EXPECT_EQ(diagnostics.count("compose.cutout_meets_outline"), 3);
    EXPECT_EQ(diagnostics.count("compose.cutout_outside_outline"), 1);
  }
}

TEST(Compose, AlignedCutoutsOverlapWithoutCrossingEdges) {
  const Model m = composed(
      board_with("", R"({"rect": [[0, 0], [20, 10]], "cutouts": [{"rect": [[3, 3], [6, 6]]}, {"rect": [[5, 3], [8, 6]]}]})"),
      study_without_air());
  for (double x : {4.0, 5.5, 7.0}) EXPECT_EQ(label_at(m, "core 1", x, 4), "void") << x;
  EXPECT_EQ(label_at(m, "core 1", 8.5, 4), "core|no net");
}

TEST(Compose, SeveralBoardsMustNotOverlap) {
  const auto two = [](const char* second) {
    return board_with("",
                      fmt::format(R"([{{"rect": [[0, 0], [5, 5]], "cutouts": [{{"rect": [[1, 1], [4, 4]]}}]}}, {}])", second));
  };
  const Model panel = composed(two(R"({"rect": [[10, 0], [15, 5]]})"), study_without_air());
  EXPECT_EQ(label_at(panel, "core 1", 0.5, 2), "core|no net");
  EXPECT_EQ(label_at(panel, "core 1", 12, 2), "core|no net");
  EXPECT_EQ(label_at(panel, "core 1", 7, 2), "void");
  EXPECT_NO_THROW((void)composed(two(R"({"rect": [[5, 0], [9, 5]]})"), Study{})) << "sharing an edge";
  EXPECT_NO_THROW((void)composed(two(R"({"rect": [[2, 2], [3, 3]]})"), Study{})) << "inside the frame's cut-out";
  expect_error(two(R"({"rect": [[4, 4], [9, 9]]})"), Study{}, ErrorCode::outline_invalid, {"outlines 1 and 2 overlap"});
  expect_error(two(R"({"rect": [[0.2, 0.2], [0.8, 0.8]]})"), Study{}, ErrorCode::outline_invalid, {"overlap", "cut-out"});
  expect_error(two(R"({"rect": [[-1, -1], [9, 9]]})"), Study{}, ErrorCode::outline_invalid, {"overlap"});
  expect_error(two(R"({"rect": [[4.5, 0], [9, 5]]})"), Study{}, ErrorCode::outline_invalid, {"overlap"});  // aligned
  expect_error(two(R"({"rect": [[0, 0], [5, 5]]})"), Study{}, ErrorCode::outline_invalid, {"overlap"});
}

TEST(Compose, OutlineAbsentTakesTheCopperWithAWarning) {
  const Board board = board_with(
      R"("tracks": [{"layer": "L1", "width": 1, "points": [[3, 3], [8, 3]]}], "vias": [{"at": [10, 6], "drill": 2}])", "null");
  Diagnostics diagnostics;
  const Model m = compose::compose(board, Study{}, diagnostics);
  EXPECT_EQ(diagnostics.count("compose.outline_absent"), 1);
  EXPECT_EQ(domain_box(m).min, (geometry::Point{1'500'000, 1'500'000}));
  EXPECT_EQ(domain_box(m).max, (geometry::Point{12'000'000, 8'000'000}));
  expect_error(board_with("", "null"), Study{}, ErrorCode::outline_invalid, {"neither outline nor copper"});
}

TEST(Compose, OutlineThatCrossesItselfIsAnnounced) {
  Diagnostics diagnostics;
  (void)compose::compose(board_with("", R"({"points": [[0, 0], [20, 0], [20, 10], [12, -3], [0, 10]]})"), Study{}, diagnostics);
  EXPECT_EQ(diagnostics.count("compose.outline_crosses_itself"), 1);
}

TEST(Compose, CopperBesideTheBoardIsLeftOutAndNoted) {
  Diagnostics diagnostics;
  const Model m =
      compose::compose(board_with(R"("tracks": [{"layer": "L1", "net": "A", "width": 1, "points": [[30, 3], [38, 3]]},
      {"layer": "L1", "net": "A", "width": 1, "points": [[-5, 3], [5, 3]]}])"),
                       study_without_air(), diagnostics);
  EXPECT_EQ(diagnostics.count("compose.copper_outside_board"), 1);
  EXPECT_EQ(label_at(m, "L1", 1, 3), "copper|A");
  EXPECT_EQ(label_at(m, "L1", -1, 3), "void");
  ASSERT_EQ(m.shapes().back().rings.size(), 1U);
  EXPECT_EQ(geometry::bounds(m.shapes().back().rings[0]).min.x, -50'000);
  EXPECT_TRUE(m.shapes().back().simple) << "a clipped stroke stays simple";
}

TEST(Compose, SimpleMarksSurviveClipping) {
  const char* members =
      R"("polygons": [{"layer": "L1", "points": [[5, 5], [9, 5], [9, 6], [6, 6], [6, 9], [5, 9]]}, {"layer": "L2", "rect": [[5, 5], [9, 9]]}])";
  Study s;
  s.region = RegionKind::box;
  s.box = geometry::Box{{0, 0}, {7'000'000, 7'000'000}};
  const Model m = composed(board_with(members), s);
  ASSERT_EQ(m.shapes().size(), 4U);
  EXPECT_FALSE(m.shapes()[2].simple);
  EXPECT_TRUE(m.shapes()[3].simple);
  EXPECT_EQ(m.shapes()[3].line > 0, true);
}

TEST(Compose, NarrowestCountsTracksPadsAndHoles) {
  const auto narrowest = [](const char* members, std::vector<std::string> nets = {}) {
    Study s;
    s.nets = std::move(nets);
    const Model m = composed(board_with(members), s);
    return std::pair{m.narrowest_feature_nm(), m.narrowest_of_interest_nm()};
  };
  using Pair = std::pair<Nm, Nm>;
  EXPECT_EQ(narrowest(R"("polygons": [{"layer": "L1", "rect": [[1, 1], [1.01, 5]]}])"), (Pair{0, 0})) << "fills say nothing";
  EXPECT_EQ(narrowest(R"("polygons": [{"layer": "L1", "kind": "pad", "rect": [[1, 1], [1.2, 5]]}])"), (Pair{200'000, 0}));
  EXPECT_EQ(narrowest(R"("pads": [{"layer": "L1", "at": [5, 5], "size": [2, 0.25], "rotation": 45}])").first, 250'000)
      << "true width, not the box's";
  EXPECT_EQ(narrowest(R"("pads": [{"layer": "L1", "at": [5, 5], "size": [2, 0.25], "shape": "oval", "rotation": 30}])").first,
            250'000);
  EXPECT_EQ(narrowest(R"("vias": [{"at": [5, 5], "drill": 0.15, "pad": 0.4}])").first, 150'000);
  EXPECT_EQ(
      narrowest(
          R"("tracks": [{"layer": "L1", "net": "A", "width": 0.3, "points": [[1, 1], [2, 2]]}, {"layer": "L1", "net": "B", "width": 0.1, "points": [[4, 1], [5, 2]]}])",
          {"A"}),
      (Pair{100'000, 300'000}));
  EXPECT_EQ(
      narrowest(
          R"("tracks": [{"layer": "L1", "width": 0.3, "points": [[1, 1], [2, 2]]}, {"layer": "L1", "width": 0.1, "points": [[40, 1], [50, 2]]}])")
          .first,
      300'000)
      << "only what is in the domain";
}

TEST(Compose, BadStudiesAndDomainsBeyondAMetreAreRefused) {
  Study s;
  s.growth = std::nan("");
  expect_error(board_with(""), s, ErrorCode::study_invalid, {"/mesh/growth"});
  s = {};
  s.air_around = max_coordinate_nm;
  expect_error(board_with(""), s, ErrorCode::study_invalid, {"1 m"});
}

TEST(Compose, SameInputGivesTheSameModel) {
  const Board board = board_format.read(examples / "microstrip.json", Progress{}).board;
  const Model a = composed(board, Study{}), b = composed(board, Study{});
  EXPECT_TRUE(std::equal(a.bodies().begin(), a.bodies().end(), b.bodies().begin(), b.bodies().end()));
  EXPECT_TRUE(std::equal(a.shapes().begin(), a.shapes().end(), b.shapes().begin(), b.shapes().end()));
  EXPECT_TRUE(std::equal(a.slabs().begin(), a.slabs().end(), b.slabs().begin(), b.slabs().end()));
}

TEST(Compose, Microstrip) {
  const Model m = composed(board_format.read(examples / "microstrip.json", Progress{}).board,
                           study::read_study(examples / "microstrip.study.json"));
  EXPECT_EQ(label_at(m, "top", 12, 5), "hollow|LINE");
  EXPECT_EQ(label_at(m, "top", 12, 7), "air|no net");
  EXPECT_EQ(label_at(m, "bottom", 12, 5), "copper|GND");
  EXPECT_EQ(label_at(m, "core", 2, 2.5), "copper|GND");
  EXPECT_EQ(label_at(m, "core", 12, 1.5), "air|no net");
  EXPECT_EQ(label_at(m, "bottom", 12, 2.1), "air|no net") << "clearance round the screw hole";
  EXPECT_EQ(label_at(m, "core", 12, 8.5), "air|no net");
  EXPECT_EQ(label_at(m, "core", 0.05, 0.05), "air|no net") << "rounded corner";
}

TEST(Compose, PaperExamples) {
  const Study s = study::read_study(examples / "paper.study.json");
  const Model via = composed(board_format.read(examples / "via.json", Progress{}).board, s);
  EXPECT_EQ(via.slabs().size(), 11U);
  EXPECT_EQ(label_at(via, "L5", 1.1049, 1.57734), "copper|SIG");
  EXPECT_EQ(label_at(via, "L5", 1.3, 1.57734), "FR4|no net") << "antipad";
  EXPECT_EQ(label_at(via, "L5", 0.2, 0.2), "copper|GND");
  EXPECT_EQ(label_at(via, "L3", 0.2, 1.57734), "copper|SIG");
  EXPECT_EQ(label_at(via, "L9", 0.2, 1.57734), "FR4|no net");
  EXPECT_EQ(label_at(via, "L9", 2.0, 1.57734), "copper|SIG");
  EXPECT_EQ(label_at(via, "L1", 1.1049, 1.57734), "FR4|no net");
  EXPECT_EQ(label_at(via, "L1", 3, 1), "void");
  EXPECT_EQ(via.slabs().back().z_top_nm, 320'040);
  const Model serpentine = composed(board_format.read(examples / "serpentine.json", Progress{}).board, s);
  EXPECT_EQ(serpentine.slabs().size(), 5U);
  EXPECT_EQ(label_at(serpentine, "L3", 1, 3.35), "copper|LINE");
  EXPECT_EQ(label_at(serpentine, "L3", 1, 1), "FR4|no net");
  EXPECT_EQ(label_at(serpentine, "L1", 1, 1), "copper|GND");
}

}  // namespace
}  // namespace pcbmesh
