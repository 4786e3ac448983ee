// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/mesh/prism_mesh.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "explicit_mesh.hpp"
#include "pcbmesh/base/error.hpp"

namespace {
std::atomic<std::size_t> bytes_asked{0};
}  // namespace

// Not inlined: g++ 12 else takes the pair for mismatched.
[[gnu::noinline]] void* operator new(std::size_t size) {
  bytes_asked += size;
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace pcbmesh::mesh {
namespace {

using testing::boundary_faces;
using testing::even_plan;
using testing::ExplicitMesh;
using testing::FaceMap;
using testing::faces_of;
using testing::grid;
using testing::spell_out;
using testing::turned;

/// Parts whose volume tag of (region, slab) is given, -1 = void.
PrismMeshParts parts_of(const PlanarMesh& planar, const LayerPlan& plan, const std::vector<std::int32_t>& column_tags,
                        std::int32_t num_tags) {
  PrismMeshParts parts;
  parts.planar = planar;
  parts.plan = plan;
  parts.layers = {"L"};
  parts.materials.push_back({"m"});
  for (std::int32_t i = 0; i < num_tags; ++i) {
    VolumeTag tag;
    tag.id = i + 1;
    tag.name = "L|m|none";
    parts.volume_tags.push_back(tag);
  }
  FaceTag face;
  face.id = 1;
  face.name = "side";
  parts.face_tags.push_back(face);
  parts.column_tags = column_tags;
  testing::add_boundary_by_neighbours(parts);
  return parts;
}

PlanarMesh block_grid(int nx, int ny) {
  return grid(
      nx, ny, 1e-3, 2e-3, [](int i, int j) { return i / 2 + 3 * (j / 2); }, std::vector<std::vector<std::int32_t>>(9));
}

/// 6 x 6 squares in 9 regions, 4 slabs; void cells at random.
PrismMeshParts random_parts(unsigned seed) {
  std::mt19937 random(seed);
  const PlanarMesh planar = block_grid(6, 6);
  const LayerPlan plan = even_plan({1, 3, 2, 1}, 1e-4);
  std::vector<std::int32_t> column_tags(36);
  const auto share = random() % 5;  // from nearly full to nearly void
  for (std::int32_t& tag : column_tags) tag = random() % 5 < share ? -1 : static_cast<std::int32_t>(random() % 3);
  if (seed % 4 == 0) {  // a slab without any void between others, and one without any prism
    for (std::size_t r = 0; r < 9; ++r) column_tags[r * 4 + 1] = 2, column_tags[r * 4 + 2] = -1;
  }
  return parts_of(planar, plan, column_tags, 3);
}

void expect_equal(const PrismMesh& mesh, const ExplicitMesh& expected) {
  ASSERT_EQ(mesh.num_nodes(), static_cast<std::int64_t>(expected.nodes.size()));
  ASSERT_EQ(mesh.num_prisms(), static_cast<std::int64_t>(expected.prisms.size()));
  for (std::int32_t k = 0; k < mesh.plan().num_levels(); ++k) {
    for (std::int32_t v = 0; v < mesh.planar().num_points(); ++v) {
      const auto found = expected.node_ids.find({k, v});
      ASSERT_EQ(mesh.has_node(k, v), found != expected.node_ids.end()) << "level " << k << " vertex " << v;
      if (mesh.has_node(k, v)) {
        ASSERT_EQ(mesh.node_id(k, v), found->second);
      }
    }
  }
  std::vector<std::int64_t> per_sublayer(static_cast<std::size_t>(mesh.plan().num_sublayers()), 0);
  for (std::size_t i = 0; i < expected.cells.size(); ++i) {
    const auto& [k, t] = expected.cells[i];
    ASSERT_EQ(mesh.prism_id(k, t), static_cast<std::int64_t>(i));
    ASSERT_EQ(mesh.tag_of(mesh.plan().slab_of_sublayer()[static_cast<std::size_t>(k)], t), expected.tags[i]);
    ++per_sublayer[static_cast<std::size_t>(k)];
  }
  std::int64_t first = 0;
  for (std::int32_t k = 0; k < mesh.plan().num_sublayers(); ++k) {
    ASSERT_EQ(mesh.first_prism_of_sublayer(k), first);
    ASSERT_EQ(mesh.num_prisms_of_sublayer(k), per_sublayer[static_cast<std::size_t>(k)]);
    first += per_sublayer[static_cast<std::size_t>(k)];
  }
  ASSERT_EQ(mesh.first_node_of_level(mesh.plan().num_levels() - 1) + mesh.num_nodes_of_level(mesh.plan().num_levels() - 1),
            mesh.num_nodes());
}

/// Fills block by block and compares each block.
void expect_fills_equal(const PrismMesh& mesh, const ExplicitMesh& expected, std::mt19937& random) {
  for (std::size_t first = 0; first < expected.nodes.size();) {
    std::vector<std::array<double, 3>> out(std::min<std::size_t>(1 + random() % 40, expected.nodes.size() - first));
    mesh.fill_nodes(static_cast<std::int64_t>(first), out);
    for (std::size_t i = 0; i < out.size(); ++i) ASSERT_EQ(out[i], expected.nodes[first + i]);
    first += out.size();
  }
  for (std::size_t first = 0; first < expected.prisms.size();) {
    const std::size_t size = std::min<std::size_t>(1 + random() % 150, expected.prisms.size() - first);
    std::vector<std::array<std::int64_t, 6>> out(size);
    std::vector<std::int32_t> tags(size);
    mesh.fill_prisms(static_cast<std::int64_t>(first), out, tags);
    for (std::size_t i = 0; i < size; ++i) {
      ASSERT_EQ(out[i], expected.prisms[first + i]);
      ASSERT_EQ(tags[i], expected.tags[first + i]);
    }
    first += size;
  }
}

TEST(PrismMesh, X2_IdsAreDenseAndOrderedForRandomVoids) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(seed);
    const PrismMeshParts parts = random_parts(seed);
    const PrismMesh mesh = PrismMesh::from_parts(parts);
    expect_equal(mesh, spell_out(parts.planar, parts.plan, parts.column_tags));
    if (HasFatalFailure()) return;
  }
}

TEST(PrismMesh, BlocksOfAnySizeFillTheSame) {
  std::mt19937 random(7);
  for (unsigned seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(seed);
    const PrismMeshParts parts = random_parts(seed);
    expect_fills_equal(PrismMesh::from_parts(parts), spell_out(parts.planar, parts.plan, parts.column_tags), random);
    if (HasFatalFailure()) return;
  }
}

TEST(PrismMesh, MasksLongerThanAWordKeepRank) {
  // 40 x 30 squares: 2400 triangles, 1271 vertices; one stripe of voids crosses many words.
  const PlanarMesh planar = grid(40, 30, 1, 1, [](int i, int) { return i >= 7 && i < 33 ? 1 : 0; }, {{}, {}});
  const std::vector<std::int32_t> column_tags{0, 0, 0, 0, -1, 0};
  const PrismMeshParts parts = parts_of(planar, even_plan({2, 2, 2}, 1), column_tags, 1);
  const PrismMesh mesh = PrismMesh::from_parts(parts);
  const ExplicitMesh expected = spell_out(planar, parts.plan, column_tags);
  std::mt19937 random(3);
  expect_equal(mesh, expected);
  expect_fills_equal(mesh, expected, random);
}

TEST(PrismMesh, FullMeshHasTrianglesTimesSublayers) {
  const PlanarMesh planar = block_grid(6, 6);
  const PrismMeshParts parts = parts_of(planar, even_plan({2, 3}, 1), std::vector<std::int32_t>(18, 0), 1);
  const PrismMesh mesh = PrismMesh::from_parts(parts);
  EXPECT_EQ(mesh.num_prisms(), 72 * 5);
  EXPECT_EQ(mesh.num_nodes(), 49 * 6);
  EXPECT_EQ(mesh.num_tagged_triangles(), 2 * 72);
  EXPECT_EQ(mesh.num_tagged_quads(), 24 * 5);
  std::vector<std::array<std::int64_t, 6>> all(static_cast<std::size_t>(mesh.num_prisms()));
  mesh.fill_prisms(0, all);
  const ExplicitMesh expected = spell_out(planar, parts.plan, parts.column_tags);
  EXPECT_EQ(all, expected.prisms);
}

TEST(PrismMesh, PrismsHavePositiveJacobian) {
  const PrismMeshParts parts = random_parts(11);
  const PrismMesh mesh = PrismMesh::from_parts(parts);
  std::vector<std::array<double, 3>> nodes(static_cast<std::size_t>(mesh.num_nodes()));
  std::vector<std::array<std::int64_t, 6>> prisms(static_cast<std::size_t>(mesh.num_prisms()));
  mesh.fill_nodes(0, nodes);
  mesh.fill_prisms(0, prisms);
  ASSERT_FALSE(prisms.empty());
  for (const auto& prism : prisms) {
    const auto at = [&](std::size_t corner) { return nodes[static_cast<std::size_t>(prism[corner])]; };
    const auto [p, q, r, up] = std::tuple(at(0), at(1), at(2), at(3));
    const double turn = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
    EXPECT_GT(turn * (up[2] - p[2]), 0);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(at(i)[0], at(i + 3)[0]);
      EXPECT_EQ(at(i)[1], at(i + 3)[1]);
    }
  }
}

TEST(PrismMesh, X3_CapsAndWallsCloseTheMesh) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(seed);
    const PrismMesh mesh = PrismMesh::from_parts(random_parts(seed));
    std::vector<std::array<std::int64_t, 6>> prisms(static_cast<std::size_t>(mesh.num_prisms()));
    mesh.fill_prisms(0, prisms);
    std::multiset<std::vector<std::int64_t>> expected, found;
    for (const auto& [nodes, uses] : faces_of(prisms)) {
      ASSERT_LE(uses.size(), 2U);
      if (uses.size() == 1) expected.insert(turned(uses[0]));
    }
    for (const auto& face : boundary_faces(mesh)) found.insert(turned(face));
    EXPECT_EQ(found, expected);
    EXPECT_EQ(static_cast<std::int64_t>(found.size()), mesh.num_tagged_triangles() + mesh.num_tagged_quads());
  }
}

TEST(PrismMesh, X3_WrongBoundaryIsRefused) {
  const PrismMeshParts good = random_parts(2);
  ASSERT_GT(good.caps.size(), 2U);
  ASSERT_GT(good.walls.size(), 2U);
  const auto expect_refused = [&](const char* what, const std::function<void(PrismMeshParts&)>& spoil) {
    PrismMeshParts parts = good;
    spoil(parts);
    EXPECT_THROW(std::ignore = PrismMesh::from_parts(parts), Error) << what;
  };
  EXPECT_NO_THROW(std::ignore = PrismMesh::from_parts(good));
  expect_refused("missing cap", [](PrismMeshParts& parts) { parts.caps.erase(parts.caps.begin() + 1); });
  expect_refused("missing wall", [](PrismMeshParts& parts) { parts.walls.erase(parts.walls.begin() + 1); });
  expect_refused("cap the wrong way up", [](PrismMeshParts& parts) { parts.caps[1].up = !parts.caps[1].up; });
  expect_refused("wall the wrong way round", [](PrismMeshParts& parts) { std::swap(parts.walls[1].a, parts.walls[1].b); });
  expect_refused("wall in another slab", [](PrismMeshParts& parts) { parts.walls.back().slab = 0; });
  expect_refused("cap of an unknown tag", [](PrismMeshParts& parts) { parts.caps.back().tag = 5; });
  expect_refused("face in two tags", [](PrismMeshParts& parts) {
    parts.face_tags.push_back(parts.face_tags[0]);
    parts.face_tags.back().id = 2;
    parts.caps.push_back(parts.caps[0]);
    parts.caps.back().tag = 1;
  });
  expect_refused("wall doubled in both directions", [](PrismMeshParts& parts) {
    parts.face_tags.push_back(parts.face_tags[0]);
    parts.face_tags.back().id = 2;
    const Wall wall = parts.walls[0];
    parts.walls.push_back({1, wall.slab, std::min(wall.a, wall.b), std::max(wall.a, wall.b)});
    parts.walls.push_back({1, wall.slab, std::max(wall.a, wall.b), std::min(wall.a, wall.b)});
  });
  expect_refused("void cell that the boundary does not know", [](PrismMeshParts& parts) {
    const auto found =
        std::find_if(parts.column_tags.begin(), parts.column_tags.end(), [](std::int32_t tag) { return tag >= 0; });
    *found = -1;
  });
  expect_refused("column table of the wrong size", [](PrismMeshParts& parts) { parts.column_tags.pop_back(); });
}

TEST(PrismMesh, X1_MemoryDoesNotGrowWithPrisms) {
  const PlanarMesh planar = grid(60, 60, 1, 1, [](int i, int) { return i == 30 ? 1 : 0; }, {{}, {}});
  const std::vector<std::int32_t> column_tags{0, 0, 0, 0, -1, 0};
  const auto bytes_for = [&](int sublayers) {
    const PrismMeshParts parts = parts_of(planar, even_plan({sublayers, sublayers, sublayers}, 1e-6), column_tags, 1);
    const std::size_t before = bytes_asked;
    const PrismMesh mesh = PrismMesh::from_parts(parts);
    EXPECT_GT(mesh.num_prisms(), std::int64_t{3} * sublayers * 7000);
    return static_cast<double>(bytes_asked - before);
  };
  const double few = bytes_for(1), many = bytes_for(10'000);
  // Per level: an id, a mask number and the growth of their vectors; the prisms themselves would ask for 10 GB.
  EXPECT_LT((many - few) / 30'000, 128);
}

TEST(PrismMesh, GroupsTrianglesByTag) {
  const PrismMeshParts parts = random_parts(6);
  const PrismMesh mesh = PrismMesh::from_parts(parts);
  std::vector<std::int32_t> offsets, triangles;
  for (std::int32_t slab = 0; slab < mesh.plan().num_slabs(); ++slab) {
    mesh.group_triangles(slab, offsets, triangles);
    ASSERT_EQ(offsets.size(), mesh.volume_tags().size() + 1);
    EXPECT_EQ(offsets.front(), 0);
    std::size_t present = 0;
    for (std::int32_t tag = 0; tag < 3; ++tag) {
      std::vector<std::int32_t> expected;
      for (std::int32_t t = 0; t < mesh.planar().num_triangles(); ++t) {
        if (mesh.tag_of(slab, t) == tag) expected.push_back(t);
      }
      const auto first = triangles.begin() + offsets[static_cast<std::size_t>(tag)];
      const auto last = triangles.begin() + offsets[static_cast<std::size_t>(tag) + 1];
      EXPECT_EQ(std::vector<std::int32_t>(first, last), expected);
      present += expected.size();
    }
    EXPECT_EQ(triangles.size(), present);
  }
}

TEST(PrismMesh, NetPiecesDefaultToUnknown) {
  PrismMeshParts parts = random_parts(1);
  parts.nets = {"GND", "VCC"};
  EXPECT_EQ(PrismMesh::from_parts(parts).net_pieces()[1], -1);
}

TEST(PrismMesh, BlocksBeyondTheEndAreRefused) {
  const PrismMesh mesh = PrismMesh::from_parts(random_parts(1));
  std::vector<std::array<std::int64_t, 6>> prisms(2);
  std::vector<std::array<double, 3>> nodes(2);
  EXPECT_THROW(mesh.fill_prisms(mesh.num_prisms() - 1, prisms), Error);
  EXPECT_THROW(mesh.fill_nodes(mesh.num_nodes() - 1, nodes), Error);
  EXPECT_THROW(mesh.fill_prisms(-1, prisms), Error);
  EXPECT_NO_THROW(mesh.fill_prisms(mesh.num_prisms(), {}));
}

TEST(PrismMesh, MeshOfVoidsAloneIsEmpty) {
  const PrismMesh mesh =
      PrismMesh::from_parts(parts_of(block_grid(6, 6), even_plan({2}, 1), std::vector<std::int32_t>(9, -1), 0));
  EXPECT_EQ(mesh.num_nodes(), 0);
  EXPECT_EQ(mesh.num_prisms(), 0);
  EXPECT_FALSE(mesh.has_node(1, 3));
}

}  // namespace
}  // namespace pcbmesh::mesh
