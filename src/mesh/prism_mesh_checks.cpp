// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/mesh/prism_mesh_checks.hpp"

#include <algorithm>
#include <tuple>
#include <utility>
#include <vector>

#include "pcbmesh/base/error.hpp"

namespace pcbmesh::mesh {
namespace {

std::size_t index(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

bool is_below(std::int32_t i, std::size_t size) {
  return i >= 0 && index(i) < size;
}

template <class Item, class Key>
bool is_strictly_sorted(const std::vector<Item>& items, Key key) {
  for (std::size_t i = 1; i < items.size(); ++i) {
    if (!(key(items[i - 1]) < key(items[i]))) return false;
  }
  return true;
}

/// Presence of (region, slab) cells.
class Presence {
 public:
  explicit Presence(const PrismMeshParts& parts) : parts_(parts), num_slabs_(index(parts.plan.num_slabs())) {}
  /// False for slabs below the first and above the last.
  bool operator()(std::int32_t slab, std::int32_t triangle) const {
    if (slab < 0 || index(slab) >= num_slabs_) return false;
    return parts_.column_tags[index(parts_.planar.regions()[index(triangle)]) * num_slabs_ + index(slab)] >= 0;
  }

 private:
  const PrismMeshParts& parts_;
  std::size_t num_slabs_;
};

void check_caps(const PrismMeshParts& parts) {
  const Presence present(parts);
  const auto slab_of = parts.plan.slab_of_sublayer();
  const std::int32_t num_slabs = parts.plan.num_slabs(), num_triangles = parts.planar.num_triangles();
  // A face can only lie between two slabs; face f is the bottom of slab f.
  std::vector<std::vector<bool>> seen(index(num_slabs) + 1, std::vector<bool>(index(num_triangles), false));
  std::int64_t expected = 0;
  for (std::int32_t face = 0; face <= num_slabs; ++face) {
    for (std::int32_t t = 0; t < num_triangles; ++t) expected += present(face - 1, t) != present(face, t) ? 1 : 0;
  }
  for (const Cap& cap : parts.caps) {
    const std::int32_t face = cap.level == parts.plan.num_sublayers() ? num_slabs : slab_of[index(cap.level)];
    PCBMESH_ASSERT(parts.plan.first_sublayer(face) == cap.level);
    if (parts.face_tags[index(cap.tag)].is_inner) {
      PCBMESH_ASSERT(cap.up && present(face - 1, cap.triangle) && present(face, cap.triangle));
      ++expected;
    } else {
      PCBMESH_ASSERT(present(face - 1, cap.triangle) == cap.up && present(face, cap.triangle) != cap.up);
    }
    PCBMESH_ASSERT(!seen[index(face)][index(cap.triangle)]);
    seen[index(face)][index(cap.triangle)] = true;
  }
  PCBMESH_ASSERT(expected == static_cast<std::int64_t>(parts.caps.size()));
}

/// 64-bit mixing, odd under reversal of the edge: the sum over a chain's triangles depends on its boundary alone.
std::uint64_t edge_key(std::int32_t a, std::int32_t b) {
  const bool forward = a < b;
  const auto low = static_cast<std::uint64_t>(forward ? a : b), high = static_cast<std::uint64_t>(forward ? b : a);
  std::uint64_t x = (low << 32 | high) + 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
  x ^= x >> 31;
  return forward ? x : ~x + 1;
}

/// Walls between two prisms stand on an edge of the plane with prisms on both sides.
void check_inner_walls(const PrismMeshParts& parts, std::vector<Wall> walls) {
  if (walls.empty()) return;
  const Presence present(parts);
  const auto key = [](std::int32_t a, std::int32_t b) { return std::pair(std::min(a, b), std::max(a, b)); };
  std::sort(walls.begin(), walls.end(), [&](const Wall& p, const Wall& q) { return key(p.a, p.b) < key(q.a, q.b); });
  std::int64_t sides = 0;
  for (std::int32_t t = 0; t < parts.planar.num_triangles(); ++t) {
    const auto& corners = parts.planar.triangles()[index(t)];
    for (std::size_t i = 0; i < 3; ++i) {
      const auto edge = key(corners[i], corners[i == 2 ? 0 : i + 1]);
      auto wall = std::lower_bound(walls.begin(), walls.end(), edge,
                                   [&](const Wall& w, const auto& wanted) { return key(w.a, w.b) < wanted; });
      for (; wall != walls.end() && key(wall->a, wall->b) == edge; ++wall) sides += present(wall->slab, t) ? 1 : 0;
    }
  }
  PCBMESH_ASSERT(sides == 2 * static_cast<std::int64_t>(walls.size()));
}

void check_walls(const PrismMeshParts& parts) {
  const auto num_slabs = index(parts.plan.num_slabs());
  std::vector<std::uint64_t> region_boundary(index(parts.planar.num_regions()), 0);
  for (std::int32_t t = 0; t < parts.planar.num_triangles(); ++t) {
    const auto& [a, b, c] = parts.planar.triangles()[index(t)];
    region_boundary[index(parts.planar.regions()[index(t)])] += edge_key(a, b) + edge_key(b, c) + edge_key(c, a);
  }
  std::vector<std::uint64_t> open(num_slabs, 0);
  for (std::size_t r = 0; r < region_boundary.size(); ++r) {
    for (std::size_t s = 0; s < num_slabs; ++s) open[s] += parts.column_tags[r * num_slabs + s] >= 0 ? region_boundary[r] : 0;
  }
  std::vector<std::tuple<std::int32_t, std::int32_t, std::int32_t>> edges;  // slab, lower vertex, higher vertex
  edges.reserve(parts.walls.size());
  std::vector<Wall> inner;
  for (const Wall& wall : parts.walls) {
    if (parts.face_tags[index(wall.tag)].is_inner)
      inner.push_back(wall);
    else
      open[index(wall.slab)] -= edge_key(wall.a, wall.b);
    edges.emplace_back(wall.slab, std::min(wall.a, wall.b), std::max(wall.a, wall.b));
  }
  PCBMESH_ASSERT(std::all_of(open.begin(), open.end(), [](std::uint64_t rest) { return rest == 0; }));
  std::sort(edges.begin(), edges.end());
  PCBMESH_ASSERT(std::adjacent_find(edges.begin(), edges.end()) == edges.end());
  check_inner_walls(parts, std::move(inner));
}

}  // namespace

void check_tables(const PrismMeshParts& parts) {
  const auto num_slabs = index(parts.plan.num_slabs());
  PCBMESH_ASSERT(parts.column_tags.size() == index(parts.planar.num_regions()) * num_slabs);
  for (std::int32_t tag : parts.column_tags) PCBMESH_ASSERT(tag == -1 || is_below(tag, parts.volume_tags.size()));
  for (std::size_t i = 0; i < parts.volume_tags.size(); ++i) {
    const VolumeTag& tag = parts.volume_tags[i];
    PCBMESH_ASSERT(tag.id == static_cast<std::int32_t>(i) + 1 && is_below(tag.layer, parts.layers.size()));
    PCBMESH_ASSERT(is_below(tag.material, parts.materials.size()) && (tag.net == -1 || is_below(tag.net, parts.nets.size())));
  }
  for (std::size_t i = 0; i < parts.face_tags.size(); ++i) {
    const FaceTag& tag = parts.face_tags[i];
    PCBMESH_ASSERT(tag.id == static_cast<std::int32_t>(i) + 1 && (tag.net == -1 || is_below(tag.net, parts.nets.size())));
    PCBMESH_ASSERT(tag.material == -1 || is_below(tag.material, parts.materials.size()));
    PCBMESH_ASSERT(tag.port == -1 || is_below(tag.port, parts.ports.size()));
    PCBMESH_ASSERT(tag.partner == -1 || is_below(tag.partner, parts.face_tags.size()));
  }
  for (const Port& port : parts.ports) {
    PCBMESH_ASSERT(port.positive_net == -1 || is_below(port.positive_net, parts.nets.size()));
    PCBMESH_ASSERT(port.negative_net == -1 || is_below(port.negative_net, parts.nets.size()));
  }
  for (const Cap& cap : parts.caps) {
    PCBMESH_ASSERT(is_below(cap.tag, parts.face_tags.size()) && is_below(cap.level, index(parts.plan.num_levels())) &&
                   is_below(cap.triangle, index(parts.planar.num_triangles())));
  }
  for (const Wall& wall : parts.walls) {
    PCBMESH_ASSERT(is_below(wall.tag, parts.face_tags.size()) && is_below(wall.slab, num_slabs) && wall.a != wall.b &&
                   is_below(wall.a, index(parts.planar.num_points())) && is_below(wall.b, index(parts.planar.num_points())));
  }
  PCBMESH_ASSERT(is_strictly_sorted(parts.caps, [](const Cap& cap) { return std::tie(cap.tag, cap.level, cap.triangle); }));
  PCBMESH_ASSERT(is_strictly_sorted(parts.walls, [](const Wall& w) { return std::tie(w.tag, w.slab, w.a, w.b); }));
  PCBMESH_ASSERT(parts.net_pieces.empty() || parts.net_pieces.size() == parts.nets.size());
  for (const auto& [a, b] : parts.touching_nets) {
    PCBMESH_ASSERT(is_below(a, parts.nets.size()) && is_below(b, parts.nets.size()));
  }
}

void check_boundary(const PrismMeshParts& parts) {
  check_caps(parts);
  check_walls(parts);
}

}  // namespace pcbmesh::mesh
