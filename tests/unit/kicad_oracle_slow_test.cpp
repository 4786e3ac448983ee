// SPDX-License-Identifier: GPL-3.0-or-later
// Every real KiCad board against quantities computed by KiCad's own geometry engine: copper area per layer and net, board
// area, holes, counts.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>
#include <string>
#include <tuple>

#include "formats/kicad/format.hpp"
#include "formats/syntax/input_file.hpp"
#include "test_data.hpp"
#include "unit/union_area.hpp"

namespace {

using namespace pcbmesh;
using nlohmann::json;

constexpr geometry::ArcOptions oracle_arcs{.sagitta_nm = 100};
constexpr double relative_tolerance = 5e-4;
/// The oracle's areas have six decimals of a square millimetre, and its points and ours are rounded to 1 nm: 10 mm of edge off
/// by 1 nm is 1e-5 mm2, a disc of 0.1 mm.
constexpr double rounding_mm2 = 1e-5;
/// KiCad flattens the board's edge with chords 5 um off: a hole of r = 1.6 mm seems 0.4 % smaller. The largest seen is 4.4e-5.
constexpr double outline_tolerance = 1e-4;

struct Key {
  int layer;
  std::string net;
  bool graphic_without_net;
  auto operator<=>(const Key&) const = default;
};

/// Up to 5.99 an overbar was ~NAME; KiCad 9, which made the oracle, renames it ~{NAME}. The reader keeps the file's name.
std::string without_braces(std::string net) {
  for (std::size_t at = 0; (at = net.find("~{", at)) != std::string::npos; ++at) {
    const std::size_t close = net.find('}', at);
    if (close != std::string::npos) net.erase(close, 1);
    net.erase(at + 1, 1);
  }
  return net;
}

Key key_of(const board::Board& board, const board::Shape& shape) {
  const bool loose = shape.net == board::no_net && shape.kind == board::ShapeKind::graphic;
  return {shape.copper_layer,
          shape.net == board::no_net ? "" : without_braces(board.nets()[static_cast<std::size_t>(shape.net)]), loose};
}

/// The round corners of stroked fills (up to v6) are flattened by KiCad with the same 5 um when it loads the board.
double stroked_fill_allowance(const geometry::Figure& figure) {
  geometry::Ring ring = geometry::flatten(figure.path, oracle_arcs);
  geometry::make_counter_clockwise(ring);
  double turned = 0;
  for (std::size_t i = 0, n = ring.size(); i < n; ++i) {
    const geometry::Point a = ring[i], b = ring[(i + 1) % n], c = ring[(i + 2) % n];
    const double ux = static_cast<double>(b.x - a.x), uy = static_cast<double>(b.y - a.y);
    const double vx = static_cast<double>(c.x - b.x), vy = static_cast<double>(c.y - b.y);
    turned += std::max(0.0, std::atan2(ux * vy - uy * vx, ux * vx + uy * vy));
  }
  return 2.0 / 3 * 0.005 * turned * static_cast<double>(figure.pen) * 0.5e-6;
}

/// KiCad flattens the primitives of custom pads with chords 5 um off, whatever the caller asks for (a circle of r = 0.5 mm
/// loses 0.009 mm2, four rings of 02_custom_pads 0.72 mm2). A chord loses two thirds of its sagitta times its length; a stroke
/// has two sides and a cap. This is what a net's custom pads may be off by.
std::map<Key, double> coarse_arc_allowances(const board::Board& board) {
  std::map<std::pair<std::int64_t, std::int32_t>, int> figures_of_pad;
  for (const board::Shape& shape : board.shapes())
    if (shape.kind == board::ShapeKind::pad) ++figures_of_pad[{shape.line, shape.copper_layer}];
  std::map<Key, double> allowances;
  for (const board::Shape& shape : board.shapes()) {
    const geometry::Figure& figure = shape.figure;
    if (shape.kind == board::ShapeKind::fill && figure.pen > 0)
      allowances[key_of(board, shape)] += stroked_fill_allowance(figure);
    const bool is_curved = figure.pen > 0 || !figure.path.arc_starts.empty();
    if (shape.kind != board::ShapeKind::pad || !is_curved || figures_of_pad[{shape.line, shape.copper_layer}] < 2) continue;
    const geometry::Ring ring = geometry::flatten(figure.path, oracle_arcs);
    double length = 0;
    for (std::size_t i = 1; i < ring.size() + (figure.path.closed ? 1 : 0); ++i)
      length += std::hypot(static_cast<double>(ring[i % ring.size()].x - ring[i - 1].x),
                           static_cast<double>(ring[i % ring.size()].y - ring[i - 1].y));
    const double boundary_mm =
        ((figure.pen > 0 && !figure.filled ? 2 : 1) * length + std::numbers::pi * static_cast<double>(figure.pen)) * 1e-6;
    allowances[key_of(board, shape)] += 2.0 / 3 * 0.005 * boundary_mm;
  }
  return allowances;
}

std::map<Key, double> areas_of(const board::Board& board) {
  std::map<Key, tests::UnionArea> sums;
  for (const board::Shape& shape : board.shapes()) sums[key_of(board, shape)].add(shape.figure, oracle_arcs);
  std::map<Key, double> areas;
  for (auto& [key, sum] : sums) areas[key] = sum.mm2();
  return areas;
}

struct Worst {
  double relative = 0;
  std::string text = "none";
  void see(double ours, double theirs, double floor, const std::string& what) {
    const double off = std::max(0.0, std::abs(ours - theirs) - floor) / std::max(theirs, 1e-9);
    if (off <= relative) return;
    relative = off;
    text = fmt::format("{}: {:.6f} mm2, oracle {:.6f} mm2, off {:.1e}", what, ours, theirs,
                       std::abs(ours - theirs) / std::max(theirs, 1e-9));
  }
};

void compare_areas(const board::Board& board, const json& oracle, bool has_text) {
  std::map<Key, double> ours = areas_of(board), allowances = coarse_arc_allowances(board);
  Worst worst;
  ASSERT_EQ(board.copper_layers().size(), oracle["copper_layers"].size());
  double total = 0;
  for (int layer = 0; layer < static_cast<int>(board.copper_layers().size()); ++layer) {
    const std::string& name = board.copper_name(layer);
    ASSERT_EQ(name, oracle["copper_layers"][static_cast<std::size_t>(layer)]);
    const json& entry = oracle["layers"][name];
    std::set<std::string> seen;
    for (const auto& [full_net, numbers] : entry["nets"].items()) {
      const std::string net = without_braces(full_net);
      const double theirs = numbers[0], mine = ours[{layer, net, false}];
      seen.insert(net);
      total += mine;
      worst.see(mine, theirs, rounding_mm2 + allowances[{layer, net, false}], name + " " + net);
    }
    for (const auto& [key, area] : ours) {
      const bool is_new = key.layer == layer && !key.graphic_without_net && !seen.contains(key.net);
      EXPECT_TRUE(!is_new || area < rounding_mm2) << name << " " << key.net << " is not in the oracle: " << area << " mm2";
    }
    const double loose = ours[{layer, "", true}], theirs = entry["nonet_graphics_area"];
    if (has_text) {
      EXPECT_LE(loose, theirs * (1 + relative_tolerance) + rounding_mm2) << name;
    } else {
      worst.see(loose, theirs, rounding_mm2, name + " graphics without net");
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
  EXPECT_NEAR(area, theirs["area"].get<double>(), outline_tolerance * area);
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

constexpr const char* largest_board = "20_vme_wren_12L_v9.kicad_pcb.xz";

TEST(KicadOracleLarge, VmeWrenAgreesWithKicadsOwnAreas) {
  PCBMESH_NEEDS_TEST_DATA();
  compare(largest_board);
}

std::vector<std::string> boards() {
  std::vector<std::string> names;
  if (tests::test_data().empty()) return {"none"};
  for (const auto& entry : std::filesystem::directory_iterator(tests::test_data() / "kicad"))
    if (entry.path().filename() != largest_board) names.push_back(entry.path().filename().string());
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
