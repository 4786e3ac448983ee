// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/balance/face_balance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "pcbmesh/mesh/prism_source.hpp"
#include "sample_prism_mesh.hpp"

namespace pcbmesh::formats {
namespace {

/// A source that spoils what another one hands out.
class Spoiled final : public mesh::MeshSource {
 public:
  using Spoil = std::function<void(std::size_t block, std::vector<std::int64_t>& nodes)>;
  Spoiled(mesh::MeshSource& source, Spoil spoil) : source_(source), spoil_(std::move(spoil)) {
    groups_.assign(source.groups().begin(), source.groups().end());
    blocks_.assign(source.blocks().begin(), source.blocks().end());
    num_nodes_ = source.num_nodes();
  }
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

FaceBalance& pass_all(FaceBalance& balance) {
  for (std::size_t block = 0; block < balance.blocks().size(); ++block) balance.visit(block, [](auto) {});
  return balance;
}

bool is_balanced(const Spoiled::Spoil& spoil) {
  mesh::PrismSource source(mesh::PrismMesh::from_parts(testing::sample_parts()));
  Spoiled spoiled(source, spoil);
  FaceBalance balance(spoiled);
  return pass_all(balance).is_balanced();
}

TEST(FaceBalance, HoldsForAMeshWithVoids) {
  EXPECT_TRUE(is_balanced([](std::size_t, auto&) {}));
}

TEST(FaceBalance, BreaksWithAnyOneChange) {
  mesh::PrismSource source(mesh::PrismMesh::from_parts(testing::sample_parts()));
  for (std::size_t block = 0; block < source.blocks().size(); ++block) {
    if (source.groups()[static_cast<std::size_t>(source.blocks()[block].group)].is_inner) continue;
    const auto width = static_cast<std::size_t>(mesh::nodes_of(source.blocks()[block].kind));
    const auto only_here = [&](auto change) {
      return [block, change, done = false](std::size_t at, std::vector<std::int64_t>& nodes) mutable {
        if (at == block && !std::exchange(done, true)) change(nodes);
      };
    };
    EXPECT_FALSE(is_balanced(only_here([](auto& nodes) { nodes[1] += 1; }))) << "a wrong node in block " << block;
    EXPECT_FALSE(is_balanced(only_here([](auto& nodes) { std::swap(nodes[0], nodes[1]); })))
        << "two corners swapped, " << block;
    EXPECT_FALSE(is_balanced(only_here([&](auto& nodes) { nodes.resize(nodes.size() - width); })))
        << "an element lost, " << block;
    EXPECT_FALSE(is_balanced(only_here([&](auto& nodes) {
      const std::vector<std::int64_t> first(nodes.begin(), nodes.begin() + static_cast<std::ptrdiff_t>(width));
      nodes.insert(nodes.end(), first.begin(), first.end());
    }))) << "an element twice, "
         << block;
  }
}

TEST(FaceBalance, TheOrderOfElementsAndTheirTurnsDoNotMatter) {
  mesh::PrismSource source(mesh::PrismMesh::from_parts(testing::sample_parts()));
  int num_changed = 0;
  EXPECT_TRUE(is_balanced([&](std::size_t block, std::vector<std::int64_t>& nodes) {
    if (source.blocks()[block].kind != mesh::ElementKind::wedge || nodes.size() < 12) return;
    std::rotate(nodes.begin(), nodes.begin() + 6, nodes.end());
    for (const std::size_t base : {0u, 3u}) std::rotate(&nodes[base], &nodes[base + 1], &nodes[base] + 3);
    ++num_changed;
  }));
  EXPECT_GT(num_changed, 0);
}

TEST(FaceBalance, SaysWhenItHasNotSeenAll) {
  mesh::PrismSource source(mesh::PrismMesh::from_parts(testing::sample_parts()));
  FaceBalance balance(source);
  EXPECT_FALSE(balance.is_complete());
  pass_all(balance);
  EXPECT_TRUE(balance.is_complete());
  EXPECT_EQ(balance.num_nodes(), source.num_nodes());
  EXPECT_EQ(balance.groups().size(), source.groups().size());
}

}  // namespace
}  // namespace pcbmesh::formats
