// SPDX-License-Identifier: GPL-3.0-or-later
// The board as it is really made: holes, etching, mask, fills, materials.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "folder.hpp"
#include "formats/native_json/format.hpp"
#include "model_places.hpp"
#include "pcbmesh/base/error.hpp"
#include "pcbmesh/compose/compose.hpp"
#include "pcbmesh/geometry/polygon_sets.hpp"
#include "pcbmesh/pipeline/mesh_board.hpp"
#include "pcbmesh/pipeline/write_outputs.hpp"

namespace pcbmesh {
namespace {

using board::Board;
using model::Label;
using model::Model;
using study::Study;
using testing::label_at;

Board board_with(const std::string& members, const std::string& outline = R"({"rect": [[0, 0], [20, 10]]})") {
  return formats::native_json::parse_board(R"({"pcbmesh_board": 1, "outline": )" + outline + R"(,
    "materials": [{"name": "PP", "eps_r": 4, "tan_delta": 0.02}, {"name": "core", "eps_r": 4.5}, {"name": "ink", "eps_r": 3.3}],
    "stackup": [{"name": "mask", "kind": "solder_mask", "thickness": "20um", "material": "ink"},
      {"name": "L1", "kind": "copper", "thickness": "40um"},
      {"name": "prepreg 1", "kind": "dielectric", "thickness": "100um", "material": "PP"},
      {"name": "L2", "kind": "copper", "thickness": "30um"},
      {"name": "core 1", "kind": "dielectric", "thickness": "1mm", "material": "core"},
      {"name": "L3", "kind": "copper", "thickness": "30um"},
      {"name": "prepreg 2", "kind": "dielectric", "thickness": "100um", "material": "PP"},
      {"name": "L4", "kind": "copper", "thickness": "40um"},
      {"name": "mask below", "kind": "solder_mask", "thickness": "50um", "material": "ink"}], )" +
                                               members + "}",
                                           "b.json")
      .board;
}

const char* one_via = R"("nets": ["A", "B"], "vias": [{"at": [5, 5], "drill": "0.3mm", "pad": "0.6mm", "net": "A"}])";

study::Study parsed(const std::string& members) {
  return study::parse_study(R"({"schema_version": 1)" + (members.empty() ? "" : ", " + members) + "}", "s.json");
}

Model composed(const Board& board, const std::string& members, Diagnostics* words = nullptr) {
  Diagnostics ignored;
  return compose::compose(board, parsed(members), words == nullptr ? ignored : *words);
}

/// Meshes, checks, and gives the report back.
validation::Report checked(const Board& board, const std::string& members, double* copper_mm3 = nullptr) {
  study::Study study = parsed(members);
  study.policy = study::HeightPolicy::none;
  study.sublayers = study::SublayerRule::none;
  const pipeline::MeshBoardResult result = pipeline::mesh_board(board, study);
  const testing::Folder folder;  // tests run side by side
  const std::string file = (folder / "fabrication.msh").string();
  const pipeline::OutputResult written = pipeline::write_outputs(result, {{file}, "", {}, true, 1}, Progress{});
  if (copper_mm3 != nullptr) {
    *copper_mm3 = 0;
    for (const mesh::VolumeTag& tag : result.mesh.volume_tags())
      if (tag.net >= 0) *copper_mm3 += tag.volume_m3 * 1e9;
  }
  EXPECT_TRUE(written.report && written.report->passed()) << validation::to_text(*written.report);
  return *written.report;
}

TEST(Fabrication, EveryFieldIsReadAndWrittenBack) {
  const Study s = parsed(R"("vias": {"fill": "plated", "plating": "20um", "capped": true,
      "rules": [{"net": "A", "kind": "pad", "fill": "plugged", "plug": "via plug"}, {"fill": "copper"}]},
    "backdrill": [{"net": "A", "from": "L4", "to": "L3", "oversize": "0.15mm"}], "merge_vias": {"pitch": "0.8mm"},
    "etch": {"factor": 4, "steps": 3}, "solder_mask": true, "fill": [{"layer": "L2", "from": "below"}],
    "materials": {"define": [{"name": "X", "eps_r": 3, "tan_delta": 0.01, "at": "2GHz", "model": {"kind": "djordjevic_sarkar"},
        "roughness": {"kind": "huray", "nodule_radius": "0.5um", "surface_ratio": 2}}],
      "use": [{"board": "PP", "take": "X"}], "stated": {"model": "djordjevic_sarkar", "at": "3GHz"}},
    "limits": {"max_unknowns": 1000})");
  const study::Fabrication& f = s.fabrication;
  EXPECT_EQ(f.vias.fill, study::ViaFill::plated);
  EXPECT_EQ(f.vias.plating, 20'000);
  ASSERT_EQ(f.hole_rules.size(), 2U);
  EXPECT_EQ(f.hole_rules[0].how.plating, 20'000) << "rules start from what holds for all";
  EXPECT_EQ(f.hole_rules[0].kind, study::HoleKind::pad);
  EXPECT_EQ(f.backdrills.at(0).oversize, 150'000);
  EXPECT_EQ(f.merge_vias, 800'000);
  EXPECT_EQ(f.etch->steps, 3);
  EXPECT_TRUE(f.solder_mask);
  EXPECT_EQ(f.materials.stated.at_hz, 3e9);
  EXPECT_EQ(f.max_unknowns, 1000);
  EXPECT_EQ(study::parse_study(study::to_json(s), "again"), s);
}

TEST(Fabrication, WrongFieldsAreNamedAllAtOnce) {
  try {
    (void)parsed(
        R"("vias": {"fill": "plugged", "plating": "2mm"}, "etch": {"factor": 0.1, "steps": 9}, "merge_vias": {"pitch": 0})");
    FAIL();
  } catch (const Error& error) {
    for (const char* field : {"/vias/plug", "/vias/plating", "/etch/factor", "/etch/steps", "/merge_vias/pitch"})
      EXPECT_NE(std::string(error.what()).find(field), std::string::npos) << field << " in " << error.what();
  }
}

TEST(Fabrication, TubesHaveAirOrAPlugInside) {
  const Board board = board_with(one_via);
  EXPECT_EQ(label_at(composed(board, ""), "core 1", 5, 5), "copper|A") << "filled unless the study says otherwise";
  const Model tube = composed(board, R"("vias": {"fill": "plated"})");
  for (const char* layer : {"L1", "prepreg 1", "core 1", "L4"}) EXPECT_EQ(label_at(tube, layer, 5, 5), "air|no net") << layer;
  EXPECT_EQ(label_at(tube, "core 1", 5.14, 5), "copper|A") << "25 um of wall";
  EXPECT_EQ(label_at(tube, "core 1", 5.12, 5), "air|no net");
  const Model plug = composed(board, R"("vias": {"fill": "plugged", "plug": "via plug", "capped": true})");
  EXPECT_EQ(label_at(plug, "core 1", 5, 5), "via plug|no net");
  EXPECT_EQ(label_at(plug, "L1", 5, 5), "copper|A") << "capped";
  EXPECT_EQ(
      label_at(composed(board, R"("vias": {"fill": "plated", "rules": [{"net": "A", "fill": "copper"}]})"), "core 1", 5, 5),
      "copper|A");
  EXPECT_EQ(label_at(composed(board, R"("vias": {"fill": "plated"}, "conductors": {"mode": "hollow"})"), "core 1", 5, 5),
            "hollow|A");
}

TEST(Fabrication, TheTubesCopperIsARing) {
  const Board board = board_with(R"("nets": ["A"], "vias": [{"at": [5, 5], "drill": "0.3mm", "net": "A"}])");
  double solid = 0, tube = 0;
  EXPECT_EQ(checked(board, R"("region": {"box": {"min": [4, 4], "max": [6, 6]}})", &solid).nets.at(0).pieces, 1);
  const validation::Report report =
      checked(board, R"("vias": {"fill": "plated"}, "region": {"box": {"min": [4, 4], "max": [6, 6]}})", &tube);
  EXPECT_EQ(report.nets.at(0).pieces, 1);
  EXPECT_NEAR(tube / solid, 1 - 0.25 * 0.25 / (0.3 * 0.3), 0.03);
}

TEST(Fabrication, BackdrillsTakeTheStubAway) {
  const Board board = board_with(one_via);
  const std::string drilled = R"("backdrill": [{"net": "A", "from": "L4", "to": "L3", "oversize": "0.4mm"}])";
  const Model m = composed(board, drilled);
  EXPECT_EQ(label_at(m, "L1", 5, 5), "copper|A");
  EXPECT_EQ(label_at(m, "core 1", 5, 5), "copper|A");
  for (const char* layer : {"L3", "prepreg 2", "L4"}) EXPECT_EQ(label_at(m, layer, 5, 5), "air|no net") << layer;
  EXPECT_EQ(label_at(m, "L4", 5.3, 5), "air|no net") << "the pad of 0.6 mm is gone with a hole of 0.7 mm";
  const validation::Report report = checked(board, drilled + R"(, "region": {"box": {"min": [4, 4], "max": [6, 6]}})");
  EXPECT_EQ(report.nets.at(0).expected_pieces, 1);
  // A smaller drill leaves rings of copper behind: two more pieces, in the layout as in the mesh.
  const validation::Report rings = checked(board, R"("backdrill": [{"from": "L4", "to": "L3", "oversize": "0.1mm"}],
      "region": {"box": {"min": [4, 4], "max": [6, 6]}})");
  EXPECT_EQ(rings.nets.at(0).pieces, 3);
  EXPECT_EQ(rings.nets.at(0).expected_pieces, 3);
  EXPECT_THROW((void)composed(board, R"("backdrill": [{"from": "L2", "to": "L3"}])"), Error) << "starts inside";
  EXPECT_THROW((void)composed(board, R"("backdrill": [{"from": "L1", "to": "L4"}])"), Error) << "nothing is left";
}

TEST(Fabrication, HolesOnTheOutlineAreCastellations) {
  const Board board = board_with(R"("nets": ["A"], "vias": [{"at": [0, 5], "drill": "0.6mm", "pad": "1mm", "net": "A"}])");
  Diagnostics words;
  const Model m = composed(board, "", &words);
  EXPECT_EQ(words.count("compose.castellation"), 1);
  EXPECT_EQ(label_at(m, "core 1", 0.1, 5), "air|no net");
  EXPECT_EQ(label_at(m, "core 1", 0.29, 5), "copper|A");
  (void)checked(board, R"("region": {"box": {"min": [0, 4], "max": [1, 6]}}, "air": {"around": "1mm"})");
}

TEST(Fabrication, ViasInArraysBecomeBlocks) {
  std::string vias;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 3; ++j)
      vias += fmt::format(R"({}{{"at": [{}, {}], "drill": "0.3mm", "net": "A"}})", vias.empty() ? "" : ", ", 5 + 0.5 * i,
                          5 + 0.5 * j);
  const std::string foreign = R"(, {"at": [9, 5], "drill": "0.3mm", "net": "A"}, {"at": [9.6, 5], "drill": "0.3mm", "net": "A"},
    {"at": [9.3, 5.3], "drill": "0.2mm", "net": "B"}], "tracks": [{"layer": "L2", "net": "B", "width": "0.1mm", "points": [[9.3, 4], [9.3, 5.3]]})";
  const Board board = board_with(R"("nets": ["A", "B"], "vias": [)" + vias + foreign + "]");
  Diagnostics words;
  const Model m = composed(board, R"("merge_vias": {"pitch": "0.75mm"}, "vias": {"fill": "plated"})", &words);
  ASSERT_EQ(words.count("compose.merged_vias"), 1);
  for (const Diagnostic& d : words.entries()) {
    if (d.code == "compose.merged_vias") {
      EXPECT_EQ(d.text.substr(0, 61), "12 vias are merged into 1 blocks (pitch up to 0.75 mm); 3 via") << d.text;
    }
  }
  EXPECT_EQ(label_at(m, "core 1", 5.25, 5.25), "copper|A") << "between four vias";
  EXPECT_EQ(label_at(m, "core 1", 5, 5), "copper|A") << "no tube inside a block";
  EXPECT_EQ(label_at(m, "core 1", 9.3, 5), "core|no net") << "a track of B passes between";
}

TEST(Fabrication, EtchedCopperIsATrapezoidOfStairs) {
  const Board board =
      board_with(R"("nets": ["A", "B"], "tracks": [{"layer": "L1", "net": "A", "width": "0.2mm", "points": [[2, 5], [8, 5]]},
      {"layer": "L3", "net": "B", "width": "0.2mm", "points": [[2, 5], [8, 5]]}])");
  const Model m = composed(board, R"("etch": {"factor": 2, "steps": 2})");
  // L1, 40 um, factor 2: 20 um lost at the top, 5 and 15 um by stairs; the foot is on the prepreg below.
  EXPECT_EQ(label_at(m, "L1", 5, 5.094, 1'000), "copper|A");
  EXPECT_EQ(label_at(m, "L1", 5, 5.094, 39'000), "air|no net");
  EXPECT_EQ(label_at(m, "L1", 5, 5.084, 39'000), "copper|A");
  EXPECT_EQ(label_at(m, "L1", 5, 5.096, 1'000), "air|no net");
  // L3 lies on the core above it: narrow below.
  EXPECT_EQ(label_at(m, "L3", 5, 5.094, 29'000), "copper|B");
  EXPECT_EQ(label_at(m, "L3", 5, 5.094, 1'000), "PP|no net");
  double upright = 0, etched = 0;
  const std::string region = R"("region": {"box": {"min": [4, 4], "max": [6, 6]}})";
  (void)checked(board, region, &upright);
  (void)checked(board, R"("etch": {"factor": 2, "steps": 2}, )" + region, &etched);
  const double expected = 2 * (0.04 * (0.2 - 0.02) + 0.03 * (0.2 - 0.015));
  EXPECT_NEAR(upright, 2 * 0.2 * 0.07, 1e-4);
  EXPECT_NEAR(etched, expected, 0.01 * expected);
}

TEST(Fabrication, NetTiesHoldWhenEtched) {
  const Board board = board_with(R"("nets": ["A", "B"], "planes": [{"layer": "L1", "net": "A", "rect": [[2, 4], [4, 6]]},
      {"layer": "L1", "net": "B", "rect": [[4, 4], [6, 6]]}])");
  const Model m = composed(board, R"("etch": {"factor": 2, "steps": 2})");
  EXPECT_EQ(label_at(m, "L1", 3.999, 5, 39'000), "copper|A");
  EXPECT_EQ(label_at(m, "L1", 4.001, 5, 39'000), "copper|B");
  EXPECT_EQ(label_at(m, "L1", 2.01, 5, 39'000), "air|no net");
}

TEST(Fabrication, MaskLiesOverAndBesideCopperButNotOverPads) {
  const Board board =
      board_with(R"("nets": ["A"], "tracks": [{"layer": "L1", "net": "A", "width": "0.2mm", "points": [[2, 5], [8, 5]]}],
      "pads": [{"layer": "L1", "net": "A", "at": [8, 5], "size": [0.6, 0.6]}])");
  const Model m = composed(board, R"("solder_mask": true)");
  EXPECT_EQ(label_at(m, "L1", 5, 7, 1'000), "ink|no net") << "20 um of mask beside 40 um of copper";
  EXPECT_EQ(label_at(m, "L1", 5, 7, 39'000), "air|no net");
  EXPECT_EQ(label_at(m, "mask", 5, 5), "ink|no net") << "over copper";
  EXPECT_EQ(label_at(m, "mask", 5, 7), "air|no net") << "nothing so high in the gap";
  EXPECT_EQ(label_at(m, "mask", 8, 5), "air|no net") << "open over the pad";
  // Below: mask of 50 um over copper of 40 um: the gap is filled and 10 um beyond; over copper 50 um, 40 of them as a film.
  EXPECT_EQ(label_at(m, "L4", 5, 7), "ink|no net");
  EXPECT_EQ(label_at(m, "mask below", 5, 7, 49'000), "ink|no net");
  EXPECT_EQ(label_at(m, "mask below", 5, 7, 1'000), "air|no net");
  (void)checked(board, R"("solder_mask": true, "region": {"box": {"min": [6, 4], "max": [9, 6]}})");
}

constexpr const char* masked_board =
    R"("nets": ["A", "B"], "tracks": [{"layer": "L1", "net": "A", "width": "0.2mm", "points": [[2, 5], [8, 5]]},
      {"layer": "L1", "net": "B", "width": "0.2mm", "points": [[2, 5.5], [8, 5.5]]}],
      "pads": [{"layer": "L1", "net": "A", "at": [8, 5], "size": [0.6, 0.6]}],
      "vias": [{"at": [3, 5.5], "drill": "0.3mm", "pad": "0.6mm", "net": "B"}])";

TEST(Fabrication, MaskLiesOnSheetsInFullAndLeavesThemThere) {
  const Board board = board_with(masked_board);
  const Model m = composed(board, R"("solder_mask": true, "conductors": {"mode": "sheet"})");
  // The copper has no height, so nothing of the mask stands beside it: all its 20 um lie over sheets and laminate alike.
  for (const Nm above : {Nm{1'000}, Nm{19'000}}) {
    EXPECT_EQ(label_at(m, "mask", 5, 5, above), "ink|no net") << "over the sheet";
    EXPECT_EQ(label_at(m, "mask", 5, 7, above), "ink|no net") << "beside it";
    EXPECT_EQ(label_at(m, "mask", 8, 5, above), "air|no net") << "open over the pad";
  }
  const study::Study study = parsed(R"("solder_mask": true, "conductors": {"mode": "sheet"})");
  const mesh::PrismMesh masked = pipeline::mesh_board(board, study).mesh;
  const mesh::PrismMesh bare = pipeline::mesh_board(board, parsed(R"("conductors": {"mode": "sheet"})")).mesh;
  const auto sheet_mm2 = [](const mesh::PrismMesh& mesh, std::string_view name) {
    for (const mesh::FaceTag& tag : mesh.face_tags())
      if (tag.name == name) return tag.area_m2 * 1e6;
    return 0.0;
  };
  // 6 mm of track with a round end, and what the pad has more; under mask and opening alike.
  EXPECT_NEAR(sheet_mm2(masked, "sheet|A"), 6 * 0.2 + 0.01 * std::numbers::pi / 2 + 0.36 - 0.06, 0.01);
  EXPECT_NEAR(sheet_mm2(masked, "sheet|A"), sheet_mm2(bare, "sheet|A"), 1e-4);
  EXPECT_NEAR(sheet_mm2(masked, "sheet|B"), sheet_mm2(bare, "sheet|B"), 1e-4);
}

TEST(Fabrication, MaskOpensAndShortsNoNet) {
  const Board board = board_with(masked_board);
  const std::string region = R"("region": {"box": {"min": [2.5, 4], "max": [9, 6.5]}}, "conductors": {"mode": ")";
  for (const char* mode : {"solid", "hollow", "sheet"}) {
    const validation::Report bare = checked(board, region + mode + R"("})");
    const validation::Report masked = checked(board, region + mode + R"("}, "solder_mask": true)");
    ASSERT_EQ(bare.nets.size(), 2U) << mode;
    ASSERT_EQ(masked.nets.size(), 2U) << mode;
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(masked.nets[i].name, bare.nets[i].name) << mode;
      EXPECT_EQ(masked.nets[i].pieces, 1) << mode << " " << masked.nets[i].name;
      EXPECT_EQ(bare.nets[i].pieces, 1) << mode << " " << bare.nets[i].name;
    }
  }
}

TEST(Fabrication, GapsAreFilledAsTheStudySays) {
  const Board board = board_with(R"("nets": [])");
  EXPECT_EQ(label_at(composed(board, ""), "L2", 5, 5), "PP|no net");
  EXPECT_EQ(label_at(composed(board, R"("fill": [{"layer": "L2", "from": "below"}])"), "L2", 5, 5), "core|no net");
  EXPECT_EQ(label_at(composed(board, R"("fill": [{"layer": "L1", "from": "solder mask"}])"), "L1", 5, 5), "solder mask|no net");
  try {
    (void)composed(board, R"("fill": [{"layer": "L2", "from": "beleow"}])");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::name_unknown);
  }
}

TEST(Materials, TheLibraryIsSoundAndFoundByAnyName) {
  const std::vector<study::LibraryMaterial> library = study::builtin_materials();
  ASSERT_GE(library.size(), 25U);
  for (const study::LibraryMaterial& m : library) {
    EXPECT_FALSE(m.source.empty()) << m.name;
    EXPECT_EQ(study::find_material(library, m.name), &m);
  }
  EXPECT_EQ(study::find_material(library, "rogers 4350b")->name, "Rogers RO4350B");
  EXPECT_EQ(study::find_material(library, "unobtainium"), nullptr);
}

TEST(Materials, WidebandDebyePassesThroughItsValueAndIsCausal) {
  const Dispersion d = djordjevic_sarkar_through({4.2, 0.02}, 1e9);
  const Permittivity at = permittivity_at(d, {}, 1e9);
  EXPECT_NEAR(at.eps_r, 4.2, 1e-12);
  EXPECT_NEAR(at.tan_delta, 0.02, 1e-12);
  // Kramers-Kronig for a nearly flat loss: eps' falls by 2/pi eps'' per factor e.
  const double fall = permittivity_at(d, {}, 1e8).eps_r - permittivity_at(d, {}, 1e10).eps_r;
  EXPECT_NEAR(fall, 2 / std::numbers::pi * 4.2 * 0.02 * std::log(100), 0.002);
  const Dispersion water{.kind = DispersionKind::debye, .eps_inf = 5.2, .poles = {{73.16, 19.24e9}}};
  EXPECT_NEAR(permittivity_at(water, {}, 19.24e9).eps_r, 5.2 + 73.16 / 2, 1e-9);
}

TEST(Materials, StudiesChooseDefineAndDisperse) {
  const Board board = board_with(R"("nets": [])");
  const auto named = [](const Model& m, std::string_view name) {
    for (const board::Material& material : m.materials())
      if (material.name == name) return material;
    ADD_FAILURE() << name;
    return board::Material{};
  };
  const board::Material plain = named(composed(board, R"("mesh": {"frequency": "10GHz"})"), "PP");
  EXPECT_EQ(plain.eps_r, 4);
  const board::Material taken = named(
      composed(board, R"("materials": {"use": [{"board": "PP", "take": "Megtron 6"}]}, "mesh": {"frequency": "10GHz"})"), "PP");
  EXPECT_LT(taken.eps_r, 3.65) << "the value at 1 GHz";
  EXPECT_GT(taken.eps_r, 3.63);
  EXPECT_EQ(taken.at_hz, 1e10);
  const board::Material stated = named(
      composed(board,
               R"("materials": {"stated": {"model": "djordjevic_sarkar", "at": "1GHz"}}, "mesh": {"frequency": "10GHz"})"),
      "PP");
  EXPECT_NEAR(stated.eps_r, 4 - 2 / std::numbers::pi * 0.08 * std::log(10), 0.003);
  try {
    (void)composed(board, R"("materials": {"use": [{"board": "PQ", "take": "Megatron 6"}]})");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("'PQ'"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("Megtron 6"), std::string::npos) << error.what();
  }
}

TEST(PolygonSets, ShrinkingKeepsCornersAndDropsNecks) {
  const geometry::Ring square{{0, 0}, {1'000'000, 0}, {1'000'000, 1'000'000}, {0, 1'000'000}};
  EXPECT_NEAR(geometry::covered_mm2(geometry::shrunk({square}, 100'000)), 0.64, 1e-9);
  EXPECT_TRUE(geometry::shrunk({square}, 500'000).empty());
  EXPECT_NEAR(geometry::covered_mm2(geometry::subtracted({square}, geometry::shrunk({square}, 100'000))), 0.36, 1e-9);
}

}  // namespace
}  // namespace pcbmesh
