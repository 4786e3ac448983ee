// SPDX-License-Identifier: GPL-3.0-or-later
// Where ports are put, and why not: gaps along both axes, wave ports on every side, rings in antipads, and all that is refused.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/compose/compose.hpp"
#include "pcbmesh/extrude/extrude.hpp"
#include "pcbmesh/layering/divide_layers.hpp"
#include "pcbmesh/mesh/port_measures.hpp"
#include "pcbmesh/overlay/overlay.hpp"
#include "pcbmesh/triangulate/triangulate.hpp"

namespace pcbmesh {
namespace {

constexpr Nm mm = nm_per_mm, um = nm_per_um;
using geometry::Point;
using geometry::Ring;
using study::HullSide;

enum Net : std::int32_t { gnd, line, other };

Ring rectangle(Nm x0, Nm y0, Nm x1, Nm y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

/// 20 mm x 20 mm; copper of 35 um on both sides of a core of 0.5 mm.
class Layout {
 public:
  Layout() {
    parts_.source = "layout";
    parts_.materials = {{.name = "copper", .sigma_s_per_m = 5.8e7}, {.name = "core", .eps_r = 4}};
    parts_.stackup = {{"top", "", board::LayerKind::copper, 35 * um, 0},
                      {"core", "", board::LayerKind::dielectric, 500 * um, 1},
                      {"bottom", "", board::LayerKind::copper, 35 * um, 0}};
    parts_.nets = {"GND", "LINE", "OTHER"};
    board::Outline outline;
    outline.outer = {rectangle(-10 * mm, -10 * mm, 10 * mm, 10 * mm), {}, true};
    parts_.outlines = {outline};
  }
  Layout& pad(std::int32_t layer, std::int32_t net, Ring ring) {
    parts_.shapes.push_back({layer, net, board::ShapeKind::pad, geometry::polygon(std::move(ring)), 0});
    return *this;
  }
  Layout& track(std::int32_t layer, std::int32_t net, Point a, Point b, Nm width = mm) {
    parts_.shapes.push_back({layer, net, board::ShapeKind::track, geometry::segment(a, b, width), 0});
    return *this;
  }
  Layout& plane(std::int32_t layer) {
    parts_.shapes.push_back(
        {layer, gnd, board::ShapeKind::fill, geometry::polygon(rectangle(-9 * mm, -9 * mm, 9 * mm, 9 * mm)), 0});
    return *this;
  }
  /// A plane with a hole of any shape, as one ring with a slit.
  Layout& plane_with_hole(std::int32_t layer, Ring hole) {
    geometry::make_counter_clockwise(hole);
    const auto right = std::ranges::max_element(hole, {}, &Point::x);
    std::ranges::rotate(hole, right);
    Ring ring = rectangle(-9 * mm, -9 * mm, 9 * mm, 9 * mm);
    ring.insert(ring.begin() + 2, {9 * mm, hole.front().y});
    ring.insert(ring.begin() + 3, hole.front());
    ring.insert(ring.begin() + 4, hole.rbegin(), hole.rend());
    ring.insert(ring.begin() + 4 + static_cast<std::ptrdiff_t>(hole.size()), {9 * mm, hole.front().y});
    parts_.shapes.push_back({layer, gnd, board::ShapeKind::fill, geometry::polygon(std::move(ring)), 0});
    return *this;
  }
  Layout& via(Point at, Nm drill, Nm ring, std::int32_t net = line) {
    board::Drill hole;
    hole.figure = geometry::disc(at, drill);
    hole.last_copper = 1;
    hole.net = net;
    parts_.drills.push_back(hole);
    for (const std::int32_t layer : {0, 1})
      if (ring > 0) parts_.shapes.push_back({layer, net, board::ShapeKind::via, geometry::disc(at, ring), 0});
    return *this;
  }
  Layout& hole(Point at, Nm diameter) {
    board::Drill drill;
    drill.figure = geometry::disc(at, diameter);
    drill.last_copper = 1;
    drill.plated = false;
    parts_.drills.push_back(drill);
    return *this;
  }
  Layout& cutout(Ring ring) {
    parts_.outlines.front().cutouts.push_back({std::move(ring), {}, true});
    return *this;
  }
  [[nodiscard]] board::Board board() const { return board::Board::from_parts(parts_); }

 private:
  board::BoardParts parts_;
};

study::Port port(std::string name, Point at, study::PortShape shape = study::PortShape::automatic) {
  study::Port out;
  out.name = std::move(name);
  out.net = "LINE";
  out.at.point = at;
  out.shape = shape;
  return out;
}

study::Port on_side(std::string name, HullSide side, study::PortKind kind = study::PortKind::wave) {
  study::Port out;
  out.name = std::move(name);
  out.net = "LINE";
  out.kind = kind;
  out.at.side = side;
  return out;
}

model::Model composed(const Layout& layout, const study::Study& study) {
  Diagnostics diagnostics;
  return compose::compose(layout.board(), study, diagnostics);
}

/// The text of what is refused; empty if nothing is.
std::string refusal(const Layout& layout, const study::Study& study) {
  try {
    (void)composed(layout, study);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::port_invalid) << error.text();
    return error.text();
  }
  return "";
}

std::string refusal(const Layout& layout, const study::Port& one) {
  study::Study study;
  study.ports = {one};
  return refusal(layout, study);
}

void expect_words(const std::string& text, std::initializer_list<const char*> words) {
  for (const char* word : words) EXPECT_NE(text.find(word), std::string::npos) << word << " is not in: " << text;
}

struct Made {
  model::Model model;
  mesh::PlanarMesh planar;
  mesh::PrismMesh prisms;
  const mesh::FaceTag& tag(const std::string& name) const {
    const auto found = std::ranges::find(prisms.face_tags(), name, &mesh::FaceTag::name);
    if (found == prisms.face_tags().end()) throw std::runtime_error("no face tag " + name);
    return *found;
  }
};

/// The whole way to prisms, with the sub-layers that the ports ask for.
Made meshed(const Layout& layout, const study::Study& study) {
  model::Model model = composed(layout, study);
  Diagnostics diagnostics;
  const overlay::OverlayResult graph = overlay::overlay(model, {}, diagnostics);
  mesh::PlanarMesh planar = triangulate::triangulate(graph.graph, model, {}, diagnostics).mesh;
  const std::vector<int> counts(model.slabs().size(), 1);
  const auto layers = layering::divide_layers(model.slabs(), counts, layering::slab_limits(model, study), std::nullopt);
  mesh::PrismMesh prisms = extrude::extrude(planar, layers.plan, model, graph.net_pieces, graph.touching_nets);
  return {std::move(model), std::move(planar), std::move(prisms)};
}

// ---- gaps ---------------------------------------------------------------------------------------------------------

/// Two pads 0.4 mm apart, the second one in one of four directions from the first.
TEST(GapPorts, CrossTheGapAlongBothAxesBothWays) {
  constexpr std::array<std::array<int, 2>, 4> ways{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
  for (const auto& [dx, dy] : ways) {
    Layout layout;
    const Nm x = dx * 1400 * um, y = dy * 1400 * um;
    layout.pad(0, line, rectangle(-500 * um, -500 * um, 500 * um, 500 * um));
    layout.pad(0, other, rectangle(x - 500 * um, y - 500 * um, x + 500 * um, y + 500 * um));
    study::Study study;
    study.ports = {port("P", {0, 0}, study::PortShape::gap)};
    study.ports[0].reference = "OTHER";
    for (const auto mode : {study::ConductorMode::solid, study::ConductorMode::hollow, study::ConductorMode::sheet}) {
      study.conductors = mode;
      const Made made = meshed(layout, study);
      ASSERT_EQ(made.prisms.ports().size(), 1U);
      const mesh::Port& p = made.prisms.ports()[0];
      EXPECT_NEAR(p.length_m, 0.4e-3, 1e-12) << dx << dy;
      EXPECT_NEAR(p.direction[0], -dx, 1e-12) << "from OTHER to LINE";
      EXPECT_NEAR(p.direction[1], -dy, 1e-12);
      EXPECT_EQ(p.direction[2], 0);
      EXPECT_NEAR(p.at_m[0], dx * 0.7e-3, 1e-9);
      EXPECT_NEAR(p.at_m[1], dy * 0.7e-3, 1e-9);
      EXPECT_NEAR(made.tag("port|P").area_m2, p.length_m * p.width_m, 1e-15);
      EXPECT_TRUE(made.tag("port|P").is_inner);
    }
  }
}

TEST(GapPorts, OnTheFacesOfTheBottomToo) {
  Layout layout;
  layout.pad(1, line, rectangle(-500 * um, -500 * um, 500 * um, 500 * um));
  layout.pad(1, other, rectangle(800 * um, -500 * um, 1500 * um, 500 * um));
  study::Study study;
  study.ports = {port("P", {0, 0}, study::PortShape::gap)};
  study.ports[0].reference = "OTHER";
  const Made made = meshed(layout, study);
  EXPECT_NEAR(made.prisms.ports()[0].at_m[2], 35e-6, 1e-12) << "where the copper meets the core";
}

TEST(GapPorts, SkewedEdgesAreNoGap) {
  Layout layout;
  layout.pad(0, line, rectangle(-500 * um, -500 * um, 500 * um, 500 * um));
  layout.pad(0, other, {{900 * um, -500 * um}, {1800 * um, -500 * um}, {1800 * um, 500 * um}, {1100 * um, 500 * um}});
  study::Port one = port("P", {0, 0}, study::PortShape::gap);
  one.reference = "OTHER";
  expect_words(refusal(layout, one),
               {"/ports/0", "port 'P'", "(0, 0) mm", "top", "no gap with two straight edges", "net 'OTHER'"});
  // Turned pads are skewed to both axes.
  Layout turned;
  turned.pad(0, line, {{0, -700 * um}, {700 * um, 0}, {0, 700 * um}, {-700 * um, 0}});
  turned.pad(0, other, {{1000 * um, -400 * um}, {1700 * um, 300 * um}, {1000 * um, 1000 * um}, {300 * um, 300 * um}});
  expect_words(refusal(turned, one), {"no gap with two straight edges"});
}

TEST(GapPorts, ALineBesideIsNoReferenceUnlessNamed) {
  Layout layout;
  layout.pad(0, line, rectangle(-500 * um, -500 * um, 500 * um, 500 * um));
  layout.pad(0, other, rectangle(800 * um, -500 * um, 1500 * um, 500 * um));
  expect_words(refusal(layout, port("P", {0, 0}, study::PortShape::gap)), {"a net with filled areas"});
}

TEST(GapPorts, WhatStandsInTheGapIsFound) {
  Layout layout;
  layout.pad(0, line, rectangle(-500 * um, -500 * um, 500 * um, 500 * um));
  layout.pad(0, gnd, rectangle(700 * um, -100 * um, 800 * um, 100 * um));
  layout.pad(0, other, rectangle(1100 * um, -500 * um, 1800 * um, 500 * um));
  study::Port one = port("P", {0, 0}, study::PortShape::gap);
  one.reference = "OTHER";
  expect_words(refusal(layout, one), {"no gap"});
}

// ---- wave ports ---------------------------------------------------------------------------------------------------

/// A line through the region along x (for xmin, xmax) or y, over or under a plane.
TEST(WavePorts, OnEverySideOverAndUnderThePlane) {
  for (const HullSide side : {HullSide::xmin, HullSide::xmax, HullSide::ymin, HullSide::ymax}) {
    for (const std::int32_t layer : {0, 1}) {
      const bool along_x = side == HullSide::xmin || side == HullSide::xmax;
      Layout layout;
      layout.plane(1 - layer);
      layout.track(layer, line, along_x ? Point{-8 * mm, 0} : Point{0, -8 * mm}, along_x ? Point{8 * mm, 0} : Point{0, 8 * mm});
      study::Study study;
      study.region = study::RegionKind::box;
      study.box = geometry::Box{{-4 * mm, -4 * mm}, {4 * mm, 4 * mm}};
      study.ports = {on_side("W", side)};
      for (const auto mode : {study::ConductorMode::solid, study::ConductorMode::hollow, study::ConductorMode::sheet}) {
        study.conductors = mode;
        SCOPED_TRACE(fmt::format("{} {} {}", study::name_of(side), layer, study::name_of(mode)));
        const Made made = meshed(layout, study);
        ASSERT_EQ(made.prisms.ports().size(), 1U);
        const mesh::Port& p = made.prisms.ports()[0];
        EXPECT_EQ(p.kind, mesh::PortKind::wave);
        EXPECT_EQ(p.direction[2], layer == 0 ? 1 : -1) << "towards the line";
        const double at = side == HullSide::xmin || side == HullSide::ymin ? -4e-3 : 4e-3;
        EXPECT_NEAR(p.at_m[along_x ? 0 : 1], at, 1e-12);
        const mesh::FaceTag& tag = made.tag("waveport|W");
        EXPECT_FALSE(tag.is_inner);
        EXPECT_EQ(tag.num_triangles, 0);
        // One conductor and three heights on each side wide, from the plane to the end of the air; cut copper is the side's.
        const bool is_sheet = mode == study::ConductorMode::sheet;
        const double height = 0.5e-3 + (is_sheet ? 0 : 35e-6) + 1e-3, width = 1e-3 + 6 * 0.5e-3;
        EXPECT_NEAR(p.width_m, width, 1e-9);
        EXPECT_NEAR(tag.area_m2, width * height - (is_sheet ? 0 : 1e-3 * 35e-6), 1e-12);
      }
    }
  }
}

study::Study boxed(std::vector<study::Port> ports) {
  study::Study study;
  study.region = study::RegionKind::box;
  study.box = geometry::Box{{-4 * mm, -4 * mm}, {4 * mm, 4 * mm}};
  study.ports = std::move(ports);
  return study;
}

TEST(WavePorts, HoldSeveralConductors) {
  Layout layout;
  layout.plane(1).track(0, line, {-8 * mm, 0}, {8 * mm, 0}, 300 * um).track(0, other, {-8 * mm, mm}, {8 * mm, mm}, 300 * um);
  study::Study study = boxed({on_side("W", HullSide::xmin)});
  study.ports[0].width = 4 * mm;
  const Made made = meshed(layout, study);
  EXPECT_NEAR(made.tag("waveport|W").area_m2, 4e-3 * (0.5e-3 + 35e-6 + 1e-3) - 2 * 0.3e-3 * 35e-6, 1e-12);
}

TEST(WavePorts, AnEdgeThroughAnotherConductorIsRefused) {
  Layout layout;
  layout.plane(1).track(0, line, {-8 * mm, 0}, {8 * mm, 0}, 300 * um).track(0, other, {-8 * mm, mm}, {8 * mm, mm}, 300 * um);
  study::Study study = boxed({on_side("W", HullSide::xmin)});
  study.ports[0].width = 2 * mm;
  expect_words(refusal(layout, study),
               {"/ports/0", "port 'W'", "(-4, 1) mm", "cuts the copper of net 'OTHER' on top", "width"});
}

TEST(WavePorts, TwoThatOverlapAreRefused) {
  Layout layout;
  layout.plane(1)
      .track(0, line, {-8 * mm, 0}, {8 * mm, 0}, 300 * um)
      .track(0, other, {-8 * mm, 2 * mm}, {8 * mm, 2 * mm}, 300 * um);
  study::Study study = boxed({on_side("A", HullSide::xmin), on_side("B", HullSide::xmin)});
  study.ports[1].net = "OTHER";
  expect_words(refusal(layout, study), {"/ports/1", "port 'B' would share faces with port 'A'"});
  study.ports[0].width = study.ports[1].width = 1500 * um;
  EXPECT_EQ(refusal(layout, study), "");
  study.ports[1].at.side = HullSide::xmax;
  study.ports[0].width = study.ports[1].width = std::nullopt;
  EXPECT_EQ(refusal(layout, study), "") << "sides of their own";
}

TEST(WavePorts, WhatIsNotCutOrHasNoReferenceIsRefused) {
  Layout bare;
  bare.track(0, line, {-8 * mm, 0}, {8 * mm, 0});
  expect_words(refusal(bare, boxed({on_side("W", HullSide::xmin)})), {"no reference was found"});
  Layout layout;
  layout.plane(1).track(0, line, {-8 * mm, 0}, {0, 0});
  expect_words(refusal(layout, boxed({on_side("W", HullSide::xmax)})), {"is not cut at xmax", "x = 4 mm"});
  study::Study wide = boxed({on_side("W", HullSide::xmin)});
  wide.ports[0].width = 9 * mm;
  expect_words(refusal(layout, wide), {"reaches beyond the side"});
  Layout twice;
  twice.plane(1).track(0, line, {-8 * mm, -2 * mm}, {8 * mm, -2 * mm}).track(0, line, {-8 * mm, 2 * mm}, {8 * mm, 2 * mm});
  expect_words(refusal(twice, boxed({on_side("W", HullSide::xmin)})), {"is cut 2 times at xmin", "(-4, -2) mm", "(-4, 2) mm"});
}

// ---- coaxial ports ------------------------------------------------------------------------------------------------

const geometry::ArcOptions fine{.sagitta_nm = um};

TEST(CoaxialPorts, AreTheRingBetweenBarrelAndPlane) {
  Layout layout;
  layout.track(0, line, {0, 0}, {5 * mm, 0}, 200 * um)
      .plane_with_hole(1, geometry::circle({0, 0}, mm, fine))
      .via({0, 0}, 600 * um, 0);
  study::Study study;
  study.arcs = fine;
  study.ports = {port("C", {0, 0}, study::PortShape::coaxial)};
  for (const auto mode : {study::ConductorMode::solid, study::ConductorMode::hollow, study::ConductorMode::sheet}) {
    study.conductors = mode;
    SCOPED_TRACE(study::name_of(mode));
    const Made made = meshed(layout, study);
    ASSERT_EQ(made.prisms.ports().size(), 1U);
    const mesh::Port& p = made.prisms.ports()[0];
    EXPECT_EQ(p.kind, mesh::PortKind::coaxial);
    EXPECT_NEAR(p.length_m, 0.7e-3, 3e-6);
    EXPECT_NEAR(p.width_m, 2 * std::numbers::pi * 0.7e-3 / std::log(1 / 0.3), 1e-5);
    EXPECT_EQ(p.negative_net, gnd);
    EXPECT_NEAR(p.at_m[2], mode == study::ConductorMode::sheet ? 0 : 35e-6, 1e-12);
    const mesh::FaceTag& tag = made.tag("port|C");
    EXPECT_TRUE(tag.is_inner);
    EXPECT_EQ(tag.num_quads, 0);
    EXPECT_NEAR(tag.area_m2, std::numbers::pi * (1e-6 - 0.09e-6), 0.02e-6);
  }
}

TEST(CoaxialPorts, EndAtThePadWhereThereIsOne) {
  Layout layout;
  layout.plane_with_hole(1, geometry::circle({0, 0}, mm, fine)).via({0, 0}, 600 * um, mm);
  study::Study study;
  study.arcs = fine;
  study.ports = {port("C", {100 * um, 0}, study::PortShape::coaxial)};
  const Made made = meshed(layout, study);
  EXPECT_NEAR(made.prisms.ports()[0].length_m, 0.5e-3, 3e-6);
}

TEST(CoaxialPorts, WhatIsNoRingIsRefused) {
  const study::Port coaxial = port("C", {0, 0}, study::PortShape::coaxial);
  Layout no_via;
  no_via.plane(1).track(0, line, {-mm, 0}, {mm, 0});
  expect_words(refusal(no_via, coaxial), {"/ports/0", "net 'LINE' has no plated hole at (0, 0) mm"});
  Layout no_plane;
  no_plane.via({0, 0}, 600 * um, mm);
  expect_words(refusal(no_plane, coaxial), {"no round antipad", "on top no copper surrounds the hole", "on bottom"});
  Layout square;
  square.via({0, 0}, 600 * um, mm).plane_with_hole(1, rectangle(-900 * um, -900 * um, 900 * um, 900 * um));
  expect_words(refusal(square, coaxial), {"on bottom the gap is no round ring", "900 to 1273 um"});
  Layout beside;
  beside.via({0, 0}, 600 * um, mm)
      .plane_with_hole(1, geometry::circle({0, 0}, 2 * mm, fine))
      .via({1200 * um, 0}, 300 * um, 0, other);
  expect_words(refusal(beside, coaxial), {"more copper, of net 'OTHER', lies in the antipad"});
  Layout both;
  both.via({0, 0}, 600 * um, 0);
  for (const std::int32_t layer : {0, 1}) both.plane_with_hole(layer, geometry::circle({0, 0}, mm, fine));
  expect_words(refusal(both, coaxial), {"planes surround the hole at (0, 0) mm on top, bottom", "at.layer"});
  study::Port named = coaxial;
  named.at.layer = "bottom";
  EXPECT_EQ(refusal(both, named), "");
  study::Study cut = boxed({coaxial});
  cut.box = geometry::Box{{-500 * um, -4 * mm}, {4 * mm, 4 * mm}};
  cut.ports[0].at.layer = "bottom";
  expect_words(refusal(both, cut), {"its antipad at (0, 0) mm reaches beyond the domain"});
}

// ---- sizes --------------------------------------------------------------------------------------------------------

/// Longest edge of the triangles inside a port's footprint.
double longest_edge_in(const Made& made, std::size_t number) {
  double longest = 0;
  const std::int32_t body = made.model.ports()[number].body;
  for (std::int32_t t = 0; t < made.planar.num_triangles(); ++t) {
    const auto bodies = made.planar.bodies_of_region(made.planar.regions()[static_cast<std::size_t>(t)]);
    if (std::ranges::find(bodies, body) == bodies.end()) continue;
    for (const double squared : made.planar.squared_edges_m2(t)) longest = std::max(longest, std::sqrt(squared));
  }
  return longest;
}

TEST(PortSizes, T6_TwoElementsAcrossAndAlongOrWhatTheStudySays) {
  Layout layout;
  layout.plane(1).track(0, line, {-8 * mm, 0}, {8 * mm, 0});
  layout.pad(0, other, rectangle(-mm, 700 * um, mm, 2 * mm));
  study::Study study;
  study.ports = {port("V", {-4 * mm, 0}), port("G", {0, 0}, study::PortShape::gap)};
  study.ports[1].reference = "OTHER";
  study.ports[1].width = mm;
  Made made = meshed(layout, study);
  EXPECT_LE(longest_edge_in(made, 0), 0.5e-3 * (1 + 1e-9));
  EXPECT_LE(longest_edge_in(made, 1), 0.1e-3 * (1 + 1e-9)) << "half of the gap of 0.2 mm";
  const std::size_t core = 2;
  ASSERT_EQ(made.model.slabs()[core].layer, "core");
  const auto sublayers = [&](std::size_t slab) {
    const auto s = static_cast<std::int32_t>(slab);
    return made.prisms.plan().first_sublayer(s + 1) - made.prisms.plan().first_sublayer(s);
  };
  EXPECT_EQ(sublayers(core), 2);
  EXPECT_EQ(sublayers(core + 1), 1) << "no port stands there";
  EXPECT_GE(made.tag("port|V").num_quads, 4);
  std::vector<mesh::PortMeasure> measured = mesh::measure_ports(made.prisms);
  ASSERT_EQ(measured.size(), 2U);
  EXPECT_EQ(measured[0].least_along, 2);
  EXPECT_GE(measured[0].least_across, 2);
  EXPECT_EQ(measured[0].num_faces, made.tag("port|V").num_quads);
  EXPECT_EQ(measured[0].num_faces, measured[0].least_along * measured[0].least_across) << "equal parts";
  EXPECT_NEAR(measured[0].longest_edge_m, 0.25e-3, 1e-9) << "half of the core's height";
  EXPECT_NEAR(measured[0].worst_aspect, 0.25e-3 * measured[0].least_across / 1e-3, 1e-6);
  EXPECT_GE(measured[1].least_along, 2);
  EXPECT_GE(measured[1].least_across, 10);
  EXPECT_EQ(measured[1].num_faces, made.tag("port|G").num_triangles);
  // A length that the study gives takes the place of the two along, not of those across.
  study.ports[0].max_edge = mm;
  made = meshed(layout, study);
  EXPECT_EQ(sublayers(core), 1);
  EXPECT_EQ(mesh::measure_ports(made.prisms)[0].least_along, 1);
  EXPECT_GE(mesh::measure_ports(made.prisms)[0].least_across, 2);
  study.ports[0].max_edge = 100 * um;
  made = meshed(layout, study);
  EXPECT_LE(longest_edge_in(made, 0), 0.1e-3 * (1 + 1e-9));
  EXPECT_EQ(sublayers(core), 5);
  EXPECT_GE(made.tag("port|V").num_quads, 50);
  measured = mesh::measure_ports(made.prisms);
  EXPECT_EQ(measured[0].least_along, 5);
  EXPECT_GE(measured[0].least_across, 10);
  EXPECT_LE(measured[0].longest_edge_m, 0.1e-3 * (1 + 1e-9));
}

// ---- wrong ports --------------------------------------------------------------------------------------------------

TEST(WrongPorts, OfTheBoardAllInOneRunWithPlaceAndRemedy) {
  Layout layout;
  layout.plane(1).track(0, line, {-8 * mm, 0}, {8 * mm, 0});
  layout.via({6 * mm, 0}, 300 * um, 0, gnd);
  study::Study study = boxed({});
  struct Wrong {
    study::Port port;
    std::initializer_list<const char*> words;
  };
  study::Port not_rectangular = port("gap", {3 * mm, 0}, study::PortShape::gap), twice = port("twice", {0, 100 * um});
  study::Port wide = port("wide", {-2 * mm, 0}), edge = port("edge", {-4 * mm, 0}), no_plane = port("plane", {2 * mm, 0});
  wide.width = 2 * mm;
  edge.at.point = Point{0, 3900 * um};
  no_plane.reference = "OTHER";
  const std::vector<Wrong> wrong{
      {port("first", {0, 0}), {}},
      {twice, {"(0, 0) mm", "share faces with port 'first'", "make them narrower or move one"}},
      {port("outside", {7 * mm, 0}),
       {"(7, 0) mm lies outside the domain, (-4, -4) mm to (4, 4) mm", "move the port or grow the region"}},
      {wide, {"2000 um wide at (-2, 0) mm, leaves the copper of net 'LINE' on top", "make it narrower or move it"}},
      {edge, {"net 'LINE' has no copper at (0, 3.9) mm", "move the port onto it"}},
      {not_rectangular, {"(3, 0) mm on top", "no gap with two straight edges"}},
      {no_plane, {"no reference was found, net 'OTHER' that covers it", "Move the port"}},
      {on_side("hangs", HullSide::ymin), {"net 'LINE' is not cut at ymin (y = -4 mm)", "take a side that cuts the net"}},
      {port("coax", {1 * mm, 0}, study::PortShape::coaxial),
       {"has no plated hole at (1, 0) mm", "give a point on one of its vias"}},
  };
  for (const Wrong& one : wrong) study.ports.push_back(one.port);
  const std::string text = refusal(layout, study);
  for (std::size_t i = 0; i < wrong.size(); ++i) {
    const std::string begins = fmt::format("/ports/{}: port '{}'", i, wrong[i].port.name);
    const std::size_t at = text.find(begins);
    EXPECT_EQ(at != std::string::npos, wrong[i].words.size() > 0) << begins << " in " << text;
    if (at != std::string::npos) expect_words(text.substr(at, text.find("\n", at) - at), wrong[i].words);
  }
}

TEST(WrongPorts, OfTheStudyItselfAllInOneRun) {
  study::Study study;
  study::Port same = port("same", {0, 0}), off = on_side("off", HullSide::xmin), nowhere = port("nowhere", {0, 0}),
              high = port("high", {0, 0});
  same.reference = "LINE";
  off.at.side.reset();
  off.at.point = Point{0, 0};
  nowhere.at.point.reset();
  high.height = mm;
  study::Port coaxial = on_side("coaxial", HullSide::xmin, study::PortKind::lumped);
  coaxial.shape = study::PortShape::coaxial;
  study::Port shaped = on_side("shaped", HullSide::ymin);
  shaped.shape = study::PortShape::gap;
  study::Port zmin = on_side("zmin", HullSide::zmin, study::PortKind::lumped), fine_edge = port("edge", {mm, 0});
  fine_edge.max_edge = 10;
  study.ports = {same, off, nowhere, high, coaxial, shaped, zmin, fine_edge, port("edge", {mm, 0})};
  study.ports[0].impedance_ohm = 0;
  const std::string text = study::text_of(study::faults_of(study));
  expect_words(text, {"/ports/0/reference: port 'same' has both terminals on net 'LINE'", "/ports/0/impedance",
                      "/ports/1/at: wave port 'off' must be on the hull", "/ports/2/at: port 'nowhere' needs one place",
                      "/ports/3/height", "/ports/4/at: coaxial port 'coaxial' needs a via", "/ports/5/shape",
                      "/ports/6/at/side", "/ports/7/max_edge", "/ports/8/name: two ports are called 'edge'",
                      "/ports/8/at: port 'edge' stands where port 'edge'"});
}

/// A cut-out under a line takes its copper away: what a port stood on is gone.
TEST(WrongPorts, OnACutOutOfTheBoard) {
  for (const bool is_drilled : {true, false}) {
    Layout layout;
    layout.plane(1).track(0, line, {-8 * mm, 0}, {8 * mm, 0});
    if (is_drilled)
      layout.hole({0, 0}, 600 * um);
    else
      layout.cutout(geometry::circle({0, 0}, 300 * um, fine));
    study::Study study;
    study.ports = {port("P", {0, 0}), port("Q", {2 * mm, 0})};
    try {
      (void)meshed(layout, study);
      ADD_FAILURE() << "accepted " << is_drilled;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::port_invalid);
      expect_words(error.text(), {"/ports/0", "port 'P'", "(0, 0) mm", "ove"});
      EXPECT_EQ(error.text().find("port 'Q'"), std::string::npos) << error.text();
    }
  }
}

/// What no shape of the layout shows: a barrel without a pad in a gap, a domain that bends away between two ends.
TEST(WrongPorts, WhatBarsAFaceIsNamed) {
  Layout gap;
  gap.pad(0, line, rectangle(-mm, -mm, 0, mm))
      .pad(0, other, rectangle(mm, -mm, 2 * mm, mm))
      .via({500 * um, 300 * um}, 200 * um, 0, gnd);
  study::Port flat = port("F", {-500 * um, 0}, study::PortShape::gap);
  flat.reference = "OTHER";
  expect_words(refusal(gap, flat), {"/ports/0: port 'F' at (0.5, 0) mm is barred near (0.", "copper of net 'GND' stands in it",
                                    "move it or make it narrower"});
  flat.width = 300 * um;
  EXPECT_EQ(refusal(gap, flat), "") << "beside the barrel";
  Layout layout;
  layout.plane(1).track(0, line, {0, -8 * mm}, {0, 8 * mm});
  study::Study study;
  study.region = study::RegionKind::polygon;
  study.polygon = {{-3 * mm, -3 * mm}, {3 * mm, -3 * mm}, {3 * mm, 3 * mm}, {0, -100 * um}, {-3 * mm, 3 * mm}};
  study.ports = {port("V", {0, -200 * um})};
  EXPECT_EQ(refusal(layout, study), "");
  study.ports = {port("V", {0, -90 * um})};
  expect_words(refusal(layout, study), {"port 'V'", "lies outside the domain"});
  Layout tube;
  tube.plane(1).track(0, line, {-8 * mm, 0}, {8 * mm, 0}).cutout(rectangle(-mm, 200 * um, mm, 300 * um));
  expect_words(refusal(tube, port("T", {0, 0})),
               {"port 'T' at (0, 0) mm touches net 'LINE' along 900 um of its 1000 um long edge",
                "near (0, 0.25) mm the board is cut out or ends"});
}

TEST(WrongPorts, AHairFromTheSideOfTheDomain) {
  Layout layout;
  layout.plane(1).track(0, line, {0, -8 * mm}, {0, 8 * mm});
  study::Study study = boxed({port("P", {0, 0})});
  study.box = geometry::Box{{-4 * mm, -4 * mm}, {500 * um + 84, 4 * mm}};
  expect_words(refusal(layout, study),
               {"/ports/0: port 'P' at (0, 0) mm lies 84 nm from the side of the domain at (0.5, 0) mm"});
  study.box->max.x = 500 * um;
  EXPECT_EQ(refusal(layout, study), "") << "up to the side itself";
  study.box->max.x = 502 * um;
  EXPECT_EQ(refusal(layout, study), "");
}

/// What only the mesh can tell: copper of another net crosses the ring, so that faces are missing.
TEST(WrongPorts, CopperInTheWayIsFoundInTheMesh) {
  Layout layout;
  layout.plane(1).track(0, line, {-8 * mm, 0}, {8 * mm, 0});
  study::Study study;
  study.ports = {port("P", {0, 0})};
  const Made made = meshed(layout, study);
  model::ModelParts parts;
  parts.source = "changed";
  parts.materials.assign(made.model.materials().begin(), made.model.materials().end());
  parts.nets.assign(made.model.nets().begin(), made.model.nets().end());
  parts.slabs.assign(made.model.slabs().begin(), made.model.slabs().end());
  parts.bodies.assign(made.model.bodies().begin(), made.model.bodies().end());
  parts.shapes.assign(made.model.shapes().begin(), made.model.shapes().end());
  parts.ports.assign(made.model.ports().begin(), made.model.ports().end());
  parts.ports[0].area_m2 *= 1.01;
  try {
    (void)extrude::extrude(made.planar, made.prisms.plan(), model::Model::from_parts(std::move(parts)), {}, {});
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::port_invalid);
    expect_words(error.text(),
                 {"/ports/0: port 'P' at (0, 0) mm covers 0.5 mm2 where its rectangle has 0.505 mm2", "make it narrower"});
  }
}

}  // namespace
}  // namespace pcbmesh
