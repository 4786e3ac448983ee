// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "formats/native_json/format.hpp"
#include "pcbmesh/base/error.hpp"
#include "pcbmesh/geometry/point.hpp"

namespace pcbmesh {
namespace {

using board::Board;
using formats::native_json::board_format;
using formats::native_json::parse_board;

const std::filesystem::path examples = std::filesystem::path(PCBMESH_SOURCE_DIR) / "examples";

/// A two-layer board; `more` are further members, each with a leading comma.
std::string board_text(const std::string& more = "") {
  return R"({"pcbmesh_board": 1, "stackup": [
  {"name": "top", "kind": "copper", "thickness": "35um"},
  {"name": "core", "kind": "dielectric", "thickness": "1mm", "material": "FR4"},
  {"name": "bottom", "kind": "copper", "thickness": "35um"}],
"materials": [{"name": "FR4", "eps_r": 4.3}],
"outline": {"rect": [[0, 0], [20, 10]]}
)" + more +
         "}";
}

Board parse(const std::string& text) {
  return parse_board(text, "b.json").board;
}
Board parse_with(const std::string& more) {
  return parse(board_text("," + more));
}

/// The error that parsing throws; fails the test if there is none.
Error error_of(const std::string& text) {
  try {
    (void)parse(text);
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "accepted: " << text.substr(0, 400);
  return Error(ErrorCode::internal, "none");
}

void expect_error(const std::string& text, ErrorCode code, std::initializer_list<std::string_view> words,
                  std::int64_t line = 0) {
  const Error error = error_of(text);
  EXPECT_EQ(static_cast<int>(error.code()), static_cast<int>(code)) << error.what();
  for (std::string_view word : words)
    EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << word << " in: " << error.what();
  EXPECT_EQ(error.spot().file, "b.json");
  EXPECT_GT(error.spot().line, 0) << error.what();
  if (line > 0) {
    EXPECT_EQ(error.spot().line, line) << error.what();
  }
}

/// Area in mm^2 by the winding of the flattened path.
double path_area(const geometry::Path& path) {
  return std::abs(geometry::area_mm2(geometry::flatten(path, {100, geometry::ArcMode::inscribed})));
}

TEST(NativeJson, ReadsTheSmallestBoard) {
  const Board board = parse(board_text());
  EXPECT_EQ(board.stackup().size(), 3U);
  EXPECT_EQ(board.copper_layers().size(), 2U);
  EXPECT_EQ(board.copper_name(1), "bottom");
  EXPECT_EQ(board.stackup()[1].thickness_nm, nm_per_mm);
  EXPECT_EQ(board.stackup()[0].thickness_nm, 35'000);
  EXPECT_EQ(board.materials()[static_cast<std::size_t>(board.stackup()[0].material)].name, "copper");
  EXPECT_EQ(board.materials()[static_cast<std::size_t>(board.stackup()[0].material)].sigma_s_per_m, 5.8e7);
  EXPECT_EQ(board.materials()[static_cast<std::size_t>(board.stackup()[1].material)].eps_r, 4.3);
  EXPECT_EQ(board.source(), "b.json");
  ASSERT_EQ(board.outlines().size(), 1U);
  EXPECT_DOUBLE_EQ(path_area(board.outlines()[0].outer), 200);
}

TEST(NativeJson, UnitsScaleBareNumbersAndStringsCarryTheirOwn) {
  for (const auto& [unit, nm] : {std::pair{"mm", 1'000'000.0}, {"um", 1000.0}, {"mil", 25400.0}, {"in", 25.4e6}}) {
    const Board board = parse(fmt::format(R"({{"pcbmesh_board": 1, "units": "{}",
      "stackup": [{{"name": "top", "kind": "copper", "thickness": "35um"}}],
      "tracks": [{{"layer": "top", "width": 0.5, "points": [[1, 2], ["3mm", "-8mil"]]}}]}})",
                                          unit));
    const geometry::Figure& figure = board.shapes()[0].figure;
    EXPECT_EQ(figure.pen, std::llround(0.5 * nm)) << unit;
    EXPECT_EQ(figure.path.points[0], (geometry::Point{std::llround(nm), std::llround(2 * nm)}));
    EXPECT_EQ(figure.path.points[1], (geometry::Point{3'000'000, -203'200}));
  }
}

TEST(NativeJson, NetsAreImpliedByUseOrListed) {
  const std::string tracks = R"("tracks": [
    {"layer": "top", "net": "B", "width": 0.1, "points": [[1, 1], [2, 1]]},
    {"layer": "top", "net": "A", "width": 0.1, "points": [[1, 2], [2, 2]]},
    {"layer": "top", "width": 0.1, "points": [[1, 3], [2, 3]]}])";
  const Board implied = parse_with(tracks);
  ASSERT_EQ(implied.nets().size(), 2U);
  EXPECT_EQ(implied.nets()[0], "B");
  EXPECT_EQ(implied.shapes()[1].net, 1);
  EXPECT_EQ(implied.shapes()[2].net, board::no_net);
  const Board listed = parse_with(R"("nets": ["A", "B", "C"],)" + tracks);
  EXPECT_EQ(listed.nets().size(), 3U);
  EXPECT_EQ(listed.shapes()[0].net, 1);
  expect_error(board_text(R"(,"nets": ["A", "BB"],)" + tracks), ErrorCode::board_invalid,
               {"/tracks/0/net", "'B'", "did you mean"});
  expect_error(board_text(R"(,"nets": ["A", "A"])"), ErrorCode::board_invalid, {"listed twice"});
}

TEST(NativeJson, ArcsInPaths) {
  // A quarter of a circle of radius 1 and a half disc closed by its last arc.
  const Board board = parse_with(
      R"("tracks": [{"layer": "top", "width": 0.1, "points": [[1, 0], {"arc": [[0.707107, 0.707107], [0, 1]]}, [0, 2]]}],
    "polygons": [{"layer": "top", "points": [[0, 0], [2, 0], {"arc": [[1, 1], [0, 0]]}]}])");
  const geometry::Path& track = board.shapes()[0].figure.path;
  EXPECT_EQ(track.points.size(), 4U);
  EXPECT_EQ(track.arc_starts, std::vector<std::int32_t>{0});
  const geometry::Path& half = board.shapes()[1].figure.path;
  EXPECT_EQ(half.points.size(), 3U) << "the repeated first point is dropped";
  EXPECT_EQ(half.arc_starts, std::vector<std::int32_t>{1});
  EXPECT_NEAR(path_area(half), std::acos(-1.0) / 2, 1e-3);
}

TEST(NativeJson, AreasHaveTheirArea) {
  const double pi = std::acos(-1.0);
  const Board board = parse_with(R"("polygons": [
    {"layer": "top", "rect": [[3, 4], [1, 1]]},
    {"layer": "top", "circle": {"at": [5, 5], "diameter": 2}},
    {"layer": "top", "slot": {"points": [[1, 1], [4, 5]], "width": 2}},
    {"layer": "top", "slot": {"points": [[1, 1], [1, 1]], "width": 2}},
    {"layer": "top", "kind": "pad", "points": [[0, 0], [4, 0], [0, 4], [0, 0]]}])");
  const double expected[] = {6, pi, 10 + pi, pi, 8};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(path_area(board.shapes()[i].figure.path), expected[i], 1e-3) << i;
  EXPECT_EQ(board.shapes()[0].kind, board::ShapeKind::fill);
  EXPECT_EQ(board.shapes()[4].kind, board::ShapeKind::pad);
}

TEST(NativeJson, HolesAreCutAndTheirArcsKept) {
  const double pi = std::acos(-1.0);
  const Board board = parse_with(R"("polygons": [
    {"layer": "top", "rect": [[0, 0], [10, 10]], "holes": [
      {"circle": {"at": [3, 3], "diameter": 2}}, {"rect": [[6, 6], [8, 8]]}, {"circle": {"at": [3, 7], "diameter": 2}},
      {"points": [[6, 1], [6, 3], [8, 3], [8, 1]]}, {"slot": {"points": [[1, 5], [9, 5]], "width": 1}}]},
    {"layer": "top", "circle": {"at": [15, 5], "diameter": 8}, "holes": [{"circle": {"at": [15, 5], "diameter": 4}}]}])");
  const geometry::Figure& cut = board.shapes()[0].figure;
  EXPECT_TRUE(cut.filled);
  EXPECT_NEAR(path_area(cut.path), 100 - 2 * pi - 4 - 4 - 8 - pi / 4, 2e-3);
  EXPECT_EQ(cut.path.arc_starts.size(), 6U);
  EXPECT_NEAR(path_area(board.shapes()[1].figure.path), 16 * pi - 4 * pi, 2e-3);
  // Winding numbers, not just the sum of areas: 1 in copper, 0 in every hole.
  const geometry::Ring ring = geometry::flatten(cut.path, {});
  const auto winding = [&](double x, double y) {
    int sum = 0;
    const geometry::Point p{nm_from_mm(x), nm_from_mm(y)};
    for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
      const int turn = geometry::orientation(ring[j], ring[i], p);
      if (ring[j].y <= p.y && ring[i].y > p.y && turn > 0) ++sum;
      if (ring[j].y > p.y && ring[i].y <= p.y && turn < 0) --sum;
    }
    return sum;
  };
  for (const auto& [x, y] : {std::pair{3.01, 3.02}, {7.0, 7.01}, {3.0, 7.03}, {7.0, 2.01}, {5.0, 5.01}})
    EXPECT_EQ(winding(x, y), 0) << x << ' ' << y;
  for (const auto& [x, y] : {std::pair{1.0, 1.01}, {5.02, 3.03}, {9.0, 9.01}, {5.0, 8.01}})
    EXPECT_EQ(winding(x, y), 1) << x << ' ' << y;
}

TEST(NativeJson, HolesThatOverlapOrStickOutAreErrors) {
  const auto text = [](const char* holes) {
    return board_text(fmt::format(R"(,
"polygons": [{{"layer": "top", "rect": [[0, 0], [10, 10]], "holes": [{}]}}])",
                                  holes));
  };
  expect_error(text(R"({"circle": {"at": [3, 3], "diameter": 2}}, {"circle": {"at": [4, 3], "diameter": 2}})"),
               ErrorCode::board_invalid, {"/polygons/0/holes/0", "/polygons/0/holes/1", "overlap", "slot"});
  expect_error(text(R"({"circle": {"at": [3, 3], "diameter": 4}}, {"circle": {"at": [3, 3], "diameter": 2}})"),
               ErrorCode::board_invalid, {"overlap"});
  expect_error(text(R"({"circle": {"at": [3, 3], "diameter": 4}}, {"circle": {"at": [3, 3], "diameter": 4}})"),
               ErrorCode::board_invalid, {"overlap"});
  expect_error(text(R"({"circle": {"at": [0, 3], "diameter": 2}})"), ErrorCode::board_invalid, {"inside the copper"});
  expect_error(text(R"({"circle": {"at": [30, 3], "diameter": 2}})"), ErrorCode::board_invalid, {"inside the copper"});
  expect_error(text(R"({"rect": [[-1, -1], [11, 11]]})"), ErrorCode::board_invalid, {"inside the copper"});
  EXPECT_NO_THROW(
      (void)parse(text(R"({"circle": {"at": [3, 3], "diameter": 2}}, {"circle": {"at": [5.1, 3], "diameter": 2}})")));
}

TEST(NativeJson, PadsOfEveryShape) {
  const Board board = parse_with(R"("pads": [
    {"layer": "top", "at": [1, 1], "size": 0.8, "component": "U1", "pin": "A2", "net": "N"},
    {"layer": "top", "at": [2, 1], "size": [2, 1]},
    {"layer": "bottom", "at": [3, 1], "size": [2, 1], "shape": "oval", "rotation": 90},
    {"layer": "top", "at": [4, 1], "size": [2, 1], "rotation": -270},
    {"layer": "top", "at": [5, 1], "size": [2, 1], "rotation": 45}])");
  EXPECT_EQ(board.shapes()[0].figure, geometry::disc({1'000'000, 1'000'000}, 800'000));
  ASSERT_EQ(board.pins().size(), 1U);
  EXPECT_EQ(board.pins()[0], (board::Pin{"U1", "A2", 0, {1'000'000, 1'000'000}, 0}));
  EXPECT_EQ(board.shapes()[1].figure.path.points[0], (geometry::Point{1'000'000, 500'000}));
  const geometry::Box oval = geometry::bounds(board.shapes()[2].figure);
  EXPECT_EQ(board.shapes()[2].copper_layer, 1);
  EXPECT_EQ(oval.max.y - oval.min.y, 2'000'000);
  EXPECT_EQ(oval.max.x - oval.min.x, 1'000'000);
  const geometry::Box turned = geometry::bounds(board.shapes()[3].figure);
  EXPECT_EQ(turned.max.y - turned.min.y, 2'000'000);
  EXPECT_NEAR(path_area(board.shapes()[4].figure.path), 2, 1e-5);
  expect_error(board_text(R"(,"pads": [{"layer": "top", "at": [1, 1], "size": [1, 2], "shape": "circle"}])"),
               ErrorCode::file_syntax, {"/pads/0/shape", "oval"});
  expect_error(board_text(R"(,"pads": [{"layer": "top", "at": [1, 1], "size": 1, "pin": "1"}])"), ErrorCode::file_syntax,
               {"component"});
}

TEST(NativeJson, ViasHolesAndTheirSpans) {
  const Board board = parse_with(R"("vias": [
    {"at": [1, 1], "drill": 0.3, "pad": 0.6, "net": "A"},
    {"at": [2, 1], "drill": 0.3, "pad": {"bottom": 0.5}, "layers": ["bottom", "top"]},
    {"drill": {"points": [[3, 1], [3.2, 1], [3.1, 1.2]]}, "layers": ["top", "top"]}],
    "holes": [{"at": [5, 5], "diameter": 1}, {"at": [6, 5], "to": [8, 5], "diameter": 1, "layers": ["bottom", "bottom"]}])");
  ASSERT_EQ(board.drills().size(), 5U);
  EXPECT_EQ(board.shapes().size(), 3U);
  EXPECT_EQ(board.shapes()[2].copper_layer, 1);
  EXPECT_TRUE(board.drills()[0].plated);
  EXPECT_EQ(board.drills()[1].last_copper, 1);
  EXPECT_TRUE(board.drills()[2].figure.filled);
  EXPECT_EQ(board.drills()[2].last_copper, 0);
  EXPECT_FALSE(board.drills()[3].plated);
  EXPECT_EQ(board.drills()[4].figure, geometry::segment({6'000'000, 5'000'000}, {8'000'000, 5'000'000}, 1'000'000));
  EXPECT_EQ(board.drills()[4].first_copper, 1);
  expect_error(board_text(R"(,"vias": [{"at": [1, 1], "drill": 0.3, "layers": ["top", "botom"]}])"), ErrorCode::board_invalid,
               {"/vias/0/layers/1", "'bottom'"});
  expect_error(board_text(R"(,"vias": [{"at": [1, 1], "drill": 0.3, "layers": ["top", "top"], "pad": {"bottom": 1}}])"),
               ErrorCode::board_invalid, {"span"});
  expect_error(board_text(R"(,"vias": [{"drill": 0.3}])"), ErrorCode::file_syntax, {"/vias/0", "'at' is missing"});
}

/// Copper area of the one plane of a board with these extra members.
double plane_area(const std::string& more) {
  const Board board = parse_with(more);
  for (const board::Shape& shape : board.shapes())
    if (shape.kind == board::ShapeKind::fill) return path_area(shape.figure.path);
  return -1;
}

TEST(NativeJson, PlanesCoverTheOutlineAndAvoidOtherNets) {
  const double pi = std::acos(-1.0);
  EXPECT_DOUBLE_EQ(plane_area(R"("planes": [{"layer": "bottom", "net": "GND"}])"), 200);
  // Drill 0.3, pad 0.6 on both layers, clearance 0.2: an antipad of diameter 1.
  const std::string via =
      R"("vias": [{"at": [5, 5], "drill": 0.3, "pad": 0.6, "net": "A"}, {"at": [9, 5], "drill": 0.3, "net": "GND"}],)";
  EXPECT_NEAR(plane_area(via + R"("planes": [{"layer": "bottom", "net": "GND"}])"), 200 - pi / 4, 1e-3);
  EXPECT_NEAR(plane_area(via + R"("planes": [{"layer": "bottom", "net": "GND", "clearance": "0.7mm"}])"), 200 - pi, 1e-3);
  // A hole drawn round the via is its antipad.
  EXPECT_NEAR(
      plane_area(via + R"("planes": [{"layer": "bottom", "net": "GND", "holes": [{"rect": [[4.6, 4.6], [5.4, 5.4]]}]}])"),
      200 - 0.64, 1e-3);
  // Its own antipad; none; beside the plane; on another layer.
  EXPECT_NEAR(plane_area(R"("vias": [{"at": [5, 5], "drill": 0.3, "antipad": 2}], "planes": [{"layer": "bottom"}])"), 200 - pi,
              1e-3);
  EXPECT_NEAR(
      plane_area(R"("vias": [{"at": [5, 5], "drill": 0.3, "antipad": 0}], "planes": [{"layer": "bottom", "net": "G"}])"), 200,
      1e-9);
  EXPECT_NEAR(
      plane_area(
          R"("vias": [{"at": [5, 5], "drill": 0.3}], "planes": [{"layer": "bottom", "net": "G", "rect": [[8, 0], [9, 1]]}])"),
      1, 1e-9);
  EXPECT_NEAR(
      plane_area(
          R"("vias": [{"at": [5, 5], "drill": 0.3, "layers": ["top", "top"]}], "planes": [{"layer": "bottom", "net": "G"}])"),
      200, 1e-9);
  EXPECT_NEAR(plane_area(R"("holes": [{"at": [5, 5], "diameter": 1.6}], "planes": [{"layer": "bottom", "net": "G"}])"),
              200 - pi, 1e-3);
  expect_error(board_text(R"(,"vias": [{"at": [0.1, 5], "drill": 0.3}], "planes": [{"layer": "bottom", "net": "G"}])"),
               ErrorCode::board_invalid, {"antipad of /vias/0", "inside the copper"});
}

TEST(NativeJson, OverlappingAntipadsAreJoined) {
  const double pi = std::acos(-1.0);
  const auto area = [](const char* vias) {
    return 200 - plane_area(fmt::format(R"("vias": [{}], "planes": [{{"layer": "bottom", "net": "G"}}])", vias));
  };
  // Two unit discs a distance 1 apart: 2 pi minus the lens 2 pi / 3 - sqrt(3) / 2.
  const double lens = 2 * pi / 3 - std::sqrt(3.0) / 2;
  EXPECT_NEAR(area(R"({"at": [5, 5], "drill": 0.3, "antipad": 2}, {"at": [6, 5], "drill": 0.3, "antipad": 2})"), 2 * pi - lens,
              2e-3);
  EXPECT_NEAR(
      area(
          R"({"at": [5, 5], "drill": 0.3, "antipad": 2}, {"at": [6, 5], "drill": 0.3, "antipad": 2}, {"at": [7, 5], "drill": 0.3, "antipad": 2})"),
      3 * pi - 2 * lens, 3e-3);
  // One inside another; two in the same place; apart.
  EXPECT_NEAR(area(R"({"at": [5, 5], "drill": 0.3, "antipad": 2}, {"at": [5.2, 5], "drill": 0.3, "antipad": 1})"), pi, 2e-3);
  EXPECT_NEAR(area(R"({"at": [5, 5], "drill": 0.3, "antipad": 2}, {"at": [5, 5], "drill": 0.3, "antipad": 2})"), pi, 2e-3);
  EXPECT_NEAR(area(R"({"at": [5, 5], "drill": 0.3, "antipad": 2}, {"at": [8, 5], "drill": 0.3, "antipad": 2})"), 2 * pi, 2e-3);
  // Four in a ring enclose a scrap, which is cut away as well: square 1.8 x 1.8 plus the outer parts of the discs.
  const double half = std::acos(0.9), circular_lens = 2 * half - std::sin(2 * half);
  EXPECT_NEAR(area(R"({"at": [5, 5], "drill": 0.3, "antipad": 2}, {"at": [6.8, 5], "drill": 0.3, "antipad": 2},
                      {"at": [5, 6.8], "drill": 0.3, "antipad": 2}, {"at": [6.8, 6.8], "drill": 0.3, "antipad": 2})"),
              4 * pi - 4 * circular_lens + (1.8 * 1.8 - (pi - 4 * circular_lens / 2)), 4e-3);
}

TEST(NativeJson, WrongFieldsAreNamedWithLineAndRemedy) {
  expect_error("{\n \"pcbmesh_board\": 1,\n \"stackup\": [],\n \"trakcs\": []}", ErrorCode::file_syntax,
               {"/trakcs", "did you mean 'tracks'"}, 4);
  expect_error(
      board_text(",\n\"tracks\": [\n{\"layer\": \"top\", \"net\": \"A\",\n \"widht\": 1, \"points\": [[0, 0], [1, 1]]}]"),
      ErrorCode::file_syntax, {"/tracks/0/widht", "did you mean 'width'"}, 10);
  expect_error(board_text(R"(,"tracks": [{"layer": "top", "points": [[0, 0], [1, 1]]}])"), ErrorCode::file_syntax,
               {"/tracks/0", "'width' is missing"});
  expect_error(board_text(R"(,"tracks": {"layer": "top"})"), ErrorCode::file_syntax,
               {"/tracks", "expected an array, found an object"});
  expect_error(board_text(R"(,"tracks": [7])"), ErrorCode::file_syntax, {"/tracks/0", "expected an object, found a number"});
  expect_error(board_text(R"(,"tracks": [{"layer": "Top", "width": 1, "points": [[0, 0], [1, 1]]}])"), ErrorCode::board_invalid,
               {"'Top'", "did you mean 'top'"});
  expect_error(board_text(R"(,"tracks": [{"layer": "core", "width": 1, "points": [[0, 0], [1, 1]]}])"),
               ErrorCode::board_invalid, {"'core'", "copper layers are top, bottom"});
  expect_error(board_text(R"(,"tracks": [{"layer": "top", "width": 1, "points": [[0, 0]]}])"), ErrorCode::file_syntax,
               {"two points"});
  expect_error(board_text(R"(,"tracks": [{"layer": "top", "width": "1", "points": [[0, 0], [1, 1]]}])"), ErrorCode::file_syntax,
               {"has no unit"});
  expect_error(board_text(R"(,"tracks": [{"layer": "top", "width": "1furlong", "points": [[0, 0], [1, 1]]}])"),
               ErrorCode::file_syntax, {"furlong", "/width"});
  expect_error(board_text(R"(,"tracks": [{"layer": "top", "width": 1, "points": [[0, 0, 0], [1, 1]]}])"),
               ErrorCode::file_syntax, {"/points/0", "[x, y]"});
  expect_error(board_text(R"(,"tracks": [{"layer": "top", "width": 1, "points": [{"arc": [[0, 0], [1, 1]]}]}])"),
               ErrorCode::file_syntax, {"can't begin with an arc"});
  expect_error(board_text(R"(,"polygons": [{"layer": "top"}])"), ErrorCode::file_syntax,
               {"/polygons/0", "points, rect, circle or slot"});
  expect_error(board_text(R"(,"polygons": [{"layer": "top", "rect": [[0, 0], [1, 1]], "points": []}])"), ErrorCode::file_syntax,
               {"keep one"});
  expect_error(board_text(R"(,"polygons": [{"layer": "top", "rect": [[0, 0], [0, 1]]}])"), ErrorCode::board_invalid,
               {"no area"});
  expect_error(board_text(R"(,"polygons": [{"layer": "top", "points": [[0, 0], [1, 1], [2, 2]]}])"), ErrorCode::board_invalid,
               {"no area"});
  expect_error(board_text(R"(,"planes": [{"layer": "top", "clearance": -1}])"), ErrorCode::input_number,
               {"/planes/0/clearance"});
  expect_error(board_text(R"(,"units": "cm")"), ErrorCode::file_syntax, {"/units", "mm, um, mil, in"});
  expect_error(R"({"pcbmesh_board": 2, "stackup": []})", ErrorCode::file_syntax, {"version 2", "version 1"});
  expect_error(R"({"stackup": []})", ErrorCode::file_syntax, {"pcbmesh_board"});
}

TEST(NativeJson, StackupErrors) {
  const auto stack = [](const char* layers) {
    return fmt::format(R"({{"pcbmesh_board": 1, "materials": [{{"name": "FR4"}}], "stackup": [{}]}})", layers);
  };
  expect_error(stack(""), ErrorCode::stackup_invalid, {"no copper"});
  expect_error(stack(R"({"name": "d", "kind": "dielectric", "thickness": 1, "material": "FR4"})"), ErrorCode::stackup_invalid,
               {"no copper"});
  expect_error(stack(R"({"name": "a", "kind": "copper", "thickness": 0})"), ErrorCode::stackup_invalid,
               {"/stackup/0/thickness"});
  expect_error(stack(R"({"name": "a", "kind": "copper", "thickness": "-35um"})"), ErrorCode::stackup_invalid, {"thickness"});
  expect_error(stack(R"({"name": "a", "kind": "copper", "thickness": 0.1}, {"name": "a", "kind": "copper", "thickness": 0.1})"),
               ErrorCode::stackup_invalid, {"two layers"});
  expect_error(stack(R"({"name": "a", "kind": "dielectric", "thickness": 1})"), ErrorCode::file_syntax,
               {"'material' is missing"});
  expect_error(stack(R"({"name": "a", "kind": "copper", "thickness": 1, "material": "fr5"})"), ErrorCode::stackup_invalid,
               {"'fr5'", "'FR4'"});
  expect_error(stack(R"({"name": "a", "kind": "cooper", "thickness": 1})"), ErrorCode::file_syntax, {"did you mean 'copper'"});
  expect_error(R"({"pcbmesh_board": 1, "materials": [{"name": "X"}, {"name": "X"}], "stackup": []})", ErrorCode::file_syntax,
               {"two materials"});
}

TEST(NativeJson, SyntaxErrorsCarryTheLine) {
  expect_error("{\n\"pcbmesh_board\": 1,\n\"stackup\": [}\n}", ErrorCode::file_syntax, {"JSON syntax error"}, 3);
  expect_error("{\n\"pcbmesh_board\": 1\n", ErrorCode::file_syntax, {"JSON syntax error"});
  expect_error("", ErrorCode::file_syntax, {"JSON syntax error"});
  expect_error("{\"pcbmesh_board\": 1,\n \"name\": \"a\",\n \"name\": \"b\"}", ErrorCode::file_syntax, {"'name'", "twice"}, 3);
  expect_error("{\"pcbmesh_board\": 1, // comment\n}", ErrorCode::file_syntax, {"JSON syntax error"});
  expect_error("{\"pcbmesh_board\": \"\xff\"}", ErrorCode::file_syntax, {"UTF-8"});
  expect_error("[1, 2", ErrorCode::file_syntax, {"JSON syntax error"});
  expect_error("[1, 2]", ErrorCode::file_syntax, {"expected an object, found an array"});
}

TEST(NativeJson, HostileNumbersAndNesting) {
  for (const char* number : {"NaN", "Infinity", "-Infinity", "0x10", "1e"})
    expect_error(board_text(fmt::format(R"(,"tracks": [{{"layer": "top", "width": {}, "points": [[0, 0], [1, 1]]}}])", number)),
                 ErrorCode::file_syntax, {"JSON syntax error"});
  for (const char* number : {"1e300", "1e7", "-1e300", "-1", "0", "123456789012345678901234567890"})
    expect_error(board_text(fmt::format(R"(,"tracks": [{{"layer": "top", "width": {}, "points": [[0, 0], [1, 1]]}}])", number)),
                 ErrorCode::input_number, {"/tracks/0/width"});
  expect_error(board_text(R"(,"tracks": [{"layer": "top", "width": 1e999, "points": [[0, 0], [1, 1]]}])"),
               ErrorCode::input_number, {"1e999"});
  expect_error(board_text(R"(,"tracks": [{"layer": "top", "width": 1, "points": [[0, 1e300], [1, 1]]}])"),
               ErrorCode::input_number, {"/tracks/0/points/0/1"});
  expect_error(board_text(R"(,"tracks": [{"layer": "top", "width": "1e400mm", "points": [[0, 0], [1, 1]]}])"),
               ErrorCode::file_syntax, {"/width"});
  expect_error(std::string(100000, '['), ErrorCode::file_syntax, {"nested deeper"});
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "{\"a\":";
  expect_error(deep, ErrorCode::file_syntax, {"nested deeper"});
  const std::string longest(1 << 20, 'x');
  EXPECT_LT(std::string(error_of("{\"" + longest + "\": 1}").what()).size(), 1000U) << "messages stay short";
  EXPECT_LT(std::string(error_of(board_text(",\"tracks\": [{\"layer\": \"" + longest + "\"}]")).what()).size(), 1000U);
}

TEST(NativeJson, TruncationAnywhereIsAnErrorNeverACrash) {
  const std::string whole = board_text(
      R"(,"tracks": [{"layer": "top", "width": 1, "points": [[0, 0], {"arc": [[1, 1], [2, 0]]}]}], "planes": [{"layer": "bottom"}])");
  ASSERT_NO_THROW((void)parse(whole));
  for (std::size_t length = 0; length < whole.size(); ++length)
    EXPECT_THROW((void)parse(whole.substr(0, length)), Error) << length;
}

TEST(NativeJson, SniffKnowsItsOwn) {
  EXPECT_EQ(board_format.sniff("\xEF\xBB\xBF  \n{\"pcbmesh_board\": 1", "x"), formats::Match::yes);
  EXPECT_EQ(board_format.sniff("{\"schema_version\": 1", "x.json"), formats::Match::no);
  EXPECT_EQ(board_format.sniff("(kicad_pcb \"pcbmesh_board\"", "x"), formats::Match::no);
  EXPECT_EQ(board_format.sniff("", "x.json"), formats::Match::no);
  EXPECT_THROW((void)board_format.read("/nonexistent/board.json", Progress{}), Error);
}

TEST(NativeJson, ExamplesAreRead) {
  for (const char* name : {"microstrip.json", "serpentine.json", "via.json"}) {
    const auto result = board_format.read(examples / name, Progress{});
    EXPECT_FALSE(result.board.outlines().empty()) << name;
    EXPECT_FALSE(result.board.shapes().empty()) << name;
    EXPECT_EQ(result.diagnostics.entries().size(), 0U) << name;
    std::ifstream stream(examples / name);
    std::string head(4096, ' ');
    stream.read(head.data(), 4096);
    EXPECT_EQ(board_format.sniff(head, name), formats::Match::yes) << name;
  }
}

TEST(NativeJson, PaperExamplesKeepTheirNumbers) {
  const Board via = board_format.read(examples / "via.json", Progress{}).board;
  ASSERT_EQ(via.stackup().size(), 11U);
  Nm height = 0;
  for (const board::StackupLayer& layer : via.stackup()) height += layer.thickness_nm;
  EXPECT_EQ(height, 4 * 20'320 + 5 * 35'560 + 2 * 30'480);
  EXPECT_EQ(via.copper_layers().size(), 4U);
  ASSERT_EQ(via.drills().size(), 1U);
  EXPECT_EQ(via.drills()[0].figure.path.points[0], (geometry::Point{1'167'130, 1'577'340}));
  EXPECT_EQ(via.drills()[0].figure.path.points.size(), 8U);
  const Board serpentine = board_format.read(examples / "serpentine.json", Progress{}).board;
  EXPECT_DOUBLE_EQ(path_area(serpentine.outlines()[0].outer), 9.2 * 5.9);
  EXPECT_EQ(serpentine.shapes()[0].figure.path.points.size(), 28U);
}

}  // namespace
}  // namespace pcbmesh
