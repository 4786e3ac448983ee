// SPDX-License-Identifier: GPL-3.0-or-later
// Every noun refuses to be built when an invariant of its header is broken. Test names carry the guarantee.
#include <gtest/gtest.h>

#include <functional>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/board/board.hpp"
#include "pcbmesh/mesh/layer_plan.hpp"
#include "pcbmesh/mesh/planar_graph.hpp"
#include "pcbmesh/mesh/planar_mesh.hpp"
#include "pcbmesh/model/model.hpp"

namespace pcbmesh {
namespace {

constexpr Nm mm = nm_per_mm;

template <class Build>
ErrorCode code_of(Build build) {
  try {
    build();
  } catch (const Error& error) {
    return error.code();
  }
  return ErrorCode{0};
}

board::BoardParts good_board() {
  board::BoardParts parts;
  parts.source = "board.json";
  parts.materials = {{"copper", 1, 0, 1, 5.8e7}, {"FR4", 4.5, 0.02, 1, 0}};
  parts.stackup = {{"F.Cu", "", board::LayerKind::copper, 35'000, 0},
                   {"core", "", board::LayerKind::dielectric, mm, 1},
                   {"B.Cu", "", board::LayerKind::copper, 35'000, 0}};
  parts.nets = {"GND", "/USB_P"};
  parts.shapes = {{0, 1, board::ShapeKind::track, geometry::segment({0, 0}, {mm, 0}, mm / 5), 7}};
  parts.drills = {{geometry::disc({0, 0}, mm / 4), 0, 1, true, 0, board::ShapeKind::via, 9}};
  parts.outlines = {{geometry::Path{{{0, 0}, {mm, 0}, {mm, mm}}, {}, true}, {}}};
  return parts;
}

ErrorCode broken_board(const std::function<void(board::BoardParts&)>& damage) {
  return code_of([&] {
    board::BoardParts parts = good_board();
    damage(parts);
    (void)board::Board::from_parts(parts);
  });
}

TEST(Board, B1_ShapesNameExistingLayersAndNets) {
  EXPECT_EQ(broken_board([](auto&) {}), ErrorCode{0});
  EXPECT_EQ(broken_board([](auto& p) { p.shapes[0].copper_layer = 2; }), ErrorCode::board_invalid);
  EXPECT_EQ(broken_board([](auto& p) { p.shapes[0].net = 2; }), ErrorCode::board_invalid);
  EXPECT_EQ(broken_board([](auto& p) { p.stackup[1].material = 2; }), ErrorCode::stackup_invalid);
}

TEST(Board, B2_ThicknessesArePositiveAndThereIsCopper) {
  EXPECT_EQ(broken_board([](auto& p) { p.stackup[1].thickness_nm = 0; }), ErrorCode::stackup_invalid);
  EXPECT_EQ(broken_board([](auto& p) {
              p.stackup = {p.stackup[1]};
              p.shapes.clear();
              p.drills.clear();
            }),
            ErrorCode::stackup_invalid);
}

TEST(Board, B3_DrillSpansAreOrderedAndInside) {
  EXPECT_EQ(broken_board([](auto& p) { std::swap(p.drills[0].first_copper, p.drills[0].last_copper); }),
            ErrorCode::board_invalid);
  EXPECT_EQ(broken_board([](auto& p) { p.drills[0].last_copper = 2; }), ErrorCode::board_invalid);
  EXPECT_EQ(broken_board([](auto& p) { p.drills[0].figure.pen = 0; }), ErrorCode::board_invalid);
}

TEST(Board, B4_CoordinatesAreOnABoardAndOutlinesClosed) {
  EXPECT_EQ(broken_board([](auto& p) { p.shapes[0].figure.path.points[0].x = max_coordinate_nm + 1; }),
            ErrorCode::board_invalid);
  EXPECT_EQ(broken_board([](auto& p) { p.outlines[0].outer.closed = false; }), ErrorCode::outline_invalid);
}

TEST(Board, ErrorsNameFileAndLine) {
  board::BoardParts parts = good_board();
  parts.shapes[0].net = 5;
  try {
    (void)board::Board::from_parts(parts);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("board.json:7"), std::string::npos) << error.what();
  }
}

TEST(Board, ListsNearMissesOfANetName) {
  const board::Board b = board::Board::from_parts(good_board());
  EXPECT_EQ(b.find_net("GND"), 0);
  EXPECT_EQ(b.find_net("gnd"), std::nullopt);
  EXPECT_EQ(b.similar_nets("USB_P"), std::vector<std::string>{"/USB_P"});
  EXPECT_EQ(b.similar_nets("gnd"), std::vector<std::string>{"GND"});
  EXPECT_TRUE(b.similar_nets("CLOCK_125").empty());
}

model::ModelParts good_model() {
  model::ModelParts parts;
  parts.materials = {{"copper", 1, 0, 1, 5.8e7}, {"FR4", 4.5, 0.02, 1, 0}, {"air"}};
  parts.nets = {"GND"};
  parts.slabs = {{"core", model::SlabKind::dielectric, 0, mm, 1, 2}, {"F.Cu", model::SlabKind::copper, mm, mm + 35'000, 2, 2}};
  parts.bodies = {{"domain", model::BodyKind::domain, -1, -1, 0, 1, 0, false},
                  {"board", model::BodyKind::board, -1, -1, 0, 1, 0, false},
                  {"copper", model::BodyKind::copper, 0, 0, 1, 1, 2, false},
                  {"hole", model::BodyKind::hole, 2, -1, 0, 1, 3, false},
                  {"barrel", model::BodyKind::barrel, 0, 0, 0, 1, 4, true}};
  parts.shapes = {{0, {{{0, 0}, {mm, 0}, {mm, mm}}}, true, 0}};
  return parts;
}

ErrorCode broken_model(const std::function<void(model::ModelParts&)>& damage) {
  return code_of([&] {
    model::ModelParts parts = good_model();
    damage(parts);
    (void)model::Model::from_parts(parts);
  });
}

TEST(Model, M1_SlabsAreContiguous) {
  EXPECT_EQ(broken_model([](auto&) {}), ErrorCode{0});
  EXPECT_EQ(broken_model([](auto& p) { p.slabs[1].z_bottom_nm += 1; }), ErrorCode::internal);
  EXPECT_EQ(broken_model([](auto& p) { p.slabs[1].z_top_nm = p.slabs[1].z_bottom_nm; }), ErrorCode::internal);
}

TEST(Model, M2_DomainAndBoardComeFirst) {
  EXPECT_EQ(broken_model([](auto& p) { std::swap(p.bodies[0], p.bodies[1]); }), ErrorCode::internal);
  EXPECT_EQ(broken_model([](auto& p) { p.bodies[1].last_slab = 0; }), ErrorCode::internal);
  EXPECT_EQ(broken_model([](auto& p) { p.bodies[2].net = 1; }), ErrorCode::internal);
}

TEST(Model, M3_ShapesNameBodies) {
  EXPECT_EQ(broken_model([](auto& p) { p.shapes[0].body = 9; }), ErrorCode::internal);
  EXPECT_EQ(broken_model([](auto& p) { p.shapes[0].rings.clear(); }), ErrorCode::internal);
}

TEST(Model, M4_BodiesOfPortsComeLastAndBelongToPorts) {
  const auto with_port = [](model::ModelParts& parts) {
    model::Body footprint = parts.bodies.back();
    footprint.kind = model::BodyKind::port;
    parts.bodies.push_back(footprint);
    parts.ports.push_back({.name = "P1", .body = static_cast<std::int32_t>(parts.bodies.size()) - 1});
  };
  EXPECT_NE(broken_model(with_port), ErrorCode::internal) << "a port with its body is sound";
  EXPECT_EQ(broken_model([&](model::ModelParts& parts) { with_port(parts), parts.ports.clear(); }), ErrorCode::internal);
  EXPECT_EQ(broken_model([&](model::ModelParts& parts) { with_port(parts), parts.ports[0].body = 0; }), ErrorCode::internal);
  EXPECT_EQ(broken_model([&](model::ModelParts& parts) {
              with_port(parts);
              parts.bodies.push_back(parts.bodies[2]);
            }),
            ErrorCode::internal);
}

TEST(Model, ResolvesByPriority) {
  const model::Model m = model::Model::from_parts(good_model());
  const auto material = [&](std::int32_t slab, std::vector<std::int32_t> present) { return m.resolve(slab, present).material; };
  EXPECT_TRUE(m.resolve(0, std::vector<std::int32_t>{1, 2}).is_void());  // outside the domain
  EXPECT_EQ(material(1, {0, 2}), 2);                                     // outside the board: air, copper is cut off
  EXPECT_EQ(material(0, {0, 1}), 1);
  EXPECT_EQ(material(1, {0, 1}), 2);
  EXPECT_EQ(material(1, {0, 1, 2}), 0);
  EXPECT_EQ(material(0, {0, 1, 2}), 1);     // the copper is not in this slab
  EXPECT_EQ(material(1, {0, 1, 2, 3}), 2);  // hole beats copper
  const model::Label barrel = m.resolve(1, std::vector<std::int32_t>{0, 1, 2, 3, 4});
  EXPECT_TRUE(barrel.is_void());
  EXPECT_EQ(barrel.hollow_net, 0);
}

mesh::PlanarGraphParts square() {
  return {{{0, 0}, {10, 0}, {10, 10}, {0, 10}},
          {{0, 1}, {1, 2}, {2, 3}, {0, 3}},
          {0, 1, 2, 3, 4},
          {{0, 1}, {0, 1}, {0, 1}, {0, -1}}};
}

TEST(PlanarGraph, G1_VerticesAndEdgesAreDistinct) {
  EXPECT_EQ(code_of([] { (void)mesh::PlanarGraph::from_parts(square()); }), ErrorCode{0});
  EXPECT_EQ(code_of([] {
              auto p = square();
              p.vertices[3] = p.vertices[0];
              (void)mesh::PlanarGraph::from_parts(p);
            }),
            ErrorCode::internal);
  EXPECT_EQ(code_of([] {
              auto p = square();
              p.edges[1] = {2, 1};
              (void)mesh::PlanarGraph::from_parts(p);
            }),
            ErrorCode::internal);
}

TEST(PlanarGraph, G3_WindingIsConsistentRoundEveryVertex) {
  EXPECT_EQ(code_of([] {
              auto p = square();
              p.increments[3].delta = 1;
              (void)mesh::PlanarGraph::from_parts(p);
            }),
            ErrorCode::internal);
  EXPECT_EQ(code_of([] {
              auto p = square();
              p.increments[2].body = 1;
              (void)mesh::PlanarGraph::from_parts(p);
            }),
            ErrorCode::internal);
}

TEST(PlanarMesh, P2_TrianglesAreCounterClockwiseAndPointsUsed) {
  const mesh::PlanarMeshParts good{{{0, 0}, {1, 0}, {0, 1}}, {{0, 1, 2}}, {0}, {}, {0, 1}, {0}};
  EXPECT_EQ(code_of([&] { (void)mesh::PlanarMesh::from_parts(good); }), ErrorCode{0});
  EXPECT_EQ(code_of([&] {
              auto p = good;
              std::swap(p.triangles[0][1], p.triangles[0][2]);
              (void)mesh::PlanarMesh::from_parts(p);
            }),
            ErrorCode::internal);
  EXPECT_EQ(code_of([&] {
              auto p = good;
              p.points_m.push_back({5, 5});
              (void)mesh::PlanarMesh::from_parts(p);
            }),
            ErrorCode::internal);
  EXPECT_EQ(code_of([&] {
              auto p = good;
              p.regions[0] = 1;
              (void)mesh::PlanarMesh::from_parts(p);
            }),
            ErrorCode::internal);
}

TEST(LayerPlan, L1_LevelsIncreaseAndEverySlabHasASublayer) {
  EXPECT_EQ(code_of([] { (void)mesh::LayerPlan::from_parts({{0, 1, 2, 4}, {0, 0, 1}}); }), ErrorCode{0});
  EXPECT_EQ(code_of([] { (void)mesh::LayerPlan::from_parts({{0, 1, 1, 4}, {0, 0, 1}}); }), ErrorCode::layering_invalid);
  EXPECT_EQ(code_of([] { (void)mesh::LayerPlan::from_parts({{0, 1, 2, 4}, {0, 0, 2}}); }), ErrorCode::layering_invalid);
  EXPECT_EQ(mesh::LayerPlan::from_parts({{0, 1, 2, 4}, {0, 0, 1}}).first_sublayer(1), 2);
}

}  // namespace
}  // namespace pcbmesh
