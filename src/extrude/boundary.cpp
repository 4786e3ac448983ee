// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/extrude/boundary.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/base/running_sum.hpp"
#include "src/extrude/face_tags.hpp"
#include "src/extrude/port_faces.hpp"

namespace pcbmesh::extrude {
namespace {

using mesh::PlanarEdge;
using mesh::PlanarMesh;

std::size_t index(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

// Refinement points on a side of the box may be off by rounding; a hundredth of the coordinate grid's step can't mislead.
constexpr double side_tolerance_m = 1e-11;

bool is_hollow(const model::Label& label) {
  return label.is_void() && label.hollow_net >= board::no_net;
}

/// Edges between triangles of different regions and edges of the outline, ordered by lower vertex.
std::vector<PlanarEdge> region_edges(const PlanarMesh& planar) {
  std::vector<PlanarEdge> edges;
  mesh::visit_planar_edges(planar, [&](const PlanarEdge& edge) {
    if (edge.right < 0 || planar.regions()[index(edge.left)] != planar.regions()[index(edge.right)]) edges.push_back(edge);
  });
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

/// Finds caps and walls, with provisional tags.
class BoundaryFinder {
 public:
  BoundaryFinder(const mesh::PrismMeshParts& parts, const Columns& columns, const model::Model& model, const TagSpace& tags,
                 const PortFootprints& ports)
      : parts_(parts), columns_(columns), model_(model), tags_(tags), ports_(ports), box_(bound(parts.planar, columns)) {}

  /// In order of level and triangle.
  [[nodiscard]] std::vector<mesh::Cap> caps() const {
    const auto regions = parts_.planar.regions();
    const std::int32_t num_slabs = columns_.num_slabs(), num_regions = parts_.planar.num_regions();
    std::vector<std::int32_t> tag_of_region(index(num_regions));
    std::vector<char> is_up(index(num_regions));
    std::vector<mesh::Cap> caps;
    for (std::int32_t face = 0; face <= num_slabs; ++face) {
      for (std::int32_t r = 0; r < num_regions; ++r) {
        const model::Label& below = face == 0 ? outside_ : columns_.at(r, face - 1);
        const model::Label& above = face == num_slabs ? outside_ : columns_.at(r, face);
        // Between two prisms `up` is true.
        is_up[index(r)] = above.is_void() || !below.is_void() ? 1 : 0;
        tag_of_region[index(r)] = cap_tag(r, face, below, above);
      }
      const std::int32_t level = parts_.plan.first_sublayer(face);
      for (std::int32_t t = 0; t < parts_.planar.num_triangles(); ++t) {
        const auto region = index(regions[index(t)]);
        if (tag_of_region[region] >= 0) caps.push_back({tag_of_region[region], level, t, is_up[region] != 0});
      }
    }
    return caps;
  }

  /// In order of slab.
  [[nodiscard]] std::vector<mesh::Wall> walls(const std::vector<PlanarEdge>& edges) const {
    std::vector<std::int32_t> port_of_edge(edges.size(), -1);
    for (std::size_t e = 0; e < edges.size(); ++e) port_of_edge[e] = ports_.on_line(edges[e]);
    std::vector<mesh::Wall> walls;
    for (std::int32_t slab = 0; slab < columns_.num_slabs(); ++slab) {
      for (std::size_t e = 0; e < edges.size(); ++e) {
        const model::Label& left = left_of(edges[e], slab);
        const model::Label& right = right_of(edges[e], slab);
        const std::int32_t tag = wall_tag(edges[e], slab, left, right, port_of_edge[e]);
        if (tag < 0) continue;
        mesh::Wall wall{tag, slab, edges[e].a, edges[e].b};
        if (left.is_void()) std::swap(wall.a, wall.b);
        walls.push_back(wall);
      }
    }
    return walls;
  }

 private:
  [[nodiscard]] const model::Label& left_of(const PlanarEdge& edge, std::int32_t slab) const {
    return columns_.at(parts_.planar.regions()[index(edge.left)], slab);
  }
  [[nodiscard]] const model::Label& right_of(const PlanarEdge& edge, std::int32_t slab) const {
    return edge.right < 0 ? outside_ : columns_.at(parts_.planar.regions()[index(edge.right)], slab);
  }

  [[nodiscard]] std::int32_t cap_tag(std::int32_t region, std::int32_t face, const model::Label& below,
                                     const model::Label& above) const {
    const bool is_inner = !below.is_void() && !above.is_void();
    if (below.is_void() && above.is_void()) return -1;
    const model::Label& gone = above.is_void() ? above : below;
    if (!is_inner && is_hollow(gone)) return tags_.surface(gone.hollow_net);
    if (const std::int32_t sheet = columns_.sheet_at(region, face); sheet >= 0) {
      const std::int32_t net = model_.bodies()[index(sheet)].net;
      return is_inner ? tags_.inner_sheet(net) : tags_.outer_sheet(net);
    }
    if (const std::int32_t port = ports_.cap_at(region, face); port >= 0) return tags_.port(port);
    if (is_inner) return -1;
    if (above.is_void()) return face - 1 == box_.last_slab ? zmax : side;
    return face == box_.first_slab ? zmin : side;
  }

  [[nodiscard]] std::int32_t wall_tag(const PlanarEdge& edge, std::int32_t slab, const model::Label& left,
                                      const model::Label& right, std::int32_t port) const {
    const bool is_inner = !left.is_void() && !right.is_void();
    if (left.is_void() && right.is_void()) return -1;
    const model::Label& gone = left.is_void() ? left : right;
    if (!is_inner && is_hollow(gone)) return tags_.surface(gone.hollow_net);
    // Conductors are no part of a port: where a wave port crosses one, its cut belongs to the side.
    const bool in_copper = left.net >= 0 || right.net >= 0;
    if (port >= 0 && !in_copper && ports_.has_slab(port, slab)) return tags_.port(port);
    if (is_inner) return -1;
    if (!model_.outline().empty()) return side_of_outline(edge);
    return box_.side_of(parts_.planar.points_m()[index(edge.a)], parts_.planar.points_m()[index(edge.b)]);
  }

  const mesh::PrismMeshParts& parts_;
  const Columns& columns_;
  const model::Model& model_;
  const TagSpace& tags_;
  const PortFootprints& ports_;
  /// Side of a polygonal domain on which an outer edge lies; `side` if none.
  [[nodiscard]] std::int32_t side_of_outline(const PlanarEdge& edge) const {
    const auto outline = model_.outline();
    if (edge.right >= 0) return side;
    for (std::size_t i = 0; i < outline.size(); ++i)
      if (is_on_segment(parts_.planar.points_m()[index(edge.a)], outline[i], outline[(i + 1) % outline.size()]) &&
          is_on_segment(parts_.planar.points_m()[index(edge.b)], outline[i], outline[(i + 1) % outline.size()]))
        return tags_.outline_side(static_cast<std::int32_t>(i));
    return side;
  }
  MeshedBox box_;
  model::Label outside_;
};

/// Lists the tags in use and gives caps and walls their final ones.
void number_face_tags(mesh::PrismMeshParts& parts, const TagSpace& tags, const model::Model& model) {
  std::vector<std::int32_t> final_tag(index(tags.size()), -1);
  for (const mesh::Cap& cap : parts.caps) final_tag[index(cap.tag)] = 0;
  for (const mesh::Wall& wall : parts.walls) final_tag[index(wall.tag)] = 0;
  for (std::size_t i = 0; i < final_tag.size(); ++i) {
    if (final_tag[i] < 0) continue;
    final_tag[i] = static_cast<std::int32_t>(parts.face_tags.size());
    parts.face_tags.push_back(tags.describe(static_cast<std::int32_t>(i), model));
    parts.face_tags.back().id = final_tag[i] + 1;
  }
  for (mesh::Cap& cap : parts.caps) cap.tag = final_tag[index(cap.tag)];
  for (mesh::Wall& wall : parts.walls) wall.tag = final_tag[index(wall.tag)];
}

/// Opposite sides that are periodic name each other.
void pair_periodic_sides(std::vector<mesh::FaceTag>& tags) {
  for (mesh::FaceTag& tag : tags) {
    if (tag.condition != mesh::BoundaryCondition::periodic) continue;
    const std::string partner = tag.name.substr(0, 1) + (tag.name.ends_with("min") ? "max" : "min");
    const auto found = std::ranges::find(tags, partner, &mesh::FaceTag::name);
    PCBMESH_ASSERT(found != tags.end());
    tag.partner = static_cast<std::int32_t>(found - tags.begin());
  }
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

void add_boundary(mesh::PrismMeshParts& parts, const Columns& columns, const model::Model& model) {
  const TagSpace tags(model);
  const PortFootprints ports(parts.planar, model);
  const std::vector<PlanarEdge> edges = region_edges(parts.planar);
  const BoundaryFinder finder(parts, columns, model, tags, ports);
  parts.caps = finder.caps();
  parts.walls = finder.walls(edges);
  number_face_tags(parts, tags, model);
  pair_periodic_sides(parts.face_tags);
  measure_faces(parts);
  add_ports(parts, columns, model, ports, edges);
  // Caps come by level and triangle: a stable sort by tag keeps that order inside each tag.
  std::stable_sort(parts.caps.begin(), parts.caps.end(), [](const mesh::Cap& p, const mesh::Cap& q) { return p.tag < q.tag; });
  std::sort(parts.walls.begin(), parts.walls.end(), [](const mesh::Wall& p, const mesh::Wall& q) {
    return std::tie(p.tag, p.slab, p.a, p.b) < std::tie(q.tag, q.slab, q.a, q.b);
  });
}

}  // namespace pcbmesh::extrude
