// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/extrude/tetrahedral_source.hpp"
#include "pcbmesh/layering/prism_quality.hpp"
#include "pcbmesh/mesh/mesh_data_source.hpp"
#include "pcbmesh/mesh/prism_source.hpp"
#include "pcbmesh/view/cell_render.hpp"
#include "sample_prism_mesh.hpp"
#include "src/view/cell_faces.hpp"

namespace pcbmesh::view {
namespace {

using mesh::MeshData;
using mesh::PrismMesh;

CellMesh cells_of(MeshData data) {
  return {std::make_shared<MeshData>(std::move(data)), 1.0};
}
MeshData prisms_of(const PrismMesh& mesh) {
  mesh::PrismSource source(mesh);
  return mesh::expand(source);
}
MeshData tetrahedra_of(const PrismMesh& mesh) {
  mesh::PrismSource prisms(mesh);
  extrude::TetrahedralSource source(prisms);
  return mesh::expand(source);
}

/// A cube of volume group 1 under a pyramid of group 2 with two tetrahedra of group 2 on one of its sides.
MeshData mixed() {
  MeshData out;
  out.nodes = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0},   {0, 1, 0},   {0, 0, 1},  {1, 0, 1},
               {1, 1, 1}, {0, 1, 1}, {.5, .5, 2}, {.5, -1, 2}, {.5, -1, 1}};
  out.cells.push_back({mesh::CellKind::hexahedron, {0, 1, 2, 3, 4, 5, 6, 7}, {1}});
  out.cells.push_back({mesh::CellKind::pyramid, {4, 5, 6, 7, 8}, {2}});
  out.cells.push_back({mesh::CellKind::tetrahedron, {4, 5, 8, 9, 4, 5, 9, 10}, {2, 2}});
  out.names = {{3, 1, "core|FR4|none"}, {3, 2, "top|copper|GND"}};
  return out;
}

using FaceKey = std::vector<std::int64_t>;
/// Cells of every face, by the faces' corners.
std::map<FaceKey, std::vector<std::int64_t>> cells_by_face(const CellMesh& mesh) {
  std::map<FaceKey, std::vector<std::int64_t>> out;
  for (std::int64_t c = 0; c < mesh.num_cells(); ++c) {
    const CellMesh::Cell cell = mesh.cell(c);
    for (const LocalFace& local : local_faces(cell.kind)) {
      FaceKey key;
      for (int k = 0; k < local.num_corners; ++k)
        key.push_back(cell.corners[static_cast<std::size_t>(local.corners[static_cast<std::size_t>(k)])]);
      std::ranges::sort(key);
      out[key].push_back(c);
    }
  }
  return out;
}

void expect_w1(const CellMesh& mesh) {
  std::map<FaceKey, bool> tagged;
  for (const mesh::FaceBlock& block : mesh.mesh().faces) {
    const auto n = static_cast<std::size_t>(mesh::corners_of(block.kind));
    for (std::size_t i = 0; i < block.tags.size(); ++i) {
      FaceKey key(block.corners.begin() + static_cast<std::ptrdiff_t>(i * n),
                  block.corners.begin() + static_cast<std::ptrdiff_t>((i + 1) * n));
      std::ranges::sort(key);
      tagged[key] = true;
    }
  }
  std::map<FaceKey, int> found;
  for (const CellFace& face : mesh.faces()) {
    FaceKey key(face.nodes.begin(), face.nodes.begin() + face.size());
    std::ranges::sort(key);
    ++found[key];
    EXPECT_EQ(face.tag >= 0, tagged.contains(key));
    EXPECT_EQ(face.group, mesh.group_of(face.cell));
    EXPECT_EQ(face.neighbour_group, face.neighbour < 0 ? -1 : mesh.group_of(face.neighbour));
  }
  for (const auto& [key, owners] : cells_by_face(mesh)) {
    const bool is_seen = owners.size() == 1 || mesh.group_of(owners[0]) != mesh.group_of(owners[1]) || tagged.contains(key);
    EXPECT_EQ(found[key], is_seen ? 1 : 0);
  }
}

double volume_of(const CellMesh& mesh, const Visibility& visibility) {
  double six = 0;
  visit_cell_skin(mesh, visibility, [&](const CellSkinFace& face) {
    for (int i = 1; i + 1 < face.polygon.size; ++i) {
      const auto &p = face.polygon.corners[0], &q = face.polygon.corners[static_cast<std::size_t>(i)],
                 &r = face.polygon.corners[static_cast<std::size_t>(i) + 1];
      six += p[0] * (q[1] * r[2] - q[2] * r[1]) + p[1] * (q[2] * r[0] - q[0] * r[2]) + p[2] * (q[0] * r[1] - q[1] * r[0]);
    }
  });
  return six / 6;
}

class CellsOfSample : public ::testing::Test {
 protected:
  PrismMesh prisms = PrismMesh::from_parts(testing::sample_parts());
};

TEST_F(CellsOfSample, W1_FacesOfOneCellOfTwoGroupsOrTagged) {
  expect_w1(cells_of(prisms_of(prisms)));
  expect_w1(cells_of(tetrahedra_of(prisms)));
  const CellMesh few = cells_of(mixed());
  expect_w1(few);
  EXPECT_EQ(few.faces().size(), 14U);  // of 16 faces two lie inside group 2
}

TEST_F(CellsOfSample, W2_FewFacesAtATimeGiveTheSame) {
  const CellMesh mesh = cells_of(prisms_of(prisms));
  std::vector<CellFaceTag> tags(mesh.face_tags().begin(), mesh.face_tags().end());
  for (const std::int64_t at_once : {1, 7, 100}) {
    const std::vector<CellFace> faces = match_cell_faces(mesh, tags, at_once);
    ASSERT_EQ(faces.size(), mesh.faces().size());
    for (std::size_t i = 0; i < faces.size(); ++i) {
      EXPECT_EQ(faces[i].nodes, mesh.faces()[i].nodes);
      EXPECT_EQ(faces[i].cell, mesh.faces()[i].cell);
      EXPECT_EQ(faces[i].neighbour, mesh.faces()[i].neighbour);
      EXPECT_EQ(faces[i].tag, mesh.faces()[i].tag);
    }
  }
}

TEST_F(CellsOfSample, W3_PrismsLookAsThePrismMeshDoes) {
  const CellMesh mesh = cells_of(prisms_of(prisms));
  ASSERT_EQ(mesh.groups().size(), prisms.volume_tags().size());
  for (const SkinMode mode : {SkinMode::outer, SkinMode::materials, SkinMode::groups, SkinMode::layers}) {
    for (std::size_t hidden = 0; hidden <= mesh.groups().size(); ++hidden) {
      Visibility visibility;
      visibility.mode = mode;
      visibility.hidden_groups.assign(mesh.groups().size(), 0);
      if (hidden < mesh.groups().size()) visibility.hidden_groups[hidden] = 1;
      const SkinCount cells = count_cell_skin(mesh, visibility), implicit = count_skin(prisms, visibility);
      EXPECT_EQ(cells.num_triangles, implicit.num_triangles);
      EXPECT_EQ(cells.num_quads, implicit.num_quads);
    }
  }
  PictureOptions picture;
  picture.width = 320;
  picture.height = 200;
  picture.edges = Edges::off;  // they fade by the size of a wall's cells, which differ in height here
  for (const ColourMode mode : {ColourMode::material, ColourMode::net, ColourMode::layer, ColourMode::prism_quality}) {
    picture.colour = mode;
    EXPECT_TRUE(render_png(mesh, picture) == render_png(prisms, picture)) << name_of(mode);
  }
}

TEST_F(CellsOfSample, TheSkinEnclosesTheCellsCutOrWhole) {
  for (const bool is_split : {false, true}) {
    const CellMesh mesh = cells_of(is_split ? tetrahedra_of(prisms) : prisms_of(prisms));
    double whole = 0;
    for (const CellGroup& g : mesh.groups()) whole += g.volume_m3;
    double exact = 0;
    for (const mesh::VolumeTag& tag : prisms.volume_tags()) exact += tag.volume_m3;
    EXPECT_NEAR(whole, exact, 1e-9 * exact);
    for (const SkinMode mode : {SkinMode::outer, SkinMode::materials, SkinMode::groups, SkinMode::layers}) {
      Visibility visibility;
      visibility.mode = mode;
      EXPECT_NEAR(volume_of(mesh, visibility), whole, 1e-9 * whole);
      for (int axis = 0; axis < 3; ++axis) {
        // Two parts make the whole, and neither is nothing.
        visibility.section = SectionPlane{axis, axis == 2 ? 1.3e-4 : 0.71e-3, false};
        const double below = volume_of(mesh, visibility);
        visibility.section->keep_above = true;
        const double above = volume_of(mesh, visibility);
        EXPECT_NEAR(below + above, whole, 1e-6 * whole) << "axis " << axis;
        EXPECT_GT(std::min(below, above), 0.05 * whole);
      }
      visibility.section.reset();
    }
  }
}

TEST(Cells, OfAnyKindCutAnywhere) {
  const CellMesh mesh = cells_of(mixed());
  double whole = 0;
  for (const CellGroup& g : mesh.groups()) whole += g.volume_m3;
  EXPECT_NEAR(mesh.groups()[0].volume_m3, 1, 1e-12);
  EXPECT_NEAR(volume_of(mesh, {}), whole, 1e-12);
  for (int axis = 0; axis < 3; ++axis)
    for (const double at : {0.3, 0.5, 0.9}) {
      Visibility visibility;
      visibility.section = SectionPlane{axis, at, false};
      const double below = volume_of(mesh, visibility);
      visibility.section->keep_above = true;
      EXPECT_NEAR(below + volume_of(mesh, visibility), whole, 1e-9) << axis << " " << at;
    }
}

TEST(Cells, TurnedInsideOutStillFaceOutwards) {
  MeshData data = mixed();
  std::swap(data.cells[0].corners[1], data.cells[0].corners[3]);  // the cube, mirrored
  std::swap(data.cells[0].corners[5], data.cells[0].corners[7]);
  std::swap(data.cells[2].corners[0], data.cells[2].corners[1]);
  EXPECT_NEAR(volume_of(cells_of(data), {}), volume_of(cells_of(mixed()), {}), 1e-12);
}

TEST(Cells, NamesTellLayersMaterialsAndNets) {
  const CellMesh mesh = cells_of(mixed());
  EXPECT_EQ(std::vector(mesh.layers().begin(), mesh.layers().end()), (std::vector<std::string>{"core", "top"}));
  EXPECT_EQ(std::vector(mesh.nets().begin(), mesh.nets().end()), (std::vector<std::string>{"GND"}));
  ASSERT_EQ(mesh.materials().size(), 2U);
  EXPECT_FALSE(is_conductor(mesh.materials()[0]));
  EXPECT_TRUE(is_conductor(mesh.materials()[1]));
  EXPECT_EQ(mesh.groups()[0].band, 0);
  EXPECT_EQ(mesh.groups()[1].band, 1);
  MeshData data = mixed();
  data.names = {{3, 1, "Volume A"}};
  const CellMesh plain = cells_of(data);
  EXPECT_TRUE(plain.materials().empty());
  EXPECT_EQ(plain.groups()[0].name, "Volume A");
  EXPECT_EQ(plain.groups()[1].name, "volume 2");
  EXPECT_EQ(colour_modes_of(plain).front(), ColourMode::group);
  try {
    static_cast<void>(CellPaint(plain, ColourMode::material));
    FAIL() << "no material is known";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
    EXPECT_NE(std::string(error.what()).find("group, q_p, size"), std::string::npos) << error.what();
  }
}

TEST_F(CellsOfSample, QualityIsThatOfThePrisms) {
  const CellMesh mesh = cells_of(prisms_of(prisms));
  const CellQuality quality = mesh.quality();
  const layering::QualityStatistics exact = layering::quality_statistics(prisms);
  EXPECT_EQ(quality.num_measured, prisms.num_prisms());
  EXPECT_NEAR(quality.mean, exact.mean_prism, 1e-12);
  ASSERT_FALSE(quality.worst.empty());
  EXPECT_NEAR(quality.worst.front().quality, exact.min_prism, 1e-12);
  std::int64_t sum = 0;
  for (const std::int64_t n : quality.histogram.counts) sum += n;
  EXPECT_EQ(sum, prisms.num_prisms());
}

TEST(Cells, MeanRatioIsOneForARegularTetrahedronAndUnknownForCubes) {
  MeshData data;
  data.nodes = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  data.cells.push_back({mesh::CellKind::tetrahedron, {0, 1, 2, 3}, {1}});
  EXPECT_NEAR(cells_of(data).quality_of(0).value(), 1, 1e-12);
  EXPECT_FALSE(cells_of(mixed()).quality_of(0).has_value());
  data.nodes[3] = {-1, 1, -0.9};
  EXPECT_LT(cells_of(data).quality_of(0).value(), 0.4);
}

TEST_F(CellsOfSample, ABoxLeavesTheCellsInside) {
  const auto data = std::make_shared<MeshData>(prisms_of(prisms));
  const std::array<double, 4> box{0, 0, 1e-3, 1.4e-3};
  const CellMesh mesh(data, 1.0, nullptr, box);
  Visibility visibility;
  visibility.box_m = box;
  const SkinCount expected = count_skin(prisms, visibility), found = count_cell_skin(mesh, {});
  EXPECT_EQ(found.num_triangles, expected.num_triangles);
  EXPECT_EQ(found.num_quads, expected.num_quads);
  EXPECT_THROW(CellMesh(data, 1.0, nullptr, std::array{5.0, 5.0, 6.0, 6.0}), Error);
}

TEST(Cells, WhatCannotBeDrawnIsSaid) {
  MeshData data = mixed();
  data.cells[1].corners[4] = 99;
  try {
    static_cast<void>(cells_of(data));
    FAIL() << "node 99 does not exist";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::file_syntax);
    EXPECT_NE(std::string(error.what()).find("node 99"), std::string::npos);
  }
  data.cells.clear();
  EXPECT_THROW(static_cast<void>(cells_of(data)), Error);
}

}  // namespace
}  // namespace pcbmesh::view
