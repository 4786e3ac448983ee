// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/extrude/second_order_source.hpp"
#include "pcbmesh/extrude/tetrahedral_source.hpp"
#include "pcbmesh/mesh/mesh_data_source.hpp"
#include "pcbmesh/mesh/prism_source.hpp"
#include "pcbmesh/validation/report.hpp"
#include "sample_prism_mesh.hpp"
#include "thrown_error.hpp"

namespace pcbmesh::extrude {
namespace {

using mesh::ElementKind;
using Point = std::array<double, 3>;

std::vector<std::int64_t> rows_of(mesh::MeshSource& source, std::size_t block) {
  std::vector<std::int64_t> out;
  source.visit(block, [&](std::span<const std::int64_t> rows) {
    EXPECT_LE(rows.size(), mesh::MeshSource::chunk * static_cast<std::size_t>(mesh::nodes_of(source.blocks()[block].kind)));
    out.insert(out.end(), rows.begin(), rows.end());
  });
  return out;
}

std::vector<Point> nodes_of(mesh::MeshSource& source) {
  std::vector<Point> out(static_cast<std::size_t>(source.num_nodes()));
  source.fill_nodes(0, out);
  return out;
}

double volume(const Point& a, const Point& b, const Point& c, const Point& d) {
  const Point u{b[0] - a[0], b[1] - a[1], b[2] - a[2]}, v{c[0] - a[0], c[1] - a[1], c[2] - a[2]},
      w{d[0] - a[0], d[1] - a[1], d[2] - a[2]};
  return ((u[1] * v[2] - u[2] * v[1]) * w[0] + (u[2] * v[0] - u[0] * v[2]) * w[1] + (u[0] * v[1] - u[1] * v[0]) * w[2]) / 6;
}

void expect_sound(mesh::MeshSource& source) {
  const validation::Report report = validation::check(mesh::expand(source), nullptr);
  EXPECT_TRUE(report.passed()) << validation::to_text(report);
  EXPECT_EQ(report.num_cells, source.num_elements(3));
}

// D1, D2: the checker, which shares no code, finds neither a gap nor a fold; volumes of every tag are kept.
TEST(TetrahedralSource, TwinIsConformingWithTheSameVolumes_D1_D2) {
  const mesh::PrismMesh mesh = mesh::PrismMesh::from_parts(testing::sample_parts());
  mesh::PrismSource prisms(mesh, [](auto, double height, std::span<double> out) { std::ranges::fill(out, height); });
  TetrahedralSource twin(prisms);
  EXPECT_EQ(twin.num_nodes(), prisms.num_nodes());
  EXPECT_EQ(twin.num_elements(3), 3 * prisms.num_elements(3));
  EXPECT_EQ(twin.num_elements(2), mesh.num_tagged_triangles() + 2 * mesh.num_tagged_quads());
  expect_sound(twin);
  const std::vector<Point> nodes = nodes_of(twin);
  const auto at = [&](std::int64_t i) { return nodes[static_cast<std::size_t>(i)]; };
  for (std::size_t b = 0; b < twin.blocks().size(); ++b) {
    if (twin.blocks()[b].kind != ElementKind::tetrahedron) continue;
    const std::vector<std::int64_t> rows = rows_of(twin, b);
    ASSERT_EQ(static_cast<std::int64_t>(rows.size()), 4 * twin.blocks()[b].count);
    double sum = 0;
    for (std::size_t i = 0; i < rows.size(); i += 4) {
      const double v = volume(at(rows[i]), at(rows[i + 1]), at(rows[i + 2]), at(rows[i + 3]));
      EXPECT_GT(v, 0);
      sum += v;
    }
    const auto tag = std::ranges::find(mesh.volume_tags(), twin.blocks()[b].tag, &mesh::VolumeTag::id);
    EXPECT_NEAR(sum, tag->volume_m3, 1e-12 * tag->volume_m3);
    std::int64_t num_values = 0;
    twin.visit_field(b, mesh::CellField::quality,
                     [&](std::span<const double> values) { num_values += static_cast<std::int64_t>(values.size()); });
    EXPECT_EQ(num_values, twin.blocks()[b].count);
  }
}

// Whatever the numbers of its corners, the three pieces fill a wedge and no two neighbours disagree about a diagonal.
TEST(TetrahedralSource, EveryOrderOfTheCornersIsCutByItsSmallest) {
  const std::array<Point, 6> corner{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}}};
  constexpr int sides[3][4] = {{0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}};
  std::array<std::int64_t, 6> ids{0, 1, 2, 3, 4, 5};
  do {
    const auto pieces = split_wedge(ids);
    double sum = 0;
    std::set<std::pair<int, int>> edges;
    for (const auto& p : pieces) {
      const double v = volume(corner[p[0]], corner[p[1]], corner[p[2]], corner[p[3]]);
      EXPECT_NEAR(v, 1.0 / 6, 1e-15);
      sum += v;
      for (int a : p)
        for (int b : p) edges.emplace(a, b);
    }
    EXPECT_NEAR(sum, 0.5, 1e-15);
    for (const auto& s : sides) {
      int least = 0;
      for (int k = 1; k < 4; ++k)
        if (ids[static_cast<std::size_t>(s[k])] < ids[static_cast<std::size_t>(s[least])]) least = k;
      EXPECT_TRUE(edges.contains({s[least], s[(least + 2) % 4]}));
      EXPECT_FALSE(edges.contains({s[(least + 1) % 4], s[(least + 3) % 4]}));
    }
  } while (std::ranges::next_permutation(ids).found);
}

TEST(TetrahedralSource, RefusesWhatItCannotCut) {
  mesh::MeshData data;
  data.nodes.resize(8);
  data.cells.push_back({mesh::CellKind::hexahedron, {0, 1, 2, 3, 4, 5, 6, 7}, {1}});
  mesh::MeshDataSource hexahedra(data);
  EXPECT_EQ(testing::error_of([&] { TetrahedralSource{hexahedra}; }).code(), ErrorCode::format_limit);
}

/// Every node of second order is the middle of what its place in the element says.
void expect_middles(mesh::MeshSource& source) {
  const std::vector<Point> nodes = nodes_of(source);
  const std::map<ElementKind, std::vector<std::vector<int>>> middles{
      {ElementKind::triangle6, {{0, 1}, {1, 2}, {2, 0}}},
      {ElementKind::quadrangle8, {{0, 1}, {1, 2}, {2, 3}, {3, 0}}},
      {ElementKind::quadrangle9, {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 1, 2, 3}}},
      {ElementKind::tetrahedron10, {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {2, 3}, {1, 3}}},
      {ElementKind::wedge15, {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 4}, {2, 5}, {3, 4}, {3, 5}, {4, 5}}},
      {ElementKind::wedge18,
       {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 4}, {2, 5}, {3, 4}, {3, 5}, {4, 5}, {0, 1, 4, 3}, {0, 2, 5, 3}, {1, 2, 5, 4}}}};
  std::vector<int> uses(nodes.size(), 0);
  for (std::size_t b = 0; b < source.blocks().size(); ++b) {
    const ElementKind kind = source.blocks()[b].kind;
    const auto width = static_cast<std::size_t>(mesh::nodes_of(kind));
    const auto corners = static_cast<std::size_t>(mesh::corners_of(kind));
    const std::vector<std::int64_t> rows = rows_of(source, b);
    ASSERT_EQ(static_cast<std::int64_t>(rows.size()), source.blocks()[b].count * mesh::nodes_of(kind));
    for (std::size_t r = 0; r < rows.size(); r += width) {
      for (std::size_t i = 0; i < width; ++i) ++uses[static_cast<std::size_t>(rows[r + i])];
      for (std::size_t m = 0; m + corners < width; ++m) {
        Point sum{};
        const auto& of = middles.at(kind)[m];
        for (const int c : of)
          for (std::size_t k = 0; k < 3; ++k)
            sum[k] +=
                nodes[static_cast<std::size_t>(rows[r + static_cast<std::size_t>(c)])][k] / static_cast<double>(of.size());
        for (std::size_t k = 0; k < 3; ++k)
          EXPECT_NEAR(nodes[static_cast<std::size_t>(rows[r + corners + m])][k], sum[k], 1e-15) << mesh::name_of(kind);
      }
    }
  }
  EXPECT_EQ(std::ranges::count(uses, 0), 0) << "nodes without an element";
}

// Q1 and Q3, with voids: numbers by arithmetic agree with what each element says its middles are.
TEST(SecondOrderSource, EveryMiddleIsWhereItsElementSays_Q1_Q3) {
  for (const bool with_voids : {false, true}) {
    const mesh::PrismMesh mesh = mesh::PrismMesh::from_parts(testing::sample_parts(with_voids));
    for (const bool with_face_nodes : {false, true}) {
      SecondOrderSource source(mesh, {.with_face_nodes = with_face_nodes});
      expect_middles(source);
      expect_sound(source);
      std::vector<Point> corners(static_cast<std::size_t>(mesh.num_nodes()));
      mesh.fill_nodes(0, corners);
      const std::vector<Point> nodes = nodes_of(source);
      EXPECT_TRUE(std::equal(corners.begin(), corners.end(), nodes.begin()));
      // Pieces of any size give the same nodes.
      for (const std::int64_t size : {1, 7, 64}) {
        std::vector<Point> piecewise(nodes.size());
        for (std::int64_t first = 0; first < source.num_nodes(); first += size)
          source.fill_nodes(first,
                            std::span(piecewise).subspan(static_cast<std::size_t>(first),
                                                         static_cast<std::size_t>(std::min(size, source.num_nodes() - first))));
        EXPECT_EQ(piecewise, nodes);
      }
      if (!with_face_nodes) continue;
      TetrahedralSource twin(source);
      expect_middles(twin);
      expect_sound(twin);
    }
  }
}

/// A disc of `n` chords in a square, one slab. The chord from corner 0 to 1 can be moved.
mesh::PrismMeshParts disc_parts(int n, double radius) {
  mesh::PrismMeshParts parts = testing::plain_parts(1, 1, 2);
  mesh::PlanarMeshParts planar;
  planar.points_m.push_back({0, 0});
  for (int i = 0; i < n; ++i)
    planar.points_m.push_back(
        {radius * std::cos(2 * std::numbers::pi * i / n), radius * std::sin(2 * std::numbers::pi * i / n)});
  for (int i = 0; i < n; ++i) {
    planar.triangles.push_back({0, 1 + i, 1 + (i + 1) % n});
    planar.regions.push_back(0);
    planar.constrained.push_back({std::min(1 + i, 1 + (i + 1) % n), std::max(1 + i, 1 + (i + 1) % n)});
  }
  std::ranges::sort(planar.constrained);
  planar.region_body_offsets = {0, 0};
  parts.planar = mesh::PlanarMesh::from_parts(std::move(planar));
  parts.caps.clear();
  parts.walls.clear();
  parts.volume_tags = {{1, "v"}};
  parts.face_tags = {{1, "f"}};
  testing::add_boundary_by_neighbours(parts);
  std::ranges::sort(parts.caps, {}, [](const mesh::Cap& c) { return std::tuple(c.tag, c.level, c.triangle); });
  std::ranges::sort(parts.walls, {}, [](const mesh::Wall& w) { return std::tuple(w.tag, w.slab, w.a, w.b); });
  testing::fill_tag_sizes(parts);
  return parts;
}

// Q2 and the tolerance: what bends and what does not.
TEST(SecondOrderSource, ChordsBendOntoTheirCircle_Q2) {
  const double radius = 1e-3, sagitta = radius * (1 - std::cos(std::numbers::pi / 16));
  const mesh::PrismMesh mesh = mesh::PrismMesh::from_parts(disc_parts(16, radius));
  SecondOrderOptions options;
  options.circles = {{{0, 0}, radius}};
  options.longest_sagitta_m = sagitta;
  options.for_tetrahedra = true;
  SecondOrderSource source(mesh, options);
  EXPECT_EQ(source.statistics().num_curved_edges, 16);
  EXPECT_EQ(source.statistics().num_folded_triangles, 0);
  const std::vector<Point> nodes = nodes_of(source);
  std::int64_t num_on_circle = 0;
  for (const Point& node : nodes) num_on_circle += std::abs(std::hypot(node[0], node[1]) - radius) < 1e-16 ? 1 : 0;
  // Corners and middles on three levels, verticals and faces in two sub-layers.
  EXPECT_EQ(num_on_circle, 3 * (16 + 16) + 2 * (16 + 16));
  // Another circle, a circle with too long chords, a circle the ends miss: nothing bends.
  for (const Circle& other : {Circle{{5e-3, 0}, radius}, Circle{{0, 0}, radius * 1.003}}) {
    options.circles = {other};
    EXPECT_EQ(SecondOrderSource(mesh, options).statistics().num_curved_edges, 0);
  }
  options.circles = {{{0, 0}, radius}};
  options.longest_sagitta_m = sagitta / 3;
  EXPECT_EQ(SecondOrderSource(mesh, options).statistics().num_curved_edges, 0);
}

// Q2: a corner that nearly touches the arc of the opposite side would fold the triangle: the chord stays straight, and is
// counted.
TEST(SecondOrderSource, WhatWouldFoldStaysStraight_Q2) {
  const double radius = 1e-3;
  mesh::PrismMeshParts parts = disc_parts(8, radius);
  mesh::PlanarMeshParts planar;
  planar.points_m.assign(parts.planar.points_m().begin(), parts.planar.points_m().end());
  planar.triangles.assign(parts.planar.triangles().begin(), parts.planar.triangles().end());
  planar.regions.assign(parts.planar.regions().begin(), parts.planar.regions().end());
  planar.constrained.assign(parts.planar.constrained().begin(), parts.planar.constrained().end());
  planar.region_body_offsets = {0, 0};
  // A flat triangle outside the chord between points 1 and 2, flatter than the arc: it would be turned inside out.
  const auto &p = planar.points_m[1], &q = planar.points_m[2];
  const double inside = radius * std::cos(std::numbers::pi / 8);
  const double reach = (inside + 0.5 * (radius - inside)) / inside;
  planar.points_m.push_back({(p[0] + q[0]) / 2 * reach, (p[1] + q[1]) / 2 * reach});
  planar.triangles.push_back({1, 9, 2});
  planar.regions.push_back(0);
  parts.planar = mesh::PlanarMesh::from_parts(std::move(planar));
  parts.caps.clear();
  parts.walls.clear();
  parts.volume_tags = {{1, "v"}};
  parts.face_tags = {{1, "f"}};
  testing::add_boundary_by_neighbours(parts);
  std::ranges::sort(parts.caps, {}, [](const mesh::Cap& c) { return std::tuple(c.tag, c.level, c.triangle); });
  std::ranges::sort(parts.walls, {}, [](const mesh::Wall& w) { return std::tuple(w.tag, w.slab, w.a, w.b); });
  testing::fill_tag_sizes(parts);
  SecondOrderOptions options;
  options.circles = {{{0, 0}, radius}};
  options.longest_sagitta_m = radius - inside;
  SecondOrderSource source(mesh::PrismMesh::from_parts(parts), options);
  EXPECT_EQ(source.statistics().num_curved_edges, 7);
  EXPECT_EQ(source.statistics().num_straightened_edges, 1);
  EXPECT_EQ(source.statistics().num_folded_triangles, 1);
}

TEST(MeshDataSource, HandsBackWhatAnySourceHeld) {
  const mesh::PrismMesh mesh = mesh::PrismMesh::from_parts(testing::sample_parts());
  for (const int variant : {0, 1, 2, 3}) {
    mesh::PrismSource prisms(mesh);
    SecondOrderSource second(mesh, {.with_face_nodes = variant == 3});
    TetrahedralSource twin(prisms);
    mesh::MeshSource& before = variant == 0   ? static_cast<mesh::MeshSource&>(prisms)
                               : variant == 1 ? static_cast<mesh::MeshSource&>(twin)
                                              : second;
    const mesh::MeshData data = mesh::expand(before);
    mesh::MeshDataSource after(data);
    ASSERT_EQ(after.blocks().size(), before.blocks().size());
    ASSERT_EQ(after.groups().size(), before.groups().size());
    EXPECT_EQ(nodes_of(after), nodes_of(before));
    EXPECT_EQ(after.num_untagged_cells(), 0);
    for (std::size_t b = 0; b < after.blocks().size(); ++b) {
      EXPECT_EQ(after.blocks()[b].kind, before.blocks()[b].kind);
      EXPECT_EQ(rows_of(after, b), rows_of(before, b));
    }
    for (std::size_t g = 0; g < after.groups().size(); ++g) {
      EXPECT_EQ(after.groups()[g].name, before.groups()[g].name);
      EXPECT_EQ(after.groups()[g].num_elements, before.groups()[g].num_elements);
    }
  }
}

// Every source looks for a group's box in its own way; here it is taken from the nodes that the source hands out.
TEST(MeshSource, ExtentsHoldEveryNodeOfTheirGroup) {
  const auto expect_extents = [](mesh::MeshSource& source, bool is_tight) {
    const std::vector<Point> nodes = nodes_of(source);
    for (std::size_t g = 0; g < source.groups().size(); ++g) {
      const mesh::Extent extent = source.extent_of(g);
      std::vector<Point> held;
      for (std::size_t b = 0; b < source.blocks().size(); ++b)
        if (static_cast<std::size_t>(source.blocks()[b].group) == g)
          for (const std::int64_t node : rows_of(source, b)) held.push_back(nodes[static_cast<std::size_t>(node)]);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto [low, high] = std::ranges::minmax_element(held, {}, [&](const Point& p) { return p[axis]; });
        const double min = held.empty() ? 0 : (*low)[axis], max = held.empty() ? 0 : (*high)[axis];
        if (is_tight) {
          EXPECT_EQ(std::pair(extent.min[axis], extent.max[axis]), std::pair(min, max)) << source.groups()[g].name << axis;
        } else {
          EXPECT_LE(extent.min[axis], min);
          EXPECT_GE(extent.max[axis], max);
          EXPECT_LE(extent.max[axis] - extent.min[axis], 1.1 * (max - min));
        }
      }
    }
  };
  mesh::PrismMeshParts with_empty = testing::sample_parts();
  with_empty.volume_tags.push_back({static_cast<std::int32_t>(with_empty.volume_tags.size()) + 1, "nowhere", 0, 0});
  for (const mesh::PrismMeshParts& parts : {with_empty, disc_parts(16, 1e-3)}) {
    const mesh::PrismMesh mesh = mesh::PrismMesh::from_parts(parts);
    mesh::PrismSource prisms(mesh);
    expect_extents(prisms, true);
    TetrahedralSource twin(prisms);
    expect_extents(twin, true);
    SecondOrderOptions options;
    options.circles = {{{0, 0}, 1e-3}};
    options.longest_sagitta_m = 1e-4;
    SecondOrderSource second(mesh, options);
    expect_extents(second, false);
    const mesh::MeshData data = mesh::expand(second);
    mesh::MeshDataSource read(data);
    expect_extents(read, true);
  }
}

TEST(MeshDataSource, UntaggedCellsBecomeAGroupOfTheirOwn) {
  mesh::MeshData data;
  data.nodes.resize(8);
  data.cells.push_back({mesh::CellKind::tetrahedron, {0, 1, 2, 3, 1, 2, 3, 4, 2, 3, 4, 5}, {4, 0, 4}});
  data.cells.push_back({mesh::CellKind::pyramid, {0, 1, 2, 3, 4}, {0}});
  data.names = {{3, 4, "air"}, {3, 9, "nowhere"}};
  mesh::MeshDataSource source(data);
  ASSERT_EQ(source.groups().size(), 3u);
  EXPECT_EQ(source.num_untagged_cells(), 2);
  EXPECT_EQ(source.groups()[0].name, "air");
  EXPECT_EQ(source.groups()[1].num_elements, 0);
  EXPECT_EQ(source.groups()[2].name, "untagged");
  EXPECT_EQ(source.groups()[2].tag, 10);
  ASSERT_EQ(source.blocks().size(), 3u);
  EXPECT_EQ(rows_of(source, 0), (std::vector<std::int64_t>{0, 1, 2, 3, 2, 3, 4, 5}));
  EXPECT_EQ(rows_of(source, 1), (std::vector<std::int64_t>{1, 2, 3, 4}));
  EXPECT_EQ(source.blocks()[2].kind, ElementKind::pyramid);
}

}  // namespace
}  // namespace pcbmesh::extrude
