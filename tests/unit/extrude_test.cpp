// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/extrude/extrude.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "explicit_mesh.hpp"
#include "pcbmesh/base/error.hpp"

namespace pcbmesh::extrude {
namespace {

using mesh::FaceTagKind;
using mesh::PrismMesh;
using testing::boundary_faces;
using testing::even_plan;
using testing::faces_of;
using testing::grid;
using testing::spell_out;
using testing::turned;

constexpr std::int32_t air = 0, fr4 = 1, copper = 2;

/// Five slabs of 1 um: air, bottom copper, core, top copper, air; bodies 0 domain and 1 board.
model::ModelParts five_slabs(std::int32_t outside = air) {
  model::ModelParts parts;
  parts.materials = {{"air"}, {"FR4"}, {"copper"}};
  parts.nets = {"GND", "VCC"};
  const std::vector<std::tuple<const char*, model::SlabKind, std::int32_t>> slabs{{"air below", model::SlabKind::air, air},
                                                                                  {"B.Cu", model::SlabKind::copper, air},
                                                                                  {"core", model::SlabKind::dielectric, fr4},
                                                                                  {"F.Cu", model::SlabKind::copper, air},
                                                                                  {"air above", model::SlabKind::air, air}};
  for (const auto& [name, kind, material] : slabs) {
    const auto z = static_cast<Nm>(parts.slabs.size()) * nm_per_um;
    parts.slabs.push_back({name, kind, z, z + nm_per_um, material, outside});
  }
  parts.bodies = {{"domain", model::BodyKind::domain, -1, board::no_net, 0, 4},
                  {"board", model::BodyKind::board, -1, board::no_net, 0, 4}};
  return parts;
}

std::int32_t add_body(model::ModelParts& parts, model::BodyKind kind, std::int32_t material, std::int32_t net,
                      std::int32_t first, std::int32_t last, std::int32_t priority, bool hollow = false) {
  parts.bodies.push_back({"body", kind, material, net, first, last, priority, hollow});
  return static_cast<std::int32_t>(parts.bodies.size()) - 1;
}

PrismMesh make(const mesh::PlanarMesh& planar, const model::ModelParts& parts,
               const std::vector<int>& sublayers = {2, 1, 3, 1, 2}) {
  return extrude(planar, even_plan(sublayers, 1e-6), model::Model::from_parts(parts), {}, {});
}

std::vector<std::string> names_of(std::span<const mesh::VolumeTag> tags) {
  std::vector<std::string> names;
  for (const auto& tag : tags) names.push_back(tag.name);
  return names;
}

std::vector<std::string> names_of(std::span<const mesh::FaceTag> tags) {
  std::vector<std::string> names;
  for (const auto& tag : tags) names.push_back(tag.name);
  return names;
}

std::vector<std::array<std::int64_t, 6>> prisms_of(const PrismMesh& mesh) {
  std::vector<std::array<std::int64_t, 6>> prisms(static_cast<std::size_t>(mesh.num_prisms()));
  mesh.fill_prisms(0, prisms);
  return prisms;
}

/// Every face with one prism is in exactly one of caps and walls, outward; every other face has two prisms, opposed.
void expect_closed(const PrismMesh& mesh) {
  std::multiset<std::vector<std::int64_t>> expected, found;
  for (const auto& [nodes, uses] : faces_of(prisms_of(mesh))) {
    ASSERT_LE(uses.size(), 2U);
    if (uses.size() == 1) {
      expected.insert(turned(uses[0]));
    } else {
      auto reversed = uses[1];
      std::reverse(reversed.begin(), reversed.end());
      ASSERT_EQ(turned(uses[0]), turned(reversed));
    }
  }
  for (const auto& face : boundary_faces(mesh)) found.insert(turned(face));
  ASSERT_EQ(found, expected);
}

/// Cells of dimension 0, 1, 2, 3 with alternating signs: 1 for a ball, 0 for a ring, 2 for a shell.
std::int64_t euler_number(const PrismMesh& mesh) {
  const auto prisms = prisms_of(mesh);
  std::set<std::pair<std::int64_t, std::int64_t>> edges;
  const auto faces = faces_of(prisms);
  for (const auto& [nodes, uses] : faces) {
    for (std::size_t i = 0; i < uses[0].size(); ++i) edges.insert(std::minmax(uses[0][i], uses[0][(i + 1) % uses[0].size()]));
  }
  return mesh.num_nodes() - static_cast<std::int64_t>(edges.size()) + static_cast<std::int64_t>(faces.size()) -
         mesh.num_prisms();
}

/// Sums of volume tags and face tags against the mesh itself.
void expect_measured(const PrismMesh& mesh) {
  std::vector<std::int64_t> prisms(mesh.volume_tags().size(), 0), triangles(mesh.face_tags().size(), 0), quads = triangles;
  std::vector<double> volumes(prisms.size(), 0), areas(triangles.size(), 0);
  for (std::int32_t k = 0; k < mesh.plan().num_sublayers(); ++k) {
    for (std::int32_t t = 0; t < mesh.planar().num_triangles(); ++t) {
      const std::int32_t tag = mesh.tag_of(mesh.plan().slab_of_sublayer()[static_cast<std::size_t>(k)], t);
      if (tag < 0) continue;
      ++prisms[static_cast<std::size_t>(tag)];
      volumes[static_cast<std::size_t>(tag)] += mesh.planar().area_m2(t) * mesh.plan().height_m(k);
    }
  }
  for (const auto& cap : mesh.caps()) {
    ++triangles[static_cast<std::size_t>(cap.tag)];
    areas[static_cast<std::size_t>(cap.tag)] += mesh.planar().area_m2(cap.triangle);
  }
  for (const auto& wall : mesh.walls()) {
    const auto &p = mesh.planar().points_m()[static_cast<std::size_t>(wall.a)],
               &q = mesh.planar().points_m()[static_cast<std::size_t>(wall.b)];
    for (std::int32_t k = mesh.plan().first_sublayer(wall.slab); k < mesh.plan().first_sublayer(wall.slab + 1); ++k) {
      ++quads[static_cast<std::size_t>(wall.tag)];
      areas[static_cast<std::size_t>(wall.tag)] += std::hypot(p[0] - q[0], p[1] - q[1]) * mesh.plan().height_m(k);
    }
  }
  for (std::size_t i = 0; i < prisms.size(); ++i) {
    EXPECT_GT(prisms[i], 0);
    EXPECT_EQ(mesh.volume_tags()[i].num_prisms, prisms[i]);
    EXPECT_NEAR(mesh.volume_tags()[i].volume_m3, volumes[i], 1e-9 * volumes[i]);
  }
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    EXPECT_GT(triangles[i] + quads[i], 0);
    EXPECT_EQ(mesh.face_tags()[i].num_triangles, triangles[i]);
    EXPECT_EQ(mesh.face_tags()[i].num_quads, quads[i]);
    EXPECT_NEAR(mesh.face_tags()[i].area_m2, areas[i], 1e-9 * areas[i]);
  }
}

/// 6 x 6 squares of 1 um; region 1 is the 2 x 2 block in the middle.
mesh::PlanarMesh middle_block(std::vector<std::int32_t> around, std::vector<std::int32_t> middle) {
  return grid(6, 6, 1e-6, 1e-6, [](int i, int j) { return i / 2 == 1 && j / 2 == 1 ? 1 : 0; },
              {std::move(around), std::move(middle)});
}

TEST(Extrude, SolidBoxHasSixSidesAndAllItsVolume) {
  model::ModelParts parts = five_slabs();
  const std::int32_t pad = add_body(parts, model::BodyKind::copper, copper, 1, 3, 3, 1);
  const PrismMesh mesh = make(middle_block({0, 1}, {0, 1, pad}), parts);
  EXPECT_EQ(names_of(mesh.volume_tags()), (std::vector<std::string>{"air below|air|none", "B.Cu|air|none", "core|FR4|none",
                                                                    "F.Cu|air|none", "F.Cu|copper|VCC", "air above|air|none"}));
  EXPECT_EQ(names_of(mesh.face_tags()), (std::vector<std::string>{"zmin", "zmax", "xmin", "xmax", "ymin", "ymax"}));
  EXPECT_EQ(mesh.num_prisms(), 72 * 9);
  double volume = 0;
  for (const auto& tag : mesh.volume_tags()) volume += tag.volume_m3;
  EXPECT_NEAR(volume, 36e-12 * 9e-6, 1e-9 * 36e-12 * 9e-6);
  EXPECT_NEAR(mesh.volume_tags()[4].volume_m3, 4e-12 * 1e-6, 1e-9 * 4e-18);
  for (const auto& tag : mesh.face_tags()) {
    EXPECT_EQ(tag.kind, FaceTagKind::outer);
    EXPECT_NEAR(tag.area_m2, tag.id <= 2 ? 36e-12 : 54e-12, 1e-20);
  }
  expect_measured(mesh);
  expect_closed(mesh);
  EXPECT_EQ(euler_number(mesh), 1);
}

TEST(Extrude, HollowBlockInTheMiddleIsAClosedCavity) {
  model::ModelParts parts = five_slabs();
  const std::int32_t block = add_body(parts, model::BodyKind::barrel, copper, 0, 1, 3, 1, true);
  const PrismMesh mesh = make(middle_block({0, 1}, {0, 1, block}), parts);
  EXPECT_EQ(mesh.num_prisms(), 72 * 9 - 8 * 5);
  EXPECT_EQ(names_of(mesh.face_tags()),
            (std::vector<std::string>{"zmin", "zmax", "xmin", "xmax", "ymin", "ymax", "surface|GND"}));
  const mesh::FaceTag& skin = mesh.face_tags()[6];
  EXPECT_EQ(skin.kind, FaceTagKind::conductor);
  EXPECT_EQ(skin.net, 0);
  EXPECT_EQ(skin.num_triangles, 16);
  EXPECT_EQ(skin.num_quads, 8 * 5);
  EXPECT_NEAR(skin.area_m2, 2 * 4e-12 + 8e-6 * 5e-6, 1e-20);
  expect_measured(mesh);
  expect_closed(mesh);
  EXPECT_EQ(euler_number(mesh), 2);
  // The vertex in the very middle of the block exists above and below it only.
  const std::int32_t centre = 3 * 7 + 3;
  EXPECT_TRUE(mesh.has_node(2, centre));
  EXPECT_FALSE(mesh.has_node(4, centre));
  EXPECT_TRUE(mesh.has_node(7, centre));
}

TEST(Extrude, SkinOfThroughHoleConductorReachesNoBoxSide) {
  model::ModelParts parts = five_slabs();
  const std::int32_t rod = add_body(parts, model::BodyKind::barrel, copper, board::no_net, 0, 4, 1, true);
  const PrismMesh mesh = make(middle_block({0, 1}, {0, 1, rod}), parts);
  EXPECT_EQ(mesh.face_tags().back().name, "surface|none");
  EXPECT_EQ(mesh.face_tags().back().num_triangles, 0);
  EXPECT_EQ(mesh.face_tags().back().num_quads, 8 * 9);
  expect_closed(mesh);
  EXPECT_EQ(euler_number(mesh), 0);
}

TEST(Extrude, VoidHoleGivesSideAndItsFloorToo) {
  model::ModelParts parts = five_slabs();
  const std::int32_t hole = add_body(parts, model::BodyKind::hole, -1, board::no_net, 2, 4, 9);
  const PrismMesh mesh = make(middle_block({0, 1}, {0, 1, hole}), parts);
  EXPECT_EQ(names_of(mesh.face_tags()), (std::vector<std::string>{"zmin", "zmax", "xmin", "xmax", "ymin", "ymax", "side"}));
  EXPECT_EQ(mesh.face_tags()[6].num_triangles, 8);  // the floor of the blind hole
  EXPECT_EQ(mesh.face_tags()[6].num_quads, 8 * 6);
  EXPECT_EQ(mesh.face_tags()[6].kind, FaceTagKind::outer);
  expect_measured(mesh);
  expect_closed(mesh);
}

TEST(Extrude, BoxIsThatOfTheMeshedPart) {
  // Outside the board nothing is meshed: the middle block alone is the mesh, and the box is its box.
  const PrismMesh mesh = make(middle_block({0}, {0, 1}), five_slabs(-1));
  EXPECT_EQ(mesh.num_prisms(), 8 * 9);
  EXPECT_EQ(names_of(mesh.face_tags()), (std::vector<std::string>{"zmin", "zmax", "xmin", "xmax", "ymin", "ymax"}));
  expect_closed(mesh);
  // With the top slab void everywhere, zmax is the top of what is left.
  model::ModelParts parts = five_slabs(-1);
  const std::int32_t lid = add_body(parts, model::BodyKind::hole, -1, board::no_net, 4, 4, 9);
  const PrismMesh open = make(middle_block({0, 1, lid}, {0, 1, lid}), parts);
  EXPECT_EQ(names_of(open.face_tags()), (std::vector<std::string>{"zmin", "zmax", "xmin", "xmax", "ymin", "ymax"}));
  expect_closed(open);
}

TEST(Extrude, WallsOfALShapeAwayFromTheBoxAreSide) {
  const auto planar = grid(6, 6, 1e-6, 1e-6, [](int i, int j) { return i >= 3 && j >= 3 ? 1 : 0; }, {{0, 1}, {0}});
  const PrismMesh mesh = make(planar, five_slabs(-1), {1, 1, 1, 1, 1});
  EXPECT_EQ(names_of(mesh.face_tags()), (std::vector<std::string>{"zmin", "zmax", "xmin", "xmax", "ymin", "ymax", "side"}));
  EXPECT_EQ(mesh.face_tags()[3].num_quads, 3 * 5);  // xmax
  EXPECT_EQ(mesh.face_tags()[6].num_quads, 6 * 5);
  expect_closed(mesh);
}

TEST(Extrude, HollowConductorAtTheBoxSideIsNoBoxSide) {
  // A hollow strip along xmin in F.Cu: its own outer wall is absent, its inner wall is surface, not xmin.
  model::ModelParts parts = five_slabs();
  const std::int32_t strip = add_body(parts, model::BodyKind::copper, copper, 1, 3, 3, 1, true);
  const auto planar = grid(6, 6, 1e-6, 1e-6, [](int i, int) { return i == 0 ? 1 : 0; }, {{0, 1}, {0, 1, strip}});
  const PrismMesh mesh = make(planar, parts, {1, 1, 1, 1, 1});
  const auto& tags = mesh.face_tags();
  EXPECT_EQ(tags[2].name, "xmin");
  EXPECT_EQ(tags[2].num_quads, 6 * 4);
  EXPECT_EQ(tags.back().name, "surface|VCC");
  EXPECT_EQ(tags.back().num_quads, 6);
  EXPECT_EQ(tags.back().num_triangles, 2 * 12);
  expect_closed(mesh);
}

TEST(Extrude, OutwardNormalsPointAwayFromThePrisms) {
  model::ModelParts parts = five_slabs();
  const std::int32_t block = add_body(parts, model::BodyKind::barrel, copper, 0, 1, 3, 1, true);
  const PrismMesh mesh = make(middle_block({0, 1}, {0, 1, block}), parts);
  std::vector<std::array<double, 3>> nodes(static_cast<std::size_t>(mesh.num_nodes()));
  mesh.fill_nodes(0, nodes);
  // Divergence theorem: the flux of (x, y, z) through the outward boundary is three times the volume.
  double flux = 0, volume = 0;
  for (auto face : boundary_faces(mesh)) {
    const auto at = [&](std::size_t i) { return nodes[static_cast<std::size_t>(face[i])]; };
    for (std::size_t i = 1; i + 1 < face.size(); ++i) {
      const auto p = at(0), q = at(i), r = at(i + 1);
      flux +=
          0.5 * (p[0] * (q[1] * r[2] - q[2] * r[1]) + p[1] * (q[2] * r[0] - q[0] * r[2]) + p[2] * (q[0] * r[1] - q[1] * r[0]));
    }
  }
  for (const auto& tag : mesh.volume_tags()) volume += tag.volume_m3;
  EXPECT_NEAR(flux, 3 * volume, 1e-9 * volume);
  for (const auto& wall : mesh.walls()) {
    if (mesh.face_tags()[static_cast<std::size_t>(wall.tag)].name != "xmin") continue;
    EXPECT_GT(mesh.planar().points_m()[static_cast<std::size_t>(wall.a)][1],
              mesh.planar().points_m()[static_cast<std::size_t>(wall.b)][1]);  // meshed side to the left
  }
  for (const auto& cap : mesh.caps()) {
    const auto& tag = mesh.face_tags()[static_cast<std::size_t>(cap.tag)];
    // The skin's caps: the air below looks up at the block, the air above looks down on it.
    const bool looks_up = tag.name == "zmax" || (tag.name == "surface|GND" && cap.level == 2);
    EXPECT_EQ(cap.up, looks_up) << tag.name;
  }
}

/// 9 regions of 2 x 2 squares, random bodies of every kind on random slabs.
PrismMesh random_mesh(unsigned seed) {
  std::mt19937 random(seed);
  const auto pick = [&](int count) { return static_cast<std::int32_t>(random() % static_cast<unsigned>(count)); };
  model::ModelParts parts = five_slabs(pick(2) == 0 ? -1 : air);
  for (int i = 0; i < 8; ++i) {
    const std::int32_t first = pick(5), last = first + pick(5 - first);
    if (pick(3) == 0) {
      add_body(parts, model::BodyKind::hole, pick(2) == 0 ? -1 : air, board::no_net, first, last, 5);
    } else {
      add_body(parts, model::BodyKind::copper, copper, pick(3) - 1, first, last, 1 + pick(4), pick(2) == 0);
    }
  }
  std::vector<std::vector<std::int32_t>> bodies(9);
  for (auto& present : bodies) {
    if (pick(8) != 0) present.push_back(0);
    if (!present.empty() && pick(6) != 0) present.push_back(1);
    for (std::int32_t body = 2; body < 10; ++body) {
      if (pick(3) == 0) present.push_back(body);
    }
  }
  return make(grid(
                  6, 6, 1e-6, 2e-6, [](int i, int j) { return i / 2 + 3 * (j / 2); }, bodies, seed),
              parts);
}

TEST(Extrude, E1_EveryBoundaryFaceHasExactlyOneTag) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    const PrismMesh mesh = random_mesh(seed);
    expect_closed(mesh);
    expect_measured(mesh);
    if (HasFailure()) return;
  }
}

TEST(Extrude, RandomModelsGiveTheMeshSpeltOut) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    const PrismMesh mesh = random_mesh(seed);
    std::vector<std::int32_t> column_tags(45, -1);
    for (std::int32_t t = 0; t < mesh.planar().num_triangles(); ++t) {
      const auto region = static_cast<std::size_t>(mesh.planar().regions()[static_cast<std::size_t>(t)]);
      for (std::int32_t slab = 0; slab < 5; ++slab)
        column_tags[region * 5 + static_cast<std::size_t>(slab)] = mesh.tag_of(slab, t);
    }
    const auto expected = spell_out(mesh.planar(), mesh.plan(), column_tags);
    ASSERT_EQ(prisms_of(mesh), expected.prisms);
    ASSERT_EQ(mesh.num_nodes(), static_cast<std::int64_t>(expected.nodes.size()));
  }
}

TEST(Extrude, E2_FaceTagsAreOuterOrConductor) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    const PrismMesh mesh = random_mesh(seed);
    for (const auto& tag : mesh.face_tags()) {
      EXPECT_EQ(tag.name.starts_with("surface|"), tag.kind == FaceTagKind::conductor);
      EXPECT_TRUE(tag.kind == FaceTagKind::conductor || tag.net == -1);
    }
  }
}

TEST(Extrude, LabelsAreThoseOfTheModel) {
  // Priorities: the hole wins over the pad, the barrel over both.
  model::ModelParts parts = five_slabs();
  const std::int32_t pad = add_body(parts, model::BodyKind::copper, copper, 0, 3, 3, 1);
  const std::int32_t hole = add_body(parts, model::BodyKind::hole, air, board::no_net, 1, 3, 5);
  const PrismMesh mesh = make(middle_block({0, 1, pad}, {0, 1, pad, hole}), parts);
  const auto name = [&](std::int32_t slab, std::int32_t triangle) {
    return mesh.volume_tags()[static_cast<std::size_t>(mesh.tag_of(slab, triangle))].name;
  };
  const std::int32_t middle = 2 * (2 * 6 + 2);
  EXPECT_EQ(name(3, 0), "F.Cu|copper|GND");
  EXPECT_EQ(name(3, middle), "F.Cu|air|none");
  EXPECT_EQ(name(2, middle), "core|air|none");
  EXPECT_EQ(name(2, 0), "core|FR4|none");
}

TEST(Extrude, RepeatedLayerAndMaterialNamesStayApart) {
  model::ModelParts parts = five_slabs();
  parts.slabs[0].layer = parts.slabs[4].layer = "air";
  parts.slabs[1].layer = parts.slabs[3].layer = "Cu";
  parts.slabs[2].layer = "air #2";
  parts.materials[1].name = "air";
  const PrismMesh mesh = make(middle_block({0, 1}, {0, 1}), parts);
  EXPECT_EQ(names_of(mesh.volume_tags()), (std::vector<std::string>{"air|air|none", "Cu|air|none", "air #2|air #2|none",
                                                                    "Cu #2|air|none", "air #3|air|none"}));
}

TEST(Extrude, AdjacentSlabsOfOneLayerShareItsTag) {
  model::ModelParts parts = five_slabs();
  parts.slabs[2].layer = parts.slabs[3].layer = "core";
  parts.slabs[3].kind = model::SlabKind::dielectric;
  parts.slabs[3].material = fr4;
  const PrismMesh mesh = make(middle_block({0, 1}, {0, 1}), parts);
  EXPECT_EQ(mesh.layers().size(), 4U);
  EXPECT_EQ(mesh.volume_tags()[2].name, "core|FR4|none");
  EXPECT_EQ(mesh.volume_tags()[2].num_prisms, 72 * 4);
  expect_closed(mesh);
}

TEST(Extrude, TagNamesSplitAtBarsWhateverTheNetsAreCalled) {
  model::ModelParts parts = five_slabs();
  parts.nets = {"a|b", "none"};
  const std::int32_t first = add_body(parts, model::BodyKind::copper, copper, 0, 3, 3, 1);
  const std::int32_t second = add_body(parts, model::BodyKind::copper, copper, 1, 3, 3, 1, true);
  const PrismMesh mesh = make(middle_block({0, 1, first}, {0, 1, second}), parts);
  EXPECT_EQ(mesh.volume_tags()[3].name, "F.Cu|copper|a%7Cb");
  EXPECT_EQ(mesh.face_tags().back().name, "surface|%6Eone");
}

TEST(Extrude, EscapedNamesComeBack) {
  for (const char* name :
       {"", "GND", "a|b", "100%", "%7C", "none", "none2", "\"quoted\"", "tab\tline\n", "/sub/~{RESET}", "\xc3\xa9"}) {
    const std::string part = escape_tag_part(name);
    EXPECT_EQ(unescape_tag_part(part), name);
    EXPECT_EQ(part.find_first_of("|\"\t\n"), std::string::npos);
    EXPECT_NE(part, "none");
  }
  EXPECT_EQ(unescape_tag_part("50%"), "50%");
  EXPECT_EQ(unescape_tag_part("%zz%4"), "%zz%4");
}

TEST(Extrude, HandsOnWhatTheLayoutKnows) {
  const std::vector<std::int32_t> pieces{2, 1};
  const std::vector<std::array<std::int32_t, 2>> touching{{0, 1}};
  const auto planar = middle_block({0, 1}, {0, 1});
  const auto model = model::Model::from_parts(five_slabs());
  const PrismMesh mesh = extrude(planar, even_plan({1, 1, 1, 1, 1}, 1e-6), model, pieces, touching);
  EXPECT_EQ(mesh.net_pieces()[0], 2);
  EXPECT_EQ(mesh.touching_nets()[0], (std::array<std::int32_t, 2>{0, 1}));
  EXPECT_THROW(std::ignore = extrude(planar, even_plan({1, 1}, 1e-6), model, {}, {}), Error);
  EXPECT_THROW(std::ignore = extrude(planar, even_plan({1, 1, 1, 1, 1}, 1e-6), model, std::vector<std::int32_t>{1}, {}), Error);
}

}  // namespace
}  // namespace pcbmesh::extrude
