// SPDX-License-Identifier: GPL-3.0-or-later
// Every real KiCad board against quantities computed by KiCad's own geometry engine: copper area per layer and net, board
// area, holes, counts.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <tuple>

#include "formats/kicad/format.hpp"
#include "formats/syntax/input_file.hpp"
#include "test_data.hpp"
#include "union_area.hpp"

namespace {

using namespace pcbmesh;
using nlohmann::json;

constexpr geometry::ArcOptions oracle_arcs{.sagitta_nm = 100};
constexpr double relative_tolerance = 5e-4;

struct Key {
  int layer;
  std::string net;
  bool graphic_without_net;
  auto operator<=>(const Key&) const = default;
};

std::map<Key, double> areas_of(const board::Board& board) {
  std::map<Key, tests::UnionArea> sums;
  for (const board::Shape& shape : board.shapes()) {
    const bool loose = shape.net == board::no_net && shape.kind == board::ShapeKind::graphic;
    sums[{shape.copper_layer, shape.net == board::no_net ? "" : board.nets()[static_cast<std::size_t>(shape.net)], loose}].add(
        shape.figure, oracle_arcs);
  }
  std::map<Key, double> areas;
  for (auto& [key, sum] : sums) areas[key] = sum.mm2();
  return areas;
}

struct Worst {
  double relative = 0;
  std::string text = "none";
  void see(double ours, double theirs, double floor, const std::string& what) {
    const double off = std::max(0.0, std::abs(ours - theirs) - floor) / std::max(theirs, 1e-9);
    if (off < relative) return;
    relative = off;
    text = fmt::format("{}: {:.6f} mm2, oracle {:.6f} mm2, off {:.1e}", what, ours, theirs,
                       std::abs(ours - theirs) / std::max(theirs, 1e-9));
  }
};

void compare_areas(const board::Board& board, const json& oracle, bool has_text) {
  std::map<Key, double> ours = areas_of(board);
  Worst worst;
  ASSERT_EQ(board.copper_layers().size(), oracle["copper_layers"].size());
  double total = 0;
  for (int layer = 0; layer < static_cast<int>(board.copper_layers().size()); ++layer) {
    const std::string& name = board.copper_name(layer);
    ASSERT_EQ(name, oracle["copper_layers"][static_cast<std::size_t>(layer)]);
    const json& entry = oracle["layers"][name];
    std::set<std::string> seen;
    for (const auto& [net, numbers] : entry["nets"].items()) {
      const double theirs = numbers[0], mine = ours[{layer, net, false}];
      seen.insert(net);
      total += mine;
      worst.see(mine, theirs, 1e-5, name + " " + net);
    }
    for (const auto& [key, area] : ours) {
      const bool is_new = key.layer == layer && !key.graphic_without_net && !seen.contains(key.net);
      EXPECT_TRUE(!is_new || area < 1e-5) << name << " " << key.net << " is not in the oracle: " << area << " mm2";
    }
    const double loose = ours[{layer, "", true}], theirs = entry["nonet_graphics_area"];
    if (has_text) {
      EXPECT_LE(loose, theirs * (1 + relative_tolerance) + 1e-5) << name;
    } else {
      worst.see(loose, theirs, 1e-5, name + " graphics without net");
    }
  }
  fmt::print("  copper {:.3f} mm2; worst {}\n", total, worst.text);
  EXPECT_LE(worst.relative, relative_tolerance) << worst.text;
}

using Hole = std::tuple<bool, std::string, std::int64_t, std::int64_t, int, int>;

void compare_holes(const board::Board& board, const json& oracle) {
  std::map<Hole, std::int64_t> ours, theirs;
  const auto micron = [](double mm) { return static_cast<std::int64_t>(std::llround(mm * 1000)); };
  for (const board::Drill& drill : board.drills()) {
    const auto& points = drill.figure.path.points;
    const double pen = static_cast<double>(drill.figure.pen) * 1e-6;
    const double run = std::hypot(static_cast<double>(points.back().x - points.front().x),
                                  static_cast<double>(points.back().y - points.front().y)) *
                       1e-6;
    ++ours[{drill.plated, std::string(board::name_of(drill.kind)), micron(pen), micron(pen + run), drill.first_copper,
            drill.last_copper}];
  }
  const auto layer = [&](const std::string& name) {
    for (int i = 0; i < static_cast<int>(board.copper_layers().size()); ++i)
      if (board.copper_name(i) == name) return i;
    return -1;
  };
  for (const json& hole : oracle["hole_table"]) {
    const double dx = hole["dx"], dy = hole["dy"];
    theirs[{hole["plated"].get<bool>(), hole["kind"].get<std::string>(), micron(std::min(dx, dy)), micron(std::max(dx, dy)),
            layer(hole["from"]), layer(hole["to"])}] += hole["n"].get<std::int64_t>();
  }
  for (const auto& [hole, n] : theirs)
    EXPECT_EQ(ours[hole], n) << "plated " << std::get<0>(hole) << " " << std::get<1>(hole) << " " << std::get<2>(hole) << " x "
                             << std::get<3>(hole) << " um, layers " << std::get<4>(hole) << " to " << std::get<5>(hole);
  for (const auto& [hole, n] : ours)
    EXPECT_TRUE(theirs.contains(hole)) << n << " holes of " << std::get<2>(hole) << " x " << std::get<3>(hole)
                                       << " um are not in the oracle";
}

void compare_counts(const board::Board& board, const json& oracle) {
  std::int64_t segments = 0, arcs = 0, vias = 0;
  for (const board::Shape& shape : board.shapes())
    if (shape.kind == board::ShapeKind::track) ++(shape.figure.path.arc_starts.empty() ? segments : arcs);
  for (const board::Drill& drill : board.drills()) vias += drill.kind == board::ShapeKind::via ? 1 : 0;
  EXPECT_EQ(segments, oracle["counts"]["segments"]);
  EXPECT_EQ(arcs, oracle["counts"]["arcs"]);
  EXPECT_EQ(vias, oracle["counts"]["vias"]);
  // A pad stands in one line. Pads without copper or hole (paste apertures) are in the oracle's count alone.
  std::set<std::int64_t> pads;
  for (const board::Shape& shape : board.shapes())
    if (shape.kind == board::ShapeKind::pad) pads.insert(shape.line);
  for (const board::Drill& drill : board.drills())
    if (drill.kind == board::ShapeKind::pad) pads.insert(drill.line);
  EXPECT_LE(static_cast<std::int64_t>(pads.size()), oracle["counts"]["pads"].get<std::int64_t>());
  fmt::print("  {} segments, {} arcs, {} vias, {} of {} pads\n", segments, arcs, vias, pads.size(),
             oracle["counts"]["pads"].get<int>());
}

void compare_outline(const board::Board& board, const json& oracle) {
  double area = 0;
  std::size_t holes = 0;
  for (const board::Outline& outline : board.outlines()) {
    area += std::abs(geometry::area_mm2(geometry::flatten(outline.outer, oracle_arcs)));
    for (const geometry::Path& cutout : outline.cutouts)
      area -= std::abs(geometry::area_mm2(geometry::flatten(cutout, oracle_arcs)));
    holes += outline.cutouts.size();
  }
  const json& theirs = oracle["outline"];
  fmt::print("  outline {:.4f} mm2 in {} boards with {} cut-outs; oracle {}\n", area, board.outlines().size(), holes,
             theirs.dump());
  if (!theirs["ok"].get<bool>()) return;
  EXPECT_NEAR(area, theirs["area"].get<double>(), 1e-5 * area);
  EXPECT_EQ(board.outlines().size(), theirs["outlines"]);
  EXPECT_EQ(holes, theirs["holes"]);
}

void compare(const std::string& file_name) {
  const std::filesystem::path data = tests::test_data();
  std::string stem = formats::syntax::unpacked_name(file_name);
  // Boards of version 10 were made from their version 9 twins without touching the geometry.
  if (const auto at = stem.find("_v10."); at != std::string::npos) stem.replace(at, 5, "_v9.");
  const std::filesystem::path oracle_file = data / "oracle" / (stem + ".oracle.json");
  const json oracle = json::parse(formats::syntax::read_whole_file(
      std::filesystem::exists(oracle_file) ? oracle_file : std::filesystem::path(oracle_file.string() + ".xz")));
  const auto [board, diagnostics] = formats::kicad::board_format.read(data / "kicad" / file_name, Progress{});
  fmt::print("{}\n", file_name);
  for (const Diagnostic& d : diagnostics.entries())
    fmt::print("  {} x{}: {}{}{}\n", d.code, d.count, d.text, d.spots.empty() ? "" : "; first at ",
               d.spots.empty() ? "" : d.spots[0].text());
  compare_areas(board, oracle, diagnostics.count("kicad.text_on_copper") > 0);
  compare_holes(board, oracle);
  compare_counts(board, oracle);
  compare_outline(board, oracle);
}

class KicadOracle : public testing::TestWithParam<std::string> {};

TEST_P(KicadOracle, AgreesWithKicadsOwnAreas) {
  PCBMESH_NEEDS_TEST_DATA();
  compare(GetParam());
}

std::vector<std::string> boards() {
  std::vector<std::string> names;
  if (tests::test_data().empty()) return {"none"};
  for (const auto& entry : std::filesystem::directory_iterator(tests::test_data() / "kicad"))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

INSTANTIATE_TEST_SUITE_P(Boards, KicadOracle, testing::ValuesIn(boards()), [](const auto& given) {
  std::string name = given.param;
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
});

TEST(UnionArea, KnowsOverlapsHolesAndBowTies) {
  const auto area = [](std::vector<geometry::Ring> rings) {
    tests::UnionArea sum;
    for (const geometry::Ring& ring : rings) sum.add(ring);
    return sum.mm2() * 1e6;  // square micrometres
  };
  const auto square = [](Nm x, Nm y, Nm side) {
    return geometry::Ring{{x, y}, {x + side, y}, {x + side, y + side}, {x, y + side}};
  };
  EXPECT_NEAR(area({square(0, 0, 1000), square(500, 500, 1000)}), 1.75, 1e-12);
  EXPECT_NEAR(area({square(0, 0, 1000), square(0, 0, 1000)}), 1, 1e-12);
  // Two lobes of opposite sense, each a quarter of the square.
  EXPECT_NEAR(area({{{0, 0}, {1000, 1000}, {1000, 0}, {0, 1000}}}), 0.5, 1e-12);
  // A plus of two crossing diamonds and a hole hung on a slit.
  EXPECT_NEAR(
      area({{{0, 0}, {1000, 0}, {1000, 1000}, {0, 1000}, {0, 0}, {250, 250}, {250, 750}, {750, 750}, {750, 250}, {250, 250}}}),
      0.75, 1e-12);
  EXPECT_NEAR(area({{{0, -1000}, {100, 0}, {0, 1000}, {-100, 0}}, {{-1000, 0}, {0, -100}, {1000, 0}, {0, 100}}}),
              0.4 - 0.4 / 11, 1e-9);
}

}  // namespace
