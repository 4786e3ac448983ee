// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/extrude/boundary.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/base/running_sum.hpp"
#include "src/extrude/tag_names.hpp"

namespace pcbmesh::extrude {
namespace {

using mesh::PlanarMesh;

std::size_t index(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

// Refinement points on a side of the box may be off by rounding; a hundredth of the coordinate grid's step can't mislead.
constexpr double side_tolerance_m = 1e-11;

/// Provisional face tags: the order in which used ones are listed. Net n is first_surface + 1 + n.
enum Side : std::int32_t { zmin, zmax, xmin, xmax, ymin, ymax, side, first_surface };
constexpr std::array<const char*, 7> side_names{"zmin", "zmax", "xmin", "xmax", "ymin", "ymax", "side"};

std::int32_t surface_of(std::int32_t net) {
  return first_surface + 1 + net;
}

bool is_hollow(const model::Label& label) {
  return label.is_void() && label.hollow_net >= board::no_net;
}

/// Directed planar edge with the triangle to its left and, if any, the triangle to its right.
struct SharedEdge {
  std::int32_t a = 0, b = 0;
  std::int32_t left = 0;
  std::int32_t right = -1;
};

/// Edges between triangles of different regions and edges of the outline, ordered by lower vertex.
std::vector<SharedEdge> region_edges(const PlanarMesh& planar) {
  struct HalfEdge {
    std::int32_t high = 0, triangle = 0;
    bool ascends = false;  ///< runs from the lower to the higher vertex
  };
  const auto triangles = planar.triangles();
  std::vector<std::int64_t> starts(index(planar.num_points()) + 1, 0);
  const auto visit_edges = [&](auto&& visit) {
    for (std::int32_t t = 0; t < planar.num_triangles(); ++t) {
      const auto& corners = triangles[index(t)];
      for (std::size_t i = 0; i < 3; ++i) visit(t, corners[i], corners[i == 2 ? 0 : i + 1]);
    }
  };
  visit_edges([&](std::int32_t, std::int32_t a, std::int32_t b) { ++starts[index(std::min(a, b)) + 1]; });
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  std::vector<HalfEdge> half_edges(static_cast<std::size_t>(starts.back()));
  std::vector<std::int64_t> next(starts.begin(), starts.end() - 1);
  visit_edges([&](std::int32_t t, std::int32_t a, std::int32_t b) {
    half_edges[static_cast<std::size_t>(next[index(std::min(a, b))]++)] = {std::max(a, b), t, a < b};
  });
  std::vector<SharedEdge> edges;
  for (std::int32_t low = 0; low < planar.num_points(); ++low) {
    const auto first = half_edges.begin() + starts[index(low)], last = half_edges.begin() + starts[index(low) + 1];
    std::sort(first, last,
              [](const HalfEdge& p, const HalfEdge& q) { return std::tie(p.high, p.triangle) < std::tie(q.high, q.triangle); });
    for (auto here = first; here != last;) {
      const auto mate = here + 1;
      const bool has_mate = mate != last && mate->high == here->high;
      PCBMESH_ASSERT(!has_mate || (mate->ascends != here->ascends && (mate + 1 == last || (mate + 1)->high != here->high)));
      const std::int32_t right = has_mate ? mate->triangle : -1;
      if (!has_mate || planar.regions()[index(here->triangle)] != planar.regions()[index(right)]) {
        edges.push_back({here->ascends ? low : here->high, here->ascends ? here->high : low, here->triangle, right});
      }
      here = has_mate ? mate + 1 : mate;
    }
  }
  return edges;
}

/// Bounding box of the triangles and slabs that carry prisms.
struct MeshedBox {
  std::array<double, 2> min{std::numeric_limits<double>::max(), std::numeric_limits<double>::max()};
  std::array<double, 2> max{-std::numeric_limits<double>::max(), -std::numeric_limits<double>::max()};
  std::int32_t first_slab = std::numeric_limits<std::int32_t>::max(), last_slab = -1;

  /// Side of the box that holds both points, else `side`.
  [[nodiscard]] Side side_of(const std::array<double, 2>& p, const std::array<double, 2>& q) const {
    const auto is_at = [&](std::size_t axis, double at) {
      return std::abs(p[axis] - at) <= side_tolerance_m && std::abs(q[axis] - at) <= side_tolerance_m;
    };
    if (is_at(0, min[0])) return xmin;
    if (is_at(0, max[0])) return xmax;
    if (is_at(1, min[1])) return ymin;
    if (is_at(1, max[1])) return ymax;
    return side;
  }
};

MeshedBox bound(const PlanarMesh& planar, const Columns& columns) {
  MeshedBox box;
  std::vector<bool> is_meshed(index(planar.num_regions()), false);
  for (std::int32_t r = 0; r < planar.num_regions(); ++r) {
    for (std::int32_t s = 0; s < columns.num_slabs(); ++s) {
      if (columns.at(r, s).is_void()) continue;
      is_meshed[index(r)] = true;
      box.first_slab = std::min(box.first_slab, s);
      box.last_slab = std::max(box.last_slab, s);
    }
  }
  for (std::int32_t t = 0; t < planar.num_triangles(); ++t) {
    if (!is_meshed[index(planar.regions()[index(t)])]) continue;
    for (std::int32_t v : planar.triangles()[index(t)]) {
      for (std::size_t axis = 0; axis < 2; ++axis) {
        box.min[axis] = std::min(box.min[axis], planar.points_m()[index(v)][axis]);
        box.max[axis] = std::max(box.max[axis], planar.points_m()[index(v)][axis]);
      }
    }
  }
  return box;
}

/// Caps in order of level and triangle, with provisional tags.
std::vector<mesh::Cap> find_caps(const mesh::PrismMeshParts& parts, const Columns& columns, const MeshedBox& box) {
  const auto regions = parts.planar.regions();
  const std::int32_t num_slabs = columns.num_slabs(), num_regions = parts.planar.num_regions();
  const model::Label outside;
  std::vector<std::int32_t> tag_of_region(index(num_regions));
  std::vector<char> is_up(index(num_regions));
  std::vector<mesh::Cap> caps;
  for (std::int32_t face = 0; face <= num_slabs; ++face) {
    for (std::int32_t r = 0; r < num_regions; ++r) {
      const model::Label& below = face == 0 ? outside : columns.at(r, face - 1);
      const model::Label& above = face == num_slabs ? outside : columns.at(r, face);
      is_up[index(r)] = above.is_void() ? 1 : 0;
      const model::Label& gone = above.is_void() ? above : below;
      if (below.is_void() == above.is_void()) {
        tag_of_region[index(r)] = -1;
      } else if (is_hollow(gone)) {
        tag_of_region[index(r)] = surface_of(gone.hollow_net);
      } else if (above.is_void()) {
        tag_of_region[index(r)] = face - 1 == box.last_slab ? zmax : side;
      } else {
        tag_of_region[index(r)] = face == box.first_slab ? zmin : side;
      }
    }
    const std::int32_t level = parts.plan.first_sublayer(face);
    for (std::int32_t t = 0; t < parts.planar.num_triangles(); ++t) {
      const auto region = index(regions[index(t)]);
      if (tag_of_region[region] >= 0) caps.push_back({tag_of_region[region], level, t, is_up[region] != 0});
    }
  }
  return caps;
}

/// Walls in order of slab, with provisional tags.
std::vector<mesh::Wall> find_walls(const mesh::PrismMeshParts& parts, const Columns& columns, const MeshedBox& box) {
  const PlanarMesh& planar = parts.planar;
  const std::vector<SharedEdge> edges = region_edges(planar);
  std::vector<mesh::Wall> walls;
  const model::Label outside;
  for (std::int32_t slab = 0; slab < columns.num_slabs(); ++slab) {
    for (const SharedEdge& edge : edges) {
      const model::Label& left = columns.at(planar.regions()[index(edge.left)], slab);
      const model::Label& right = edge.right < 0 ? outside : columns.at(planar.regions()[index(edge.right)], slab);
      if (left.is_void() == right.is_void()) continue;
      const model::Label& gone = left.is_void() ? left : right;
      mesh::Wall wall{side, slab, edge.a, edge.b};
      if (left.is_void()) std::swap(wall.a, wall.b);
      wall.tag = is_hollow(gone) ? surface_of(gone.hollow_net)
                                 : box.side_of(planar.points_m()[index(edge.a)], planar.points_m()[index(edge.b)]);
      walls.push_back(wall);
    }
  }
  return walls;
}

mesh::FaceTag new_face_tag(std::int32_t provisional, std::span<const std::string> nets) {
  mesh::FaceTag tag;
  if (provisional < first_surface) {
    tag.name = side_names[index(provisional)];
  } else {
    tag.kind = mesh::FaceTagKind::conductor;
    tag.net = provisional - first_surface - 1;
    tag.name = "surface|" + net_part(nets, tag.net);
  }
  return tag;
}

/// Lists the tags in use and gives caps and walls their final ones.
void number_face_tags(mesh::PrismMeshParts& parts) {
  std::vector<std::int32_t> final_tag(index(first_surface) + 1 + parts.nets.size(), -1);
  for (const mesh::Cap& cap : parts.caps) final_tag[index(cap.tag)] = 0;
  for (const mesh::Wall& wall : parts.walls) final_tag[index(wall.tag)] = 0;
  for (std::size_t i = 0; i < final_tag.size(); ++i) {
    if (final_tag[i] < 0) continue;
    final_tag[i] = static_cast<std::int32_t>(parts.face_tags.size());
    parts.face_tags.push_back(new_face_tag(static_cast<std::int32_t>(i), parts.nets));
    parts.face_tags.back().id = final_tag[i] + 1;
  }
  for (mesh::Cap& cap : parts.caps) cap.tag = final_tag[index(cap.tag)];
  for (mesh::Wall& wall : parts.walls) wall.tag = final_tag[index(wall.tag)];
}

/// Counts and areas of the face tags.
void measure_faces(mesh::PrismMeshParts& parts) {
  std::vector<RunningSum> areas(parts.face_tags.size());
  for (const mesh::Cap& cap : parts.caps) {
    ++parts.face_tags[index(cap.tag)].num_triangles;
    areas[index(cap.tag)].add(parts.planar.area_m2(cap.triangle));
  }
  for (const mesh::Wall& wall : parts.walls) {
    const std::int32_t low = parts.plan.first_sublayer(wall.slab), high = parts.plan.first_sublayer(wall.slab + 1);
    parts.face_tags[index(wall.tag)].num_quads += high - low;
    const auto &p = parts.planar.points_m()[index(wall.a)], &q = parts.planar.points_m()[index(wall.b)];
    const double height = parts.plan.z_m()[index(high)] - parts.plan.z_m()[index(low)];
    areas[index(wall.tag)].add(std::hypot(q[0] - p[0], q[1] - p[1]) * height);
  }
  for (std::size_t i = 0; i < areas.size(); ++i) parts.face_tags[i].area_m2 = areas[i].total();
}

}  // namespace

void add_boundary(mesh::PrismMeshParts& parts, const Columns& columns) {
  const MeshedBox box = bound(parts.planar, columns);
  parts.caps = find_caps(parts, columns, box);
  parts.walls = find_walls(parts, columns, box);
  number_face_tags(parts);
  measure_faces(parts);
  // Caps come by level and triangle: a stable sort by tag keeps that order inside each tag.
  std::stable_sort(parts.caps.begin(), parts.caps.end(), [](const mesh::Cap& p, const mesh::Cap& q) { return p.tag < q.tag; });
  std::sort(parts.walls.begin(), parts.walls.end(), [](const mesh::Wall& p, const mesh::Wall& q) {
    return std::tie(p.tag, p.slab, p.a, p.b) < std::tie(q.tag, q.slab, q.a, q.b);
  });
}

}  // namespace pcbmesh::extrude
