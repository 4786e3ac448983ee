// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <string>
#include <tuple>
#include <vector>

#include "explicit_mesh.hpp"

/// A small tagged prism mesh with voids, and its tables: what every format must carry.
namespace pcbmesh::testing {

/// Recomputes counts and sizes of all tags from the cells and faces.
inline void fill_tag_sizes(mesh::PrismMeshParts& parts) {
  const auto num_slabs = static_cast<std::size_t>(parts.plan.num_slabs());
  for (std::size_t s = 0; s < num_slabs; ++s) {
    const std::int32_t low = parts.plan.first_sublayer(static_cast<std::int32_t>(s));
    const std::int32_t high = parts.plan.first_sublayer(static_cast<std::int32_t>(s) + 1);
    const double height = parts.plan.z_m()[static_cast<std::size_t>(high)] - parts.plan.z_m()[static_cast<std::size_t>(low)];
    for (std::int32_t t = 0; t < parts.planar.num_triangles(); ++t) {
      const auto region = static_cast<std::size_t>(parts.planar.regions()[static_cast<std::size_t>(t)]);
      const std::int32_t tag = parts.column_tags[region * num_slabs + s];
      if (tag < 0) continue;
      parts.volume_tags[static_cast<std::size_t>(tag)].num_prisms += high - low;
      parts.volume_tags[static_cast<std::size_t>(tag)].volume_m3 += parts.planar.area_m2(t) * height;
    }
    for (const mesh::Wall& wall : parts.walls) {
      if (wall.slab != static_cast<std::int32_t>(s)) continue;
      const auto &a = parts.planar.points_m()[static_cast<std::size_t>(wall.a)],
                 &b = parts.planar.points_m()[static_cast<std::size_t>(wall.b)];
      parts.face_tags[static_cast<std::size_t>(wall.tag)].num_quads += high - low;
      parts.face_tags[static_cast<std::size_t>(wall.tag)].area_m2 += std::hypot(b[0] - a[0], b[1] - a[1]) * height;
    }
  }
  for (const mesh::Cap& cap : parts.caps) {
    ++parts.face_tags[static_cast<std::size_t>(cap.tag)].num_triangles;
    parts.face_tags[static_cast<std::size_t>(cap.tag)].area_m2 += parts.planar.area_m2(cap.triangle);
  }
}

/// 6 x 4 squares in 6 regions, 3 slabs of 1, 3 and 2 sub-layers of unequal heights. Region 1 is void in slab 1 (a hollow conductor), region 5 in
/// slabs 1 and 2 (a step of the outer shape). Volume tag 2 lives in two slabs.
inline mesh::PrismMeshParts sample_parts(bool with_voids = true) {
  mesh::PrismMeshParts parts;
  parts.planar = grid(
      6, 4, 1e-3 / 3, 7e-4, [](int i, int j) { return i / 2 + 3 * (j / 2); }, std::vector<std::vector<std::int32_t>>(6));
  // Sub-layers of a slab differ in height, as grading makes them.
  constexpr double z_m = 1e-4 / 3;
  parts.plan = mesh::LayerPlan::from_parts({{0, z_m, 1.5 * z_m, 3 * z_m, 4 * z_m, 5.5 * z_m, 6 * z_m}, {0, 1, 1, 1, 2, 2}});
  parts.layers = {"bottom", "core", "top"};
  parts.materials = {{"FR4", 4.4, 0.02, 1, 0}, {"copper", 1, 0, 1, 5.8e7}, {"air"}};
  parts.nets = {"GND", "/clk+", "unused", "hollow"};
  parts.net_pieces = {2, -1, 0, -1};
  parts.touching_nets = {{0, 1}};
  parts.volume_tags = {{1, "bottom|FR4|none", 0, 0, -1},
                       {2, "bottom|copper|GND", 0, 1, 0},
                       {3, "core|FR4|none", 1, 0, -1},
                       {4, "core|copper|/clk+", 1, 1, 1},
                       {5, "top|air|none", 2, 2, -1}};
  parts.face_tags = {{1, "zmin"}, {2, "zmax"}, {3, "side"}, {4, "surface|hollow", mesh::FaceTagKind::conductor, 3}};
  // Three slabs per region.
  parts.column_tags = {0, 2, 4, 1, 2, 4, 0, 3, 4, 0, 2, 1, 1, 2, 4, 0, 2, 4};
  if (with_voids) parts.column_tags[1 * 3 + 1] = parts.column_tags[5 * 3 + 1] = parts.column_tags[5 * 3 + 2] = -1;
  add_boundary_by_neighbours(parts);
  const std::int32_t top = parts.plan.num_sublayers();
  const auto hollow = [&](std::int32_t region) { return with_voids && region == 1; };
  for (mesh::Cap& cap : parts.caps) {
    const std::int32_t region = parts.planar.regions()[static_cast<std::size_t>(cap.triangle)];
    cap.tag = cap.level == 0 ? 0 : cap.level == top ? 1 : hollow(region) ? 3 : 2;
  }
  const auto is_on_hollow = [&](std::int32_t v) {  // the block of region 1: columns 2..4, rows 0..2
    const std::int32_t i = v % 7, j = v / 7;
    return i >= 2 && i <= 4 && j <= 2;
  };
  for (mesh::Wall& wall : parts.walls) {
    const bool outside = wall.a / 7 == 0 && wall.b / 7 == 0;
    wall.tag = with_voids && wall.slab == 1 && is_on_hollow(wall.a) && is_on_hollow(wall.b) && !outside ? 3 : 2;
  }
  std::ranges::sort(parts.caps, {}, [](const mesh::Cap& c) { return std::tuple(c.tag, c.level, c.triangle); });
  std::ranges::sort(parts.walls, {}, [](const mesh::Wall& w) { return std::tuple(w.tag, w.slab, w.a, w.b); });
  fill_tag_sizes(parts);
  return parts;
}

/// nx x ny squares in one region and one slab of `sublayers`; tags "v" and "f".
inline mesh::PrismMeshParts plain_parts(int nx, int ny, int sublayers) {
  mesh::PrismMeshParts parts;
  parts.planar = grid(
      nx, ny, 1e-3, 1e-3, [](int, int) { return 0; }, std::vector<std::vector<std::int32_t>>(1));
  parts.plan = even_plan({sublayers}, 1e-4);
  parts.layers = {"L"};
  parts.materials = {{"m"}};
  parts.volume_tags = {{1, "v"}};
  parts.face_tags = {{1, "f"}};
  parts.column_tags = {0};
  add_boundary_by_neighbours(parts);
  std::ranges::sort(parts.caps, {}, [](const mesh::Cap& c) { return std::tuple(c.tag, c.level, c.triangle); });
  std::ranges::sort(parts.walls, {}, [](const mesh::Wall& w) { return std::tuple(w.tag, w.slab, w.a, w.b); });
  fill_tag_sizes(parts);
  return parts;
}

}  // namespace pcbmesh::testing
