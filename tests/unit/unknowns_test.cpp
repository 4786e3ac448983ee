// SPDX-License-Identifier: GPL-3.0-or-later
// Closed counting formulas against meshes spelt out element by element.
#include "pcbmesh/mesh/unknowns.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "pcbmesh/mesh/net_measures.hpp"
#include "sample_prism_mesh.hpp"

namespace pcbmesh {
namespace {

using mesh::Cells;

/// A mesh as cells with faces, each face and cell with its edges; all keyed by sorted nodes.
struct Explicit {
  using Key = std::vector<std::int64_t>;
  struct Cell {
    std::set<Key> edges, triangles, quads;
  };
  std::vector<Cell> cells;

  static Key sorted(Key key) {
    std::sort(key.begin(), key.end());
    return key;
  }
  static Cell cell_of(const std::vector<Key>& rings) {
    Cell cell;
    for (const Key& ring : rings) {
      (ring.size() == 3 ? cell.triangles : cell.quads).insert(sorted(ring));
      for (std::size_t i = 0; i < ring.size(); ++i) cell.edges.insert(sorted({ring[i], ring[(i + 1) % ring.size()]}));
    }
    return cell;
  }

  explicit Explicit(const mesh::PrismMesh& prisms, Cells kind) {
    std::vector<std::array<std::int64_t, 6>> corners(static_cast<std::size_t>(prisms.num_prisms()));
    prisms.fill_prisms(0, corners);
    for (auto v : corners) {
      if (kind == Cells::prisms) {
        cells.push_back(cell_of({{v[0], v[1], v[2]},
                                 {v[3], v[4], v[5]},
                                 {v[0], v[1], v[4], v[3]},
                                 {v[1], v[2], v[5], v[4]},
                                 {v[2], v[0], v[3], v[5]}}));
        continue;
      }
      // Turned so that the smallest node comes first: its diagonals are then those of both faces beside it.
      while (std::min({v[0], v[1], v[2]}) != v[0]) v = {v[1], v[2], v[0], v[4], v[5], v[3]};
      const bool first = v[1] < v[2];
      const std::vector<Key> tets =
          first ? std::vector<Key>{{v[0], v[1], v[2], v[5]}, {v[0], v[1], v[5], v[4]}, {v[0], v[4], v[5], v[3]}}
                : std::vector<Key>{{v[0], v[1], v[2], v[4]}, {v[0], v[4], v[2], v[5]}, {v[0], v[4], v[5], v[3]}};
      for (const Key& t : tets)
        cells.push_back(cell_of({{t[0], t[1], t[2]}, {t[0], t[1], t[3]}, {t[0], t[2], t[3]}, {t[1], t[2], t[3]}}));
    }
  }

  /// Unknowns by giving each entity its own numbers, nonzeros as the set of pairs.
  [[nodiscard]] mesh::Unknowns count(int order) const {
    const std::int64_t k = order;
    std::map<Key, std::vector<std::int64_t>> numbers;
    std::map<Key, int> owners;
    std::int64_t next = 0;
    const auto take = [&](const Key& key, std::int64_t count) -> const std::vector<std::int64_t>& {
      const auto [at, is_new] = numbers.try_emplace(key);
      for (std::int64_t i = 0; is_new && i < count; ++i) at->second.push_back(next++);
      return at->second;
    };
    std::set<std::pair<std::int64_t, std::int64_t>> pairs;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const Cell& cell = cells[c];
      std::vector<std::int64_t> all;
      const auto add = [&](const std::vector<std::int64_t>& own) { all.insert(all.end(), own.begin(), own.end()); };
      for (const Key& e : cell.edges) add(take(e, k));
      for (const Key& f : cell.triangles) add(take(f, k * (k - 1))), ++owners[f];
      for (const Key& f : cell.quads) add(take(f, 2 * k * (k - 1))), ++owners[f];
      const bool is_prism = !cell.quads.empty();
      const std::int64_t inside = is_prism ? 3 * k * (k + 1) * (k + 2) / 2 - 9 * k - 2 * k * (k - 1) - 6 * k * (k - 1)
                                           : k * (k + 2) * (k + 3) / 2 - 6 * k - 4 * k * (k - 1);
      for (std::int64_t i = 0; i < inside; ++i) all.push_back(next++);
      for (const std::int64_t i : all)
        for (const std::int64_t j : all) pairs.emplace(i, j);
    }
    std::set<std::int64_t> on_boundary;
    for (const Cell& cell : cells)
      for (const auto* faces : {&cell.triangles, &cell.quads})
        for (const Key& face : *faces) {
          if (owners.at(face) != 1) continue;
          for (const std::int64_t i : numbers.at(face)) on_boundary.insert(i);
          for (const Key& e : cell.edges)
            if (std::includes(face.begin(), face.end(), e.begin(), e.end()))
              for (const std::int64_t i : numbers.at(e)) on_boundary.insert(i);
        }
    return {next, static_cast<std::int64_t>(on_boundary.size()), static_cast<double>(pairs.size())};
  }
};

TEST(Unknowns, FormulasAgreeWithMeshesSpeltOut) {
  for (const bool with_voids : {false, true}) {
    const mesh::PrismMesh prisms = mesh::PrismMesh::from_parts(testing::sample_parts(with_voids));
    const mesh::EntityCounts counts = mesh::count_entities(prisms);
    EXPECT_EQ(counts.nodes, prisms.num_nodes());
    for (const Cells kind : {Cells::prisms, Cells::tetrahedra}) {
      const Explicit spelt(prisms, kind);
      for (int order = 1; order <= 2; ++order) {
        const mesh::Unknowns expected = spelt.count(order), got = mesh::count_unknowns(counts, order, kind);
        EXPECT_EQ(got.total, expected.total) << order << with_voids;
        EXPECT_EQ(got.on_boundary, expected.on_boundary) << order << with_voids;
        EXPECT_EQ(got.nonzeros, expected.nonzeros) << order << with_voids;
      }
    }
  }
}

TEST(Unknowns, OneElementHasWhatTheoryGives) {
  // One prism: 9, 36, 90; three tetrahedra less what they share.
  mesh::EntityCounts one{.nodes = 6, .prisms = 1, .edges = 9, .boundary_edges = 9, .triangles = 2, .quads = 3};
  EXPECT_EQ(mesh::count_unknowns(one, 1, Cells::prisms).total, 9);
  EXPECT_EQ(mesh::count_unknowns(one, 2, Cells::prisms).total, 36);
  EXPECT_EQ(mesh::count_unknowns(one, 3, Cells::prisms).total, 90);
  EXPECT_EQ(mesh::count_unknowns(one, 1, Cells::prisms).nonzeros, 81);
  EXPECT_EQ(mesh::count_unknowns(one, 1, Cells::tetrahedra).total, 12);
}

TEST(NetMeasures, VolumesAreTheTagsAndAreasCloseTheCopper) {
  const mesh::PrismMesh prisms = mesh::PrismMesh::from_parts(testing::sample_parts(true));
  const std::vector<mesh::NetMeasure> nets = mesh::measure_nets(prisms);
  ASSERT_EQ(nets.size(), 4U);
  double volume = 0;
  for (const mesh::VolumeTag& tag : prisms.volume_tags())
    if (tag.net == 0) volume += tag.volume_m3;
  EXPECT_NEAR(nets[0].volume_m3, volume, 1e-12 * volume);
  EXPECT_EQ(nets[2].area_m2, 0);
  EXPECT_EQ(nets[3].volume_m3, 0) << "hollow";
  double skin = 0;
  for (const mesh::FaceTag& tag : prisms.face_tags())
    if (tag.net == 3) skin += tag.area_m2;
  EXPECT_NEAR(nets[3].area_m2, skin, 1e-12 * skin);
}

}  // namespace
}  // namespace pcbmesh
