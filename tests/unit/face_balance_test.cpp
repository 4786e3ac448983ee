// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/balance/face_balance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <iterator>

#include "folder.hpp"
#include "pcbmesh/base/error.hpp"
#include "pcbmesh/extrude/second_order_source.hpp"
#include "pcbmesh/extrude/tetrahedral_source.hpp"
#include "pcbmesh/formats/registry.hpp"
#include "pcbmesh/mesh/prism_source.hpp"
#include "sample_prism_mesh.hpp"

namespace pcbmesh::formats {
namespace {

/// A source that spoils what another one hands out.
class Spoiled final : public mesh::MeshSource {
 public:
  using Spoil = std::function<void(std::size_t block, std::vector<std::int64_t>& nodes)>;
  Spoiled(mesh::MeshSource& source, Spoil spoil) : source_(source), spoil_(std::move(spoil)) { announce_as(source); }
  [[nodiscard]] mesh::Extent extent_of(std::size_t group) override { return source_.extent_of(group); }
  [[nodiscard]] bool has_tagged_hull() const override { return true; }
  void fill_nodes(std::int64_t first, std::span<std::array<double, 3>> out) override { source_.fill_nodes(first, out); }
  void visit(std::size_t block, const VisitNodes& visit) override {
    source_.visit(block, [&](std::span<const std::int64_t> nodes) {
      std::vector<std::int64_t> changed(nodes.begin(), nodes.end());
      spoil_(block, changed);
      visit(changed);
    });
  }

 private:
  mesh::MeshSource& source_;
  Spoil spoil_;
};

/// Passes everything on; false if the balance objects.
bool is_balanced(mesh::MeshSource& source) {
  FaceBalance balance(source, "x.msh");
  try {
    for (std::size_t block = 0; block < balance.blocks().size(); ++block) balance.visit(block, [](auto) {});
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::internal);
    return false;
  }
  EXPECT_TRUE(balance.is_complete());
  return true;
}

bool is_balanced_when(mesh::MeshSource& source, const Spoiled::Spoil& spoil) {
  Spoiled spoiled(source, spoil);
  return is_balanced(spoiled);
}

bool is_balanced_when(const Spoiled::Spoil& spoil) {
  mesh::PrismSource source(mesh::PrismMesh::from_parts(testing::sample_parts()));
  return is_balanced_when(source, spoil);
}

TEST(FaceBalance, HoldsForAMeshWithVoids) {
  EXPECT_TRUE(is_balanced_when([](std::size_t, auto&) {}));
}

void break_each_block(mesh::MeshSource& source) {
  for (std::size_t block = 0; block < source.blocks().size(); ++block) {
    if (source.groups()[static_cast<std::size_t>(source.blocks()[block].group)].is_inner) continue;
    const auto width = static_cast<std::size_t>(mesh::nodes_of(source.blocks()[block].kind));
    const auto breaks = [&](const char* what, auto change) {
      EXPECT_FALSE(is_balanced_when(source,
                                    [&, done = false](std::size_t at, std::vector<std::int64_t>& nodes) mutable {
                                      if (at == block && !std::exchange(done, true)) change(nodes);
                                    }))
          << what << " in block " << block << " of " << name_of(source.blocks()[block].kind);
    };
    breaks("a wrong node", [](auto& nodes) { nodes[1] += 1; });
    breaks("two corners swapped", [](auto& nodes) { std::swap(nodes[0], nodes[1]); });
    breaks("an element lost", [&](auto& nodes) { nodes.resize(nodes.size() - width); });
    breaks("an element twice", [&](auto& nodes) {
      const std::vector<std::int64_t> first(nodes.begin(), nodes.begin() + static_cast<std::ptrdiff_t>(width));
      nodes.insert(nodes.end(), first.begin(), first.end());
    });
  }
}

TEST(FaceBalance, BreaksWithAnyOneChange) {
  const mesh::PrismMesh mesh = mesh::PrismMesh::from_parts(testing::sample_parts());
  mesh::PrismSource prisms(mesh);
  break_each_block(prisms);
  extrude::TetrahedralSource tetrahedra(prisms);
  EXPECT_TRUE(is_balanced(tetrahedra));
  break_each_block(tetrahedra);
  extrude::SecondOrderSource second_order(mesh, {});
  EXPECT_TRUE(is_balanced(second_order));
  break_each_block(second_order);
}

/// A block of squares, two triangles each, extruded; node numbers as regular as they can be.
class RegularBlock final : public mesh::MeshSource {
 public:
  using Rows = std::vector<std::int64_t>;
  RegularBlock(std::int64_t n, std::int64_t num_sublayers) {
    const std::int64_t width = n + 1, level = width * width;
    num_nodes_ = level * (num_sublayers + 1);
    const auto wall = [&](std::int64_t a, std::int64_t b) {
      for (std::int64_t k = 0; k < num_sublayers; ++k)
        for (const std::int64_t node : {a + k * level, b + k * level, b + (k + 1) * level, a + (k + 1) * level})
          rows[1].push_back(node);
    };
    for (std::int64_t i = 0; i < n; ++i) {
      wall(i, i + 1);
      wall(n * width + i + 1, n * width + i);
      wall((i + 1) * width, i * width);
      wall(i * width + n, (i + 1) * width + n);
      for (std::int64_t j = 0; j < n; ++j) {
        const std::int64_t a = i * width + j, b = a + 1, c = b + width, d = a + width, top = num_sublayers * level;
        for (const auto& [p, q, r] : {std::array{a, b, c}, std::array{a, c, d}}) {
          for (const std::int64_t node : {p, r, q, p + top, q + top, r + top}) rows[0].push_back(node);
          for (std::int64_t k = 0; k < num_sublayers; ++k)
            for (const std::int64_t base : {k * level, (k + 1) * level})
              for (const std::int64_t node : {p, q, r}) rows[2].push_back(base + node);
        }
      }
    }
    groups_ = {{.dimension = 2, .tag = 1, .name = "hull"}, {.dimension = 3, .tag = 1, .name = "block"}};
    blocks_ = {{mesh::ElementKind::triangle, 0, 1, static_cast<std::int64_t>(rows[0].size() / 3)},
               {mesh::ElementKind::quadrangle, 0, 1, static_cast<std::int64_t>(rows[1].size() / 4)},
               {mesh::ElementKind::wedge, 1, 1, static_cast<std::int64_t>(rows[2].size() / 6)}};
  }
  void fill_nodes(std::int64_t, std::span<std::array<double, 3>>) override {}
  [[nodiscard]] mesh::Extent extent_of(std::size_t) override { return {}; }
  void visit(std::size_t block, const VisitNodes& visit) override {
    const auto width = static_cast<std::size_t>(mesh::nodes_of(blocks_[block].kind));
    for (std::span<const std::int64_t> rest = rows[block]; !rest.empty();) {
      const auto few = rest.first(std::min(rest.size(), chunk * width));
      visit(few);
      rest = rest.subspan(few.size());
    }
  }
  Rows rows[3];
};

TEST(FaceBalance, FaultsWithAPatternDoNotCancel) {
  const std::int64_t n = 12, num_sublayers = 6, level = (n + 1) * (n + 1);
  const auto balance_after = [&](const std::function<void(RegularBlock::Rows&)>& change) {
    RegularBlock block(n, num_sublayers);
    change(block.rows[2]);
    return is_balanced(block);
  };
  EXPECT_TRUE(balance_after([](auto&) {}));
  for (const std::int64_t by : {std::int64_t{1}, n, n + 1, level, -level, std::int64_t{1} << 32}) {
    EXPECT_FALSE(balance_after([&](auto& wedges) {
      for (std::int64_t& node : wedges) node += by;
    })) << "every node of every cell moved by "
        << by;
    EXPECT_FALSE(balance_after([&](auto& wedges) {
      for (std::size_t i = 0; i < wedges.size(); ++i)
        if (i % 6 >= 3) wedges[i] += by;
    })) << "all upper corners moved by "
        << by;
  }
  EXPECT_FALSE(balance_after([](auto& wedges) {
    for (std::size_t i = 0; i < wedges.size(); i += 3) std::swap(wedges[i], wedges[i + 1]);
  })) << "all cells inside out";
  EXPECT_FALSE(balance_after([](auto& wedges) {
    for (std::size_t i = 0; i < wedges.size(); i += 6) std::rotate(&wedges[i], &wedges[i] + 1, &wedges[i] + 3);
  })) << "all cells twisted";
  EXPECT_FALSE(balance_after([](auto& wedges) {
    RegularBlock::Rows kept;
    for (std::size_t i = 0; i < wedges.size(); ++i)
      if (i / 6 % 2 == 0) kept.push_back(wedges[i]);
    wedges = kept;
  })) << "every second cell lost";
  EXPECT_FALSE(balance_after([](auto& wedges) { std::swap(wedges[6 * 200 + 1], wedges[6 * 200 + 4]); }))
      << "a corner exchanged with the one above it";
  EXPECT_FALSE(balance_after([](auto& wedges) { std::rotate(&wedges[600], &wedges[600] + 1, &wedges[600] + 3); }))
      << "one cell twisted: its sides match nobody's";
  EXPECT_FALSE(balance_after([](auto& wedges) { wedges.insert(wedges.end(), wedges.begin(), wedges.begin() + 36); }))
      << "six cells twice";
  EXPECT_FALSE(balance_after([](auto& wedges) { std::swap(wedges[6 * 100 + 1], wedges[6 * 100 + 7]); }))
      << "two neighbours exchange a node";
}

TEST(FaceBalance, TheOrderOfElementsAndTheirTurnsDoNotMatter) {
  mesh::PrismSource source(mesh::PrismMesh::from_parts(testing::sample_parts()));
  int num_changed = 0;
  EXPECT_TRUE(is_balanced_when([&](std::size_t block, std::vector<std::int64_t>& nodes) {
    if (source.blocks()[block].kind != mesh::ElementKind::wedge || nodes.size() < 12) return;
    std::rotate(nodes.begin(), nodes.begin() + 6, nodes.end());
    for (const std::size_t base : {0u, 3u}) std::rotate(&nodes[base], &nodes[base + 1], &nodes[base] + 3);
    ++num_changed;
  }));
  EXPECT_GT(num_changed, 0);
}

TEST(FaceBalance, SaysWhenItHasNotSeenAll) {
  mesh::PrismSource source(mesh::PrismMesh::from_parts(testing::sample_parts()));
  FaceBalance balance(source, "x.msh");
  for (std::size_t block = 0; block < source.blocks().size(); ++block) {
    EXPECT_FALSE(balance.is_complete());
    balance.visit(block, [](auto) {});
  }
  EXPECT_TRUE(balance.is_complete());
  EXPECT_EQ(balance.num_nodes(), source.num_nodes());
  EXPECT_EQ(balance.groups().size(), source.groups().size());
}

TEST(FaceBalance, AnUnbalancedMeshLeavesTheOldFileAlone) {
  const testing::Folder folder;
  const std::filesystem::path file = folder / "x.msh";
  std::ofstream(file) << "old";
  mesh::PrismSource source(mesh::PrismMesh::from_parts(testing::sample_parts()));
  Spoiled spoiled(source, [](std::size_t, std::vector<std::int64_t>& nodes) { std::swap(nodes[0], nodes[1]); });
  for (const char* format : {"msh", "mfem", "abaqus"}) {
    EXPECT_THROW(write_mesh(spoiled, file, {}, format, Progress{}), Error) << format;
    std::ifstream in(file);
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(in), {}), "old") << format;
  }
  EXPECT_EQ(folder.num_files(), 1u) << "debris";
}

}  // namespace
}  // namespace pcbmesh::formats
