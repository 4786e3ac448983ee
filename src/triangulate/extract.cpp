// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/triangulate/extract.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "pcbmesh/base/units.hpp"
#include "src/triangulate/hilbert_order.hpp"
#include "src/triangulate/mesh_bounds.hpp"

namespace pcbmesh::triangulate {
namespace {

/// Copies in the triangulation's own order; vertices are numbered as it stores them.
struct Raw {
  std::vector<std::array<double, 2>> points;
  std::vector<std::array<std::int32_t, 3>> triangles;
  std::vector<std::int32_t> regions;
  std::vector<std::array<std::int32_t, 2>> constrained;
};

Raw copy_domain(Cdt& cdt, const Regions& regions, double sine2_bound, Extraction& result) {
  Raw raw;
  raw.points.reserve(cdt.number_of_vertices());
  for (auto v = cdt.finite_vertices_begin(); v != cdt.finite_vertices_end(); ++v) {
    v->set_graph_vertex(static_cast<std::int32_t>(raw.points.size()));  // the origin has served; now it is the number
    raw.points.push_back({v->point().x(), v->point().y()});
  }
  std::vector<char> is_inside(regions.size());
  for (std::size_t r = 0; r < regions.size(); ++r) is_inside[r] = regions.is_in_domain(r) ? 1 : 0;
  const auto is_kept = [&](Cdt::Face_handle face) { return is_inside[face->ticket() - 1] != 0; };
  raw.triangles.reserve(cdt.number_of_faces());
  raw.regions.reserve(cdt.number_of_faces());
  for (auto face = cdt.finite_faces_begin(); face != cdt.finite_faces_end(); ++face) {
    if (!is_kept(face)) continue;
    raw.triangles.push_back(
        {face->vertex(0)->graph_vertex(), face->vertex(1)->graph_vertex(), face->vertex(2)->graph_vertex()});
    raw.regions.push_back(static_cast<std::int32_t>(face->ticket()) - 1);
    for (int i = 0; i < 3; ++i) {
      if (!face->is_constrained(i)) continue;
      const std::int32_t a = face->vertex(Cdt::ccw(i))->graph_vertex(), b = face->vertex(Cdt::cw(i))->graph_vertex();
      if (a < b || !is_kept(face->neighbor(i))) raw.constrained.push_back({a, b});
    }
    const auto shape = MeshBounds::measure(face);
    result.smallest_sine2 = std::min(result.smallest_sine2, shape.sine2);
    if (shape.sine2 < sine2_bound) ++result.num_below_bound;
  }
  return raw;
}

std::vector<std::uint32_t> triangle_order(const Raw& raw) {
  std::vector<std::array<float, 2>> centres(raw.triangles.size());
  for (std::size_t t = 0; t < centres.size(); ++t) {
    const auto& [a, b, c] = raw.triangles[t];
    const auto &p = raw.points[static_cast<std::size_t>(a)], &q = raw.points[static_cast<std::size_t>(b)],
               &r = raw.points[static_cast<std::size_t>(c)];
    centres[t] = {static_cast<float>(p[0] + q[0] + r[0]), static_cast<float>(p[1] + q[1] + r[1])};
  }
  return hilbert_order(centres);
}

/// Gives old ids new ones in the order in which they are asked for.
class Renumbering {
 public:
  explicit Renumbering(std::size_t size) : ids_(size, -1) {}
  std::int32_t operator()(std::int32_t old) {
    std::int32_t& id = ids_[static_cast<std::size_t>(old)];
    if (id < 0) {
      id = static_cast<std::int32_t>(olds_.size());
      olds_.push_back(old);
    }
    return id;
  }
  [[nodiscard]] std::int32_t known(std::int32_t old) const { return ids_[static_cast<std::size_t>(old)]; }
  [[nodiscard]] const std::vector<std::int32_t>& olds() const { return olds_; }

 private:
  std::vector<std::int32_t> ids_, olds_;
};

void write_regions(const std::vector<std::int32_t>& old_regions, const Regions& regions, mesh::PlanarMeshParts& parts) {
  parts.region_body_offsets.assign(1, 0);
  for (const std::int32_t old : old_regions) {
    for (const mesh::Increment& body : regions.of(static_cast<std::size_t>(old))) {
      if (body.delta > 0) parts.region_bodies.push_back(body.body);
    }
    parts.region_body_offsets.push_back(static_cast<std::int32_t>(parts.region_bodies.size()));
  }
}

}  // namespace

Extraction extract(Cdt& cdt, double unit_nm, const Regions& regions, double sine2_bound,
                   const std::vector<Cdt::Vertex_handle>& first) {
  Extraction result;
  result.num_vertices = static_cast<std::int64_t>(cdt.number_of_vertices());
  Raw raw = copy_domain(cdt, regions, sine2_bound, result);
  std::vector<std::int32_t> first_ids;
  for (const Cdt::Vertex_handle v : first) first_ids.push_back(v->graph_vertex());
  cdt.clear();
  mesh::PlanarMeshParts& parts = result.parts;
  Renumbering point_ids(raw.points.size()), region_ids(regions.size());
  parts.triangles.reserve(raw.triangles.size());
  parts.regions.reserve(raw.triangles.size());
  for (const std::int32_t id : first_ids) point_ids(id);
  for (const std::uint32_t t : triangle_order(raw)) {
    const auto& [a, b, c] = raw.triangles[t];
    const std::int32_t p = point_ids(a), q = point_ids(b), r = point_ids(c);
    parts.triangles.push_back({p, q, r});
    parts.regions.push_back(region_ids(raw.regions[t]));
  }
  parts.points_m.reserve(point_ids.olds().size());
  const double metres_per_unit = unit_nm * metres_per_nm;
  for (const std::int32_t old : point_ids.olds()) {
    const auto& [x, y] = raw.points[static_cast<std::size_t>(old)];
    parts.points_m.push_back({x * metres_per_unit, y * metres_per_unit});
  }
  parts.constrained.reserve(raw.constrained.size());
  for (const auto& [a, b] : raw.constrained) {
    const std::int32_t p = point_ids.known(a), q = point_ids.known(b);
    parts.constrained.push_back({std::min(p, q), std::max(p, q)});
  }
  std::sort(parts.constrained.begin(), parts.constrained.end());
  write_regions(region_ids.olds(), regions, parts);
  return result;
}

}  // namespace pcbmesh::triangulate
