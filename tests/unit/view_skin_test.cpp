// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "pcbmesh/view/paint.hpp"
#include "pcbmesh/view/skin.hpp"
#include "sample_prism_mesh.hpp"

namespace pcbmesh::view {
namespace {

using mesh::PrismMesh;

/// Faces of the prisms spelt out: those used by exactly one prism of a class, summed over the classes. -1 = not shown.
template <class ClassOf>
SkinCount count_by_faces(const PrismMesh& mesh, ClassOf&& class_of) {
  std::vector<std::array<std::int64_t, 6>> prisms(static_cast<std::size_t>(mesh.num_prisms()));
  std::vector<std::int32_t> tags(prisms.size());
  mesh.fill_prisms(0, prisms, tags);
  std::map<std::pair<std::int32_t, std::vector<std::int64_t>>, int> uses;
  for (std::size_t i = 0; i < prisms.size(); ++i) {
    std::int32_t sublayer = 0;
    while (mesh.first_prism_of_sublayer(sublayer) + mesh.num_prisms_of_sublayer(sublayer) <= static_cast<std::int64_t>(i))
      ++sublayer;
    const std::int32_t cls = class_of(tags[i], mesh.plan().slab_of_sublayer()[static_cast<std::size_t>(sublayer)]);
    if (cls < 0) continue;
    const auto& p = prisms[i];
    for (std::vector<std::int64_t> face : {std::vector{p[0], p[1], p[2]},
                                           {p[3], p[4], p[5]},
                                           {p[0], p[1], p[4], p[3]},
                                           {p[1], p[2], p[5], p[4]},
                                           {p[2], p[0], p[3], p[5]}}) {
      std::ranges::sort(face);
      ++uses[{cls, face}];
    }
  }
  SkinCount count;
  for (const auto& [key, n] : uses) {
    if (n != 1) continue;
    ++(key.second.size() == 3 ? count.num_triangles : count.num_quads);
  }
  return count;
}

void expect_same(const SkinCount& a, const SkinCount& b) {
  EXPECT_EQ(a.num_triangles, b.num_triangles);
  EXPECT_EQ(a.num_quads, b.num_quads);
}

class SkinOfSample : public ::testing::Test {
 protected:
  PrismMesh mesh = PrismMesh::from_parts(testing::sample_parts());
};

TEST_F(SkinOfSample, V1_OuterFacesAreThoseUsedByOnePrism) {
  expect_same(count_skin(mesh, {}), count_by_faces(mesh, [](std::int32_t, std::int32_t) { return 0; }));
}

TEST_F(SkinOfSample, V2_EveryMaterialGroupAndLayerIsClosed) {
  Visibility visibility;
  visibility.mode = SkinMode::materials;
  expect_same(count_skin(mesh, visibility), count_by_faces(mesh, [&](std::int32_t tag, std::int32_t) {
                return mesh.volume_tags()[static_cast<std::size_t>(tag)].material;
              }));
  visibility.mode = SkinMode::groups;
  expect_same(count_skin(mesh, visibility), count_by_faces(mesh, [](std::int32_t tag, std::int32_t) { return tag; }));
  visibility.mode = SkinMode::layers;
  expect_same(count_skin(mesh, visibility), count_by_faces(mesh, [&](std::int32_t tag, std::int32_t) {
                return mesh.volume_tags()[static_cast<std::size_t>(tag)].layer;
              }));
}

TEST_F(SkinOfSample, HiddenGroupsLayOpenWhatTheyCovered) {
  Visibility visibility;
  for (std::size_t hidden = 0; hidden < mesh.volume_tags().size(); ++hidden) {
    visibility.hidden_groups.assign(mesh.volume_tags().size(), 0);
    visibility.hidden_groups[hidden] = 1;
    expect_same(count_skin(mesh, visibility), count_by_faces(mesh, [&](std::int32_t tag, std::int32_t) {
                  return tag == static_cast<std::int32_t>(hidden) ? -1 : 0;
                }));
  }
}

/// Volume inside a closed skin by the divergence theorem: right only if every face is there once and faces outwards.
double volume_of(const PrismMesh& mesh, const Visibility& visibility) {
  double six = 0;
  visit_skin(mesh, visibility, [&](std::span<const SkinFace> faces) {
    for (const SkinFace& face : faces) {
      const SkinPolygon polygon = polygon_of(mesh, visibility, face);
      for (int i = 1; i + 1 < polygon.size; ++i) {
        const auto &p = polygon.corners[0], &q = polygon.corners[static_cast<std::size_t>(i)],
                   &r = polygon.corners[static_cast<std::size_t>(i) + 1];
        six += p[0] * (q[1] * r[2] - q[2] * r[1]) + p[1] * (q[2] * r[0] - q[0] * r[2]) + p[2] * (q[0] * r[1] - q[1] * r[0]);
      }
    }
  });
  return six / 6;
}

TEST_F(SkinOfSample, EnclosesTheVolumeOfItsCells) {
  double whole = 0;
  for (const mesh::VolumeTag& tag : mesh.volume_tags()) whole += tag.volume_m3;
  for (const SkinMode mode : {SkinMode::outer, SkinMode::materials, SkinMode::groups, SkinMode::layers}) {
    Visibility visibility;
    visibility.mode = mode;
    EXPECT_NEAR(volume_of(mesh, visibility), whole, 1e-9 * whole);
  }
}

TEST(Skin, SectionClosesTheCut) {
  // One block 3 x 2 x 0.4 mm, cut at a share of each side, off the grid lines and on them.
  const PrismMesh mesh = PrismMesh::from_parts(testing::plain_parts(3, 2, 4));
  const double whole = mesh.volume_tags()[0].volume_m3;
  const std::array<double, 3> sides{3e-3, 2e-3, 4e-4};
  constexpr double tolerance = 1e-6;  // the plane is moved by a fraction of a nanometre, away from corners
  for (int axis = 0; axis < 3; ++axis) {
    for (const double share : {0.17, 0.5, 0.71}) {
      Visibility visibility;
      visibility.section = SectionPlane{axis, share * sides[static_cast<std::size_t>(axis)], false};
      EXPECT_NEAR(volume_of(mesh, visibility), share * whole, tolerance * whole) << "axis " << axis << " at " << share;
      visibility.section->keep_above = true;
      EXPECT_NEAR(volume_of(mesh, visibility), (1 - share) * whole, tolerance * whole) << "axis " << axis << " at " << share;
    }
  }
}

TEST_F(SkinOfSample, BoxLeavesTheTrianglesInsideAndClosesThem) {
  Visibility visibility;
  visibility.box_m = {0, 0, 1e-3, 1.4e-3};  // the squares of the first three columns and two rows
  double inside = 0;
  for (std::int32_t t = 0; t < mesh.planar().num_triangles(); ++t) {
    double x = 0, y = 0;
    for (const std::int32_t v : mesh.planar().triangles()[static_cast<std::size_t>(t)]) {
      x += mesh.planar().points_m()[static_cast<std::size_t>(v)][0] / 3;
      y += mesh.planar().points_m()[static_cast<std::size_t>(v)][1] / 3;
    }
    for (std::int32_t s = 0; s < 3 && x < 1e-3 && y < 1.4e-3; ++s)
      if (mesh.tag_of(s, t) >= 0) inside += mesh.planar().area_m2(t) * (slab_z_m(mesh, s)[1] - slab_z_m(mesh, s)[0]);
  }
  ASSERT_GT(inside, 0);
  EXPECT_NEAR(volume_of(mesh, visibility), inside, 1e-9 * inside);
}

TEST_F(SkinOfSample, V3_FacesComeInTheSameOrderEveryTime) {
  const auto all = [&] {
    std::vector<std::array<std::int32_t, 7>> out;
    visit_skin(mesh, {}, [&](std::span<const SkinFace> faces) {
      for (const SkinFace& f : faces)
        out.push_back({static_cast<std::int32_t>(f.kind), f.slab, f.triangle, f.a, f.b, f.group, f.neighbour});
    });
    return out;
  };
  EXPECT_EQ(all(), all());
  EXPECT_FALSE(all().empty());
}

TEST_F(SkinOfSample, EveryOuterFaceHasItsFaceTag) {
  const BoundaryTags tags(mesh);
  std::vector<std::int64_t> triangles(mesh.face_tags().size(), 0), quads(mesh.face_tags().size(), 0);
  visit_skin(mesh, {}, [&](std::span<const SkinFace> faces) {
    for (const SkinFace& face : faces) {
      const std::int32_t tag = tags.of(face);
      ASSERT_GE(tag, 0);
      if (face.kind == SkinFaceKind::wall)
        quads[static_cast<std::size_t>(tag)] +=
            mesh.plan().first_sublayer(face.slab + 1) - mesh.plan().first_sublayer(face.slab);
      else
        ++triangles[static_cast<std::size_t>(tag)];
    }
  });
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    EXPECT_EQ(triangles[i], mesh.face_tags()[i].num_triangles);
    EXPECT_EQ(quads[i], mesh.face_tags()[i].num_quads);
  }
}

TEST_F(SkinOfSample, AirIsWhatHasNoLossAndNoNet) {
  EXPECT_EQ(air_groups(mesh), (std::vector<char>{0, 0, 0, 0, 1}));
}

}  // namespace
}  // namespace pcbmesh::view
