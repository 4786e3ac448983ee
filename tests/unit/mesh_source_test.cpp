// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/mesh/prism_source.hpp"
#include "sample_prism_mesh.hpp"

namespace pcbmesh::mesh {
namespace {

std::vector<std::int64_t> nodes_of_block(MeshSource& source, std::size_t block) {
  std::vector<std::int64_t> out;
  source.visit(block, [&](std::span<const std::int64_t> rows) { out.insert(out.end(), rows.begin(), rows.end()); });
  return out;
}

std::vector<double> values_of_block(MeshSource& source, std::size_t block, CellField field) {
  std::vector<double> out;
  source.visit_field(block, field,
                     [&](std::span<const double> values) { out.insert(out.end(), values.begin(), values.end()); });
  return out;
}

TEST(PrismSource, ASmallCacheOfSlabsGivesTheSameElements) {
  const PrismMesh mesh = PrismMesh::from_parts(testing::sample_parts());
  const auto all = [&](std::size_t cache_bytes) {
    PrismSource source(mesh, {}, cache_bytes);
    std::vector<std::int64_t> out;
    for (int pass = 0; pass < 2; ++pass)
      for (std::size_t block = source.blocks().size(); block-- > 0;)
        for (const std::int64_t node : nodes_of_block(source, block)) out.push_back(node);
    return out;
  };
  EXPECT_EQ(all(0), all(std::size_t{1} << 20));
}

TEST(PrismSource, GroupsNameWhatTheyHold) {
  const PrismMeshParts parts = testing::sample_parts();
  PrismSource source(PrismMesh::from_parts(parts));
  ASSERT_EQ(source.groups().size(), parts.face_tags.size() + parts.volume_tags.size());
  for (std::size_t i = 0; i < source.groups().size(); ++i) {
    const ElementGroup& group = source.groups()[i];
    const bool is_face = i < parts.face_tags.size();
    EXPECT_EQ(group.dimension, is_face ? 2 : 3);
    if (is_face) continue;
    const VolumeTag& tag = parts.volume_tags[i - parts.face_tags.size()];
    EXPECT_EQ(std::tuple(group.tag, group.layer, group.material, group.net, group.num_elements),
              std::tuple(tag.id, tag.layer, tag.material, tag.net, tag.num_prisms));
  }
  EXPECT_EQ(source.num_elements(3), source.prisms()->num_prisms());
  EXPECT_EQ(source.num_elements(2), source.prisms()->num_tagged_triangles() + source.prisms()->num_tagged_quads());
}

// Each value belongs to the prism of the same rank: recomputed from its nodes.
TEST(PrismSource, FieldsComeInTheOrderOfThePrisms) {
  const PrismMeshParts parts = testing::sample_parts();
  const PrismMesh mesh = PrismMesh::from_parts(parts);
  PrismSource source(mesh, [](std::span<const PrismBase> bases, double height, std::span<double> out) {
    std::ranges::transform(bases, out.begin(), [&](const PrismBase& base) { return base[0] + 1e3 * base[1] + height; });
  });
  std::vector<std::array<double, 3>> nodes(static_cast<std::size_t>(mesh.num_nodes()));
  source.fill_nodes(0, nodes);
  std::map<std::array<std::int64_t, 6>, std::int64_t> id_of;
  std::vector<std::array<std::int64_t, 6>> prisms(static_cast<std::size_t>(mesh.num_prisms()));
  mesh.fill_prisms(0, prisms);
  std::int64_t num_seen = 0;
  for (std::size_t block = 0; block < source.blocks().size(); ++block) {
    if (source.blocks()[block].kind != ElementKind::wedge) continue;
    const std::vector<std::int64_t> rows = nodes_of_block(source, block);
    const auto quality = values_of_block(source, block, CellField::quality),
               sublayer = values_of_block(source, block, CellField::sublayer),
               region = values_of_block(source, block, CellField::region);
    ASSERT_EQ(static_cast<std::int64_t>(quality.size()), source.blocks()[block].count);
    ASSERT_EQ(rows.size(), 6 * quality.size());
    for (std::size_t i = 0; i < quality.size(); ++i, ++num_seen) {
      const auto at = [&](std::size_t k) { return nodes[static_cast<std::size_t>(rows[6 * i + k])]; };
      const auto squared = [&](std::size_t p, std::size_t q) {
        return (at(p)[0] - at(q)[0]) * (at(p)[0] - at(q)[0]) + (at(p)[1] - at(q)[1]) * (at(p)[1] - at(q)[1]);
      };
      const double area = 0.5 * ((at(1)[0] - at(0)[0]) * (at(2)[1] - at(0)[1]) - (at(1)[1] - at(0)[1]) * (at(2)[0] - at(0)[0]));
      const double height = at(3)[2] - at(0)[2];
      EXPECT_NEAR(quality[i], area + 1e3 * (squared(0, 1) + squared(1, 2) + squared(2, 0)) + height, 1e-12);
      EXPECT_NEAR(mesh.plan().z_m()[static_cast<std::size_t>(sublayer[i])], at(0)[2], 1e-15);
      const auto found =
          std::ranges::find_if(prisms, [&](const auto& p) { return std::equal(p.begin(), p.end(), &rows[6 * i]); });
      ASSERT_NE(found, prisms.end());
      const std::int64_t rank = found - prisms.begin() - mesh.first_prism_of_sublayer(static_cast<std::int32_t>(sublayer[i]));
      std::int64_t present = -1;
      for (std::int32_t t = 0; t < mesh.planar().num_triangles(); ++t) {
        if (mesh.tag_of(mesh.plan().slab_of_sublayer()[static_cast<std::size_t>(sublayer[i])], t) < 0) continue;
        if (++present == rank) {
          EXPECT_EQ(region[i], parts.planar.regions()[static_cast<std::size_t>(t)]);
        }
      }
    }
  }
  EXPECT_EQ(num_seen, mesh.num_prisms());
}

/// The sample with a sheet on the face between slabs 0 and 1 over region 0, and a port on a wall between regions 0 and 3.
PrismMeshParts parts_with_inner_faces() {
  PrismMeshParts parts = testing::sample_parts();
  parts.ports = {{.name = "P1", .positive_net = 1, .negative_net = 0}};
  FaceTag sheet{.id = 5, .name = "sheet|GND", .kind = FaceTagKind::sheet, .net = 0, .is_inner = true};
  FaceTag port{
      .id = 6, .name = "port|P1", .kind = FaceTagKind::port, .is_inner = true, .condition = BoundaryCondition::port, .port = 0};
  parts.face_tags.push_back(sheet);
  parts.face_tags.push_back(port);
  for (std::int32_t t = 0; t < parts.planar.num_triangles(); ++t)
    if (parts.planar.regions()[static_cast<std::size_t>(t)] == 0) parts.caps.push_back({4, 1, t, true});
  // Row 2 of the grid's points separates regions 0 and 3; squares are two columns wide.
  parts.walls.push_back({5, 1, 14, 15});
  parts.walls.push_back({5, 1, 15, 16});
  std::ranges::sort(parts.caps, {}, [](const Cap& c) { return std::tuple(c.tag, c.level, c.triangle); });
  std::ranges::sort(parts.walls, {}, [](const Wall& w) { return std::tuple(w.tag, w.slab, w.a, w.b); });
  for (VolumeTag& tag : parts.volume_tags) tag.num_prisms = 0, tag.volume_m3 = 0;
  for (FaceTag& tag : parts.face_tags) tag.num_triangles = tag.num_quads = 0, tag.area_m2 = 0;
  testing::fill_tag_sizes(parts);
  return parts;
}

TEST(PrismSource, InnerFacesAreWrittenLikeOthers) {
  const PrismMesh mesh = PrismMesh::from_parts(parts_with_inner_faces());
  PrismSource source(mesh);
  ASSERT_TRUE(source.groups()[4].is_inner);
  EXPECT_EQ(source.groups()[4].num_elements, 8);
  EXPECT_EQ(source.groups()[5].num_elements, 2 * 3);
  EXPECT_FALSE(source.groups()[0].is_inner);
}

// X3 for inner faces: each of these lies.
TEST(PrismMesh, InnerFacesMustLieBetweenTwoPrismsOnce) {
  const auto refuses = [](auto&& spoil) {
    PrismMeshParts parts = parts_with_inner_faces();
    spoil(parts);
    std::ranges::sort(parts.caps, {}, [](const Cap& c) { return std::tuple(c.tag, c.level, c.triangle); });
    std::ranges::sort(parts.walls, {}, [](const Wall& w) { return std::tuple(w.tag, w.slab, w.a, w.b); });
    EXPECT_THROW(static_cast<void>(PrismMesh::from_parts(std::move(parts))), Error);
  };
  refuses([](PrismMeshParts& parts) { parts.caps.back().up = false; });
  refuses([](PrismMeshParts& parts) { parts.caps.back().level = 0; });
  refuses([](PrismMeshParts& parts) { parts.caps.push_back({5, 1, parts.caps.back().triangle, true}); });
  refuses([](PrismMeshParts& parts) { parts.walls.back().b = 30; });
  refuses([](PrismMeshParts& parts) { parts.walls.push_back({4, 1, 15, 14}); });
  refuses([](PrismMeshParts& parts) { parts.face_tags[5].is_inner = false; });
  refuses([](PrismMeshParts& parts) { parts.face_tags[3].is_inner = true; });
  refuses([](PrismMeshParts& parts) { parts.face_tags[5].port = 1; });
}

}  // namespace
}  // namespace pcbmesh::mesh
