// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "pcbmesh/mesh/mesh_data.hpp"
#include "pcbmesh/mesh/mesh_source.hpp"

namespace pcbmesh::testing {

struct WhatIsThere {
  bool faces = true;
  bool names = false;
};

/// A mesh that was read holds exactly the elements of the source, with their tags; nodes in the source's order.
inline void expect_same_mesh(mesh::MeshSource& source, const mesh::MeshData& read, double scale, WhatIsThere what = {}) {
  ASSERT_EQ(static_cast<std::int64_t>(read.nodes.size()), source.num_nodes());
  std::vector<std::array<double, 3>> nodes(read.nodes.size());
  source.fill_nodes(0, nodes);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) ASSERT_EQ(read.nodes[i][k], nodes[i][k] * scale) << "node " << i;
  using Elements = std::multiset<std::pair<std::int32_t, std::vector<std::int64_t>>>;
  Elements wanted[2], found[2];
  for (std::size_t b = 0; b < source.blocks().size(); ++b) {
    const mesh::ElementBlock& block = source.blocks()[b];
    const auto width = static_cast<std::size_t>(mesh::nodes_of(block.kind));
    source.visit(b, [&](std::span<const std::int64_t> rows) {
      for (std::size_t at = 0; at < rows.size(); at += width)
        wanted[mesh::dimension_of(block.kind) - 2].emplace(
            block.tag, std::vector<std::int64_t>(rows.begin() + static_cast<std::ptrdiff_t>(at),
                                                 rows.begin() + static_cast<std::ptrdiff_t>(at + width)));
    });
  }
  const auto collect = [](const auto& blocks, Elements& out) {
    for (const auto& block : blocks) {
      const int width = corners_of(block.kind);
      for (std::size_t i = 0; i < block.tags.size(); ++i) {
        const auto first = block.corners.begin() + static_cast<std::ptrdiff_t>(i) * width;
        out.emplace(block.tags[i], std::vector<std::int64_t>(first, first + width));
      }
    }
  };
  collect(read.faces, found[0]);
  collect(read.cells, found[1]);
  EXPECT_TRUE(found[1] == wanted[1]) << found[1].size() << " cells where " << wanted[1].size() << " are expected";
  if (what.faces)
    EXPECT_TRUE(found[0] == wanted[0]) << found[0].size() << " faces where " << wanted[0].size() << " are expected";
  else
    EXPECT_TRUE(found[0].empty());
  if (!what.names) return;
  std::set<std::tuple<int, std::int32_t, std::string>> names, expected;
  for (const mesh::ElementGroup& group : source.groups())
    if (what.faces || group.dimension == 3) expected.emplace(group.dimension, group.tag, group.name);
  for (const mesh::GroupName& name : read.names) names.emplace(name.dimension, name.tag, name.name);
  EXPECT_EQ(names, expected);
}

}  // namespace pcbmesh::testing
