// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "pcbmesh/mesh/prism_mesh.hpp"

/// Hand-made planar meshes, and prism meshes spelt out node by node and face by face to judge the implicit one.
namespace pcbmesh::testing {

/// Region of the grid square (i, j).
using RegionOfSquare = std::function<std::int32_t(int i, int j)>;

/// nx x ny squares of dx x dy metres from (0, 0), each cut by a random diagonal. `bodies[r]` = bodies of region r.
inline mesh::PlanarMesh grid(int nx, int ny, double dx, double dy, const RegionOfSquare& region,
                             const std::vector<std::vector<std::int32_t>>& bodies, unsigned seed = 1) {
  mesh::PlanarMeshParts parts;
  std::mt19937 random(seed);
  for (int j = 0; j <= ny; ++j) {
    for (int i = 0; i <= nx; ++i) parts.points_m.push_back({i * dx, j * dy});
  }
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      const std::int32_t a = j * (nx + 1) + i, b = a + 1, c = a + nx + 2, d = a + nx + 1;
      if (random() % 2 == 0) {
        parts.triangles.insert(parts.triangles.end(), {{a, b, c}, {a, c, d}});
      } else {
        parts.triangles.insert(parts.triangles.end(), {{b, c, d}, {b, d, a}});
      }
      parts.regions.insert(parts.regions.end(), 2, region(i, j));
    }
  }
  parts.region_body_offsets.push_back(0);
  for (const auto& present : bodies) {
    parts.region_bodies.insert(parts.region_bodies.end(), present.begin(), present.end());
    parts.region_body_offsets.push_back(static_cast<std::int32_t>(parts.region_bodies.size()));
  }
  std::map<std::pair<std::int32_t, std::int32_t>, std::set<std::int32_t>> around;
  std::map<std::pair<std::int32_t, std::int32_t>, int> uses;
  for (std::size_t t = 0; t < parts.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::pair<std::int32_t, std::int32_t> edge = std::minmax(parts.triangles[t][k], parts.triangles[t][(k + 1) % 3]);
      around[edge].insert(parts.regions[t]);
      ++uses[edge];
    }
  }
  for (const auto& [edge, regions] : around) {
    if (regions.size() > 1 || uses[edge] == 1) parts.constrained.push_back({edge.first, edge.second});
  }
  return mesh::PlanarMesh::from_parts(std::move(parts));
}

/// Slabs of the given numbers of sub-layers, all of one height.
inline mesh::LayerPlan even_plan(const std::vector<int>& sublayers, double height_m) {
  mesh::LayerPlanParts parts;
  parts.z_m.push_back(0);
  for (std::size_t s = 0; s < sublayers.size(); ++s) {
    for (int k = 0; k < sublayers[s]; ++k) {
      parts.slab.push_back(static_cast<std::int32_t>(s));
      parts.z_m.push_back(static_cast<double>(parts.slab.size()) * height_m);
    }
  }
  return mesh::LayerPlan::from_parts(std::move(parts));
}

/// Caps and walls, all of face tag 0, found by looking at every neighbour of every cell.
inline void add_boundary_by_neighbours(mesh::PrismMeshParts& parts) {
  const mesh::PlanarMesh& planar = parts.planar;
  const mesh::LayerPlan& plan = parts.plan;
  const auto present = [&](std::int32_t slab, std::int32_t t) {
    if (slab < 0 || slab >= plan.num_slabs() || t < 0) return false;
    const auto region = static_cast<std::size_t>(planar.regions()[static_cast<std::size_t>(t)]);
    return parts.column_tags[region * static_cast<std::size_t>(plan.num_slabs()) + static_cast<std::size_t>(slab)] >= 0;
  };
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> left_of;
  for (std::int32_t t = 0; t < planar.num_triangles(); ++t) {
    const auto& corners = planar.triangles()[static_cast<std::size_t>(t)];
    for (std::size_t i = 0; i < 3; ++i) left_of[{corners[i], corners[(i + 1) % 3]}] = t;
  }
  for (std::int32_t slab = 0; slab <= plan.num_slabs(); ++slab) {
    for (std::int32_t t = 0; t < planar.num_triangles(); ++t) {
      if (present(slab - 1, t) != present(slab, t)) {
        parts.caps.push_back({0, plan.first_sublayer(slab), t, present(slab - 1, t)});
      }
    }
    for (const auto& [edge, t] : left_of) {
      const auto mate = left_of.find({edge.second, edge.first});
      const bool has_mate = mate != left_of.end() && present(slab, mate->second);
      if (present(slab, t) && !has_mate) parts.walls.push_back({0, slab, edge.first, edge.second});
    }
  }
}

/// The mesh by definition: every present prism and node in maps, ids counted one by one.
struct ExplicitMesh {
  std::map<std::pair<std::int32_t, std::int32_t>, std::int64_t> node_ids;  ///< (level, vertex)
  std::vector<std::array<double, 3>> nodes;
  std::vector<std::array<std::int64_t, 6>> prisms;
  std::vector<std::int32_t> tags;
  std::vector<std::pair<std::int32_t, std::int32_t>> cells;  ///< (sub-layer, triangle)
};

inline ExplicitMesh spell_out(const mesh::PlanarMesh& planar, const mesh::LayerPlan& plan,
                              const std::vector<std::int32_t>& column_tags) {
  ExplicitMesh out;
  std::set<std::pair<std::int32_t, std::int32_t>> wanted;
  for (std::int32_t k = 0; k < plan.num_sublayers(); ++k) {
    const std::int32_t slab = plan.slab_of_sublayer()[static_cast<std::size_t>(k)];
    for (std::int32_t t = 0; t < planar.num_triangles(); ++t) {
      const std::int32_t tag =
          column_tags[static_cast<std::size_t>(planar.regions()[static_cast<std::size_t>(t)] * plan.num_slabs() + slab)];
      if (tag < 0) continue;
      out.cells.emplace_back(k, t);
      out.tags.push_back(tag);
      for (std::int32_t v : planar.triangles()[static_cast<std::size_t>(t)]) {
        wanted.emplace(k, v);
        wanted.emplace(k + 1, v);
      }
    }
  }
  for (const auto& [level, vertex] : wanted) {
    out.node_ids[{level, vertex}] = static_cast<std::int64_t>(out.nodes.size());
    const auto& point = planar.points_m()[static_cast<std::size_t>(vertex)];
    out.nodes.push_back({point[0], point[1], plan.z_m()[static_cast<std::size_t>(level)]});
  }
  for (const auto& [k, t] : out.cells) {
    const auto& [a, b, c] = planar.triangles()[static_cast<std::size_t>(t)];
    out.prisms.push_back({out.node_ids.at({k, a}), out.node_ids.at({k, b}), out.node_ids.at({k, c}),
                          out.node_ids.at({k + 1, a}), out.node_ids.at({k + 1, b}), out.node_ids.at({k + 1, c})});
  }
  return out;
}

/// Faces of prisms as node sets, each with the oriented corner lists (outward) of the prisms that have it.
using FaceMap = std::map<std::vector<std::int64_t>, std::vector<std::vector<std::int64_t>>>;

inline FaceMap faces_of(const std::vector<std::array<std::int64_t, 6>>& prisms) {
  static const std::vector<std::vector<std::size_t>> sides{{0, 2, 1}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}};
  FaceMap faces;
  for (const auto& prism : prisms) {
    for (const auto& side : sides) {
      std::vector<std::int64_t> corners;
      for (std::size_t corner : side) corners.push_back(prism[corner]);
      auto sorted = corners;
      std::sort(sorted.begin(), sorted.end());
      faces[sorted].push_back(corners);
    }
  }
  return faces;
}

/// The same cycle of corners, started at the smallest.
inline std::vector<std::int64_t> turned(std::vector<std::int64_t> corners) {
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  return corners;
}

/// Caps and walls of `mesh` as oriented corner lists, outward.
inline std::vector<std::vector<std::int64_t>> boundary_faces(const mesh::PrismMesh& mesh) {
  std::vector<std::vector<std::int64_t>> faces;
  for (const mesh::Cap& cap : mesh.caps()) {
    const auto& [a, b, c] = mesh.planar().triangles()[static_cast<std::size_t>(cap.triangle)];
    std::vector<std::int64_t> face{mesh.node_id(cap.level, a), mesh.node_id(cap.level, b), mesh.node_id(cap.level, c)};
    if (!cap.up) std::swap(face[1], face[2]);
    faces.push_back(std::move(face));
  }
  for (const mesh::Wall& wall : mesh.walls()) {
    for (std::int32_t k = mesh.plan().first_sublayer(wall.slab); k < mesh.plan().first_sublayer(wall.slab + 1); ++k) {
      faces.push_back(
          {mesh.node_id(k, wall.a), mesh.node_id(k, wall.b), mesh.node_id(k + 1, wall.b), mesh.node_id(k + 1, wall.a)});
    }
  }
  return faces;
}

}  // namespace pcbmesh::testing
