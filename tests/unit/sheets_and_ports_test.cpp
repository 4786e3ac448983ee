// SPDX-License-Identifier: GPL-3.0-or-later
// Sheets and ports in the model and on their way through the overlay, on a board of two layers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/compose/compose.hpp"
#include "pcbmesh/extrude/extrude.hpp"
#include "pcbmesh/overlay/overlay.hpp"
#include "pcbmesh/triangulate/triangulate.hpp"

namespace pcbmesh {
namespace {

constexpr Nm mm = nm_per_mm;

/// A line 1 mm wide along x over a plane; a pad of another net beside it; 0.5 mm of core, 35 um of copper.
board::Board make_board() {
  board::BoardParts parts;
  parts.source = "two_layers";
  parts.materials = {{.name = "copper", .sigma_s_per_m = 5.8e7}, {.name = "core", .eps_r = 4}};
  const auto layer = [&](const char* name, board::LayerKind kind, Nm thickness, std::int32_t material) {
    parts.stackup.push_back({name, "", kind, thickness, material});
  };
  layer("top", board::LayerKind::copper, 35'000, 0);
  layer("core", board::LayerKind::dielectric, 500'000, 1);
  layer("bottom", board::LayerKind::copper, 35'000, 0);
  parts.nets = {"GND", "LINE", "OTHER"};
  const auto rectangle = [](Nm x0, Nm y0, Nm x1, Nm y1) { return geometry::Ring{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}; };
  board::Outline outline;
  outline.outer = {rectangle(0, 0, 20 * mm, 10 * mm), {}, true};
  parts.outlines = {outline};
  parts.shapes.push_back({0, 1, board::ShapeKind::track, geometry::segment({2 * mm, 5 * mm}, {18 * mm, 5 * mm}, mm), 0});
  parts.shapes.push_back({0, 2, board::ShapeKind::pad, geometry::polygon(rectangle(9 * mm, 7 * mm, 11 * mm, 8 * mm)), 0});
  parts.shapes.push_back({1, 0, board::ShapeKind::fill, geometry::polygon(rectangle(mm, mm, 19 * mm, 9 * mm)), 0});
  parts.pins.push_back({"J1", "1", 1, {3 * mm, 5 * mm}, 0});
  return board::Board::from_parts(std::move(parts));
}

model::Model composed(const study::Study& study) {
  Diagnostics diagnostics;
  return compose::compose(make_board(), study, diagnostics);
}

study::Study with_mode(study::ConductorMode all, std::vector<study::ConductorRule> rules = {}) {
  study::Study study;
  study.conductors = all;
  study.conductor_rules = std::move(rules);
  return study;
}

study::Port at(Nm x, Nm y) {
  study::Port port;
  port.name = "P";
  port.net = "LINE";
  port.at.point = geometry::Point{x, y};
  return port;
}

model::ModelParts parts_of(const model::Model& model) {
  model::ModelParts parts;
  parts.source = model.source();
  parts.materials.assign(model.materials().begin(), model.materials().end());
  parts.nets.assign(model.nets().begin(), model.nets().end());
  parts.slabs.assign(model.slabs().begin(), model.slabs().end());
  parts.bodies.assign(model.bodies().begin(), model.bodies().end());
  parts.shapes.assign(model.shapes().begin(), model.shapes().end());
  parts.ports.assign(model.ports().begin(), model.ports().end());
  return parts;
}

std::string layers_of(const model::Model& model) {
  std::string text;
  for (const model::Slab& slab : model.slabs()) text += slab.layer + " ";
  return text;
}

const model::Body& body_of(const model::Model& model, const std::string& name) {
  const auto found = std::ranges::find(model.bodies(), name, &model::Body::name);
  EXPECT_NE(found, model.bodies().end()) << name;
  return *found;
}

TEST(Sheets, LayerOfSheetsAloneHasNoSlab) {
  constexpr auto sheet = study::ConductorMode::sheet, solid = study::ConductorMode::solid;
  const model::Model all = composed(with_mode(sheet));
  EXPECT_EQ(layers_of(all), "air below core air above ");
  EXPECT_EQ(body_of(all, "copper LINE on top").sheet->face, 2);
  EXPECT_EQ(body_of(all, "copper GND on bottom").sheet->face, 1);
  EXPECT_EQ(body_of(all, "copper LINE on top").sheet->thickness_nm, 35'000);
  const model::Model mixed = composed(with_mode(solid, {{"LINE", "", sheet}}));
  EXPECT_EQ(layers_of(mixed), "air below bottom core top air above ");
  EXPECT_EQ(body_of(mixed, "copper LINE on top").sheet->face, 3) << "towards the core";
  EXPECT_FALSE(body_of(mixed, "copper OTHER on top").sheet);
  const model::Model below = composed(with_mode(sheet, {{"LINE", "", solid}}));
  EXPECT_EQ(layers_of(below), "air below core top air above ");
}

TEST(Sheets, OtherCopperTakesTheirPlace) {
  const model::Model model = composed(with_mode(study::ConductorMode::sheet));
  const auto line = static_cast<std::int32_t>(&body_of(model, "copper LINE on top") - model.bodies().data());
  const std::vector<std::int32_t> present{0, 1, line}, beside_board{0, line};
  EXPECT_EQ(model.sheet_at(2, present), line);
  EXPECT_EQ(model.sheet_at(1, present), -1);
  EXPECT_EQ(model.sheet_at(2, beside_board), -1);
  EXPECT_EQ(model.resolve(1, present).net, board::no_net) << "a sheet fills no slab";
}

TEST(Ports, M4_TheyComeLastAndStandBetweenTheirConductors) {
  study::Study study;
  study.ports = {at(10 * mm, 5 * mm)};
  const model::Model model = composed(study);
  ASSERT_EQ(model.ports().size(), 1U);
  const model::Port& port = model.ports()[0];
  EXPECT_EQ(model.net_name(port.positive_net), "LINE");
  EXPECT_EQ(model.net_name(port.negative_net), "GND");
  EXPECT_NEAR(port.width_m, 1e-3, 1e-12);
  EXPECT_NEAR(port.length_m, 0.5e-3, 1e-12);
  EXPECT_EQ(port.direction[2], 1);
  const model::Body& body = model.bodies()[static_cast<std::size_t>(port.body)];
  EXPECT_EQ(body.kind, model::BodyKind::port);
  EXPECT_EQ(model.slabs()[static_cast<std::size_t>(body.first_slab)].layer, "core");
  EXPECT_EQ(body.first_slab, body.last_slab);
  EXPECT_EQ(model.first_guide_body(), static_cast<std::int32_t>(model.bodies().size()) - 1);
}

TEST(Ports, FlatPortsCrossTheGap) {
  study::Study study;
  study::Port port = at(10 * mm, 5 * mm);
  port.shape = study::PortShape::gap;
  port.reference = "OTHER";
  port.width = mm;
  study.ports = {port};
  const model::Model model = composed(study);
  ASSERT_EQ(model.ports().size(), 1U);
  EXPECT_EQ(model.ports()[0].faces, model::PortFaces::cap);
  EXPECT_NEAR(model.ports()[0].length_m, 1.5e-3, 1e-9) << "from y = 5.5 mm to 7 mm";
  EXPECT_NEAR(model.ports()[0].direction[1], -1, 1e-12) << "from OTHER to LINE";
}

TEST(Ports, EveryFaultIsToldAtOnce) {
  study::Study study;
  study.ports = {at(10 * mm, 2 * mm), at(30 * mm, 5 * mm), at(10 * mm, 5 * mm)};
  for (std::size_t i = 0; i < study.ports.size(); ++i) study.ports[i].name = std::string(1, static_cast<char>('a' + i));
  study.ports[2].width = 3 * mm;
  try {
    (void)composed(study);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::port_invalid);
    for (const char* word : {"/ports/0: port 'a'", "no copper at", "/ports/1: port 'b'", "outside the domain",
                             "/ports/2: port 'c'", "leaves the copper"})
      EXPECT_NE(error.text().find(word), std::string::npos) << word << " in " << error.text();
  }
}

/// Vertices of the graph on the port's line, with which the line must run straight from end to end.
TEST(Ports, TheOverlayKeepsTheirEdgesStraight) {
  study::Study study;
  study::Port port = at(9 * mm + 400, 5 * mm);
  study.ports = {port};
  // A corner 8 um beside the line: within the tolerance, so that line and corner become one. The line must not bend.
  model::ModelParts parts = parts_of(composed(study));
  const auto other = static_cast<std::int32_t>(std::ranges::find(parts.bodies, "copper OTHER on top", &model::Body::name) -
                                               parts.bodies.begin());
  parts.shapes.push_back(
      {.body = other, .rings = {{{9 * mm + 8400, 5'200'000}, {10 * mm, 4'900'000}, {10 * mm, 5'300'000}}}, .simple = true});
  const model::Model model = model::Model::from_parts(std::move(parts));
  Diagnostics diagnostics;
  const overlay::OverlayResult result = overlay::overlay(model, {.tolerance_nm = 20'000}, diagnostics);
  double length = 0;
  const auto vertices = result.graph.vertices();
  for (std::size_t e = 0; e < result.graph.edges().size(); ++e) {
    const auto increments = result.graph.increments(e);
    const auto p = vertices[static_cast<std::size_t>(result.graph.edges()[e][0])],
               q = vertices[static_cast<std::size_t>(result.graph.edges()[e][1])];
    const bool of_port =
        std::ranges::any_of(increments, [&](const mesh::Increment& i) { return i.body == model.ports()[0].body; });
    if (!of_port || p.x != 9 * mm + 400 || q.x != 9 * mm + 400) continue;
    length += std::abs(static_cast<double>(q.y - p.y));
  }
  EXPECT_EQ(length, 1e6) << "the line is 1 mm long, straight, where it was put";
}

/// Planar mesh of a study, with or without chords.
mesh::PlanarMesh triangulated(const model::Model& model, bool split_chords) {
  Diagnostics diagnostics;
  const overlay::OverlayResult graph = overlay::overlay(model, {}, diagnostics);
  triangulate::TriangulateOptions options;
  options.split_sheet_chords = split_chords;
  return triangulate::triangulate(graph.graph, model, options, diagnostics).mesh;
}

/// Edges inside the sheets of a face with both ends on their rim.
int chords(const mesh::PlanarMesh& planar, const model::Model& model, std::int32_t face) {
  std::map<std::pair<std::int32_t, std::int32_t>, int> sides;
  for (std::int32_t t = 0; t < planar.num_triangles(); ++t) {
    if (model.sheet_at(face, planar.bodies_of_region(planar.regions()[static_cast<std::size_t>(t)])) < 0) continue;
    const auto& c = planar.triangles()[static_cast<std::size_t>(t)];
    for (std::size_t i = 0; i < 3; ++i) ++sides[std::minmax(c[i], c[i == 2 ? 0 : i + 1])];
  }
  std::set<std::int32_t> rim;
  for (const auto& [edge, count] : sides)
    if (count == 1) rim.insert({edge.first, edge.second});
  return static_cast<int>(std::ranges::count_if(sides, [&](const auto& side) {
    return side.second == 2 && rim.contains(side.first.first) && rim.contains(side.first.second);
  }));
}

TEST(Sheets, T5_SplittingLeavesNoChord) {
  const model::Model model = composed(with_mode(study::ConductorMode::sheet));
  EXPECT_GT(chords(triangulated(model, false), model, 2), 10);
  EXPECT_EQ(chords(triangulated(model, true), model, 2), 0);
  EXPECT_EQ(chords(triangulated(model, true), model, 1), 0);
}

TEST(Ports, E3_TheFacesAreTheRectangle) {
  study::Study study;
  study.ports = {at(10 * mm, 5 * mm)};
  const model::Model model = composed(study);
  Diagnostics diagnostics;
  const mesh::PlanarMesh planar = triangulated(model, false);
  std::vector<double> z;
  std::vector<std::int32_t> slab;
  for (std::size_t s = 0; s < model.slabs().size(); ++s) {
    z.push_back(static_cast<double>(model.slabs()[s].z_bottom_nm) * 1e-9);
    slab.push_back(static_cast<std::int32_t>(s));
  }
  z.push_back(static_cast<double>(model.slabs().back().z_top_nm) * 1e-9);
  const mesh::LayerPlan plan = mesh::LayerPlan::from_parts({z, slab});
  const mesh::PrismMesh prisms = extrude::extrude(planar, plan, model, {}, {});
  ASSERT_EQ(prisms.ports().size(), 1U);
  const auto tag = std::ranges::find(prisms.face_tags(), "port|P", &mesh::FaceTag::name);
  ASSERT_NE(tag, prisms.face_tags().end());
  EXPECT_TRUE(tag->is_inner);
  EXPECT_EQ(tag->condition, mesh::BoundaryCondition::port);
  EXPECT_NEAR(tag->area_m2, 1e-3 * 0.5e-3, 1e-15);
  // The same port over a model whose conductor is somewhere else is an error, not a mesh.
  model::ModelParts elsewhere = parts_of(model);
  elsewhere.ports[0].negative_net = 2;
  EXPECT_THROW((void)extrude::extrude(planar, plan, model::Model::from_parts(std::move(elsewhere)), {}, {}), Error);
}

}  // namespace
}  // namespace pcbmesh
