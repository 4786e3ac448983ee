// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "explicit_mesh.hpp"
#include "sample_prism_mesh.hpp"

/// A box of prisms over a criss-cross grid, its six sides tagged: the plainest mesh with conditions and ports on it.
namespace pcbmesh::testing {

struct Box {
  std::array<int, 3> cells{8, 8, 8};
  std::array<double, 3> size_m{1, 1, 1};
  board::Material material{"dielectric", 1, 0, 1, 0};
  std::array<mesh::BoundaryCondition, 6> sides{};  ///< zmin zmax xmin xmax ymin ymax
  std::vector<mesh::Port> ports{};
  std::array<std::int32_t, 6> port_of_side{-1, -1, -1, -1, -1, -1};
};

inline mesh::PrismMeshParts box_parts(const Box& box) {
  const auto [nx, ny, nz] = box.cells;
  mesh::PlanarMeshParts plane;
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i) plane.points_m.push_back({box.size_m[0] * i / nx, box.size_m[1] * j / ny});
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const std::int32_t a = j * (nx + 1) + i, b = a + 1, c = a + nx + 2, d = a + nx + 1;
      if ((i + j) % 2 != 0)
        plane.triangles.insert(plane.triangles.end(), {{a, b, c}, {a, c, d}});
      else
        plane.triangles.insert(plane.triangles.end(), {{a, b, d}, {b, c, d}});
    }
  plane.regions.assign(plane.triangles.size(), 0);
  plane.region_body_offsets = {0, 0};
  mesh::PrismMeshParts parts;
  parts.planar = mesh::PlanarMesh::from_parts(std::move(plane));
  parts.plan = even_plan({nz}, box.size_m[2] / nz);
  parts.layers = {"core"};
  parts.materials = {box.material};
  parts.volume_tags = {{1, "core|" + box.material.name + "|none"}};
  parts.column_tags = {0};
  parts.ports = box.ports;
  const std::array<const char*, 6> names{"zmin", "zmax", "xmin", "xmax", "ymin", "ymax"};
  for (std::size_t i = 0; i < 6; ++i) {
    mesh::FaceTag tag;
    tag.id = static_cast<std::int32_t>(i) + 1;
    tag.name = names[i];
    tag.condition = box.sides[i];
    tag.port = box.port_of_side[i];
    if (tag.port >= 0) tag.kind = mesh::FaceTagKind::port;
    parts.face_tags.push_back(tag);
  }
  add_boundary_by_neighbours(parts);
  for (mesh::Cap& cap : parts.caps) cap.tag = cap.up ? 1 : 0;
  for (mesh::Wall& wall : parts.walls) {
    const auto column = [&](std::int32_t v) { return v % (nx + 1); };
    const auto row = [&](std::int32_t v) { return v / (nx + 1); };
    const auto both = [&](auto of, int value) { return of(wall.a) == value && of(wall.b) == value; };
    wall.tag = both(column, 0) ? 2 : both(column, nx) ? 3 : both(row, 0) ? 4 : 5;
  }
  std::ranges::sort(parts.caps, {}, [](const mesh::Cap& c) { return std::tuple(c.tag, c.level, c.triangle); });
  std::ranges::sort(parts.walls, {}, [](const mesh::Wall& w) { return std::tuple(w.tag, w.slab, w.a, w.b); });
  fill_tag_sizes(parts);
  return parts;
}

}  // namespace pcbmesh::testing
