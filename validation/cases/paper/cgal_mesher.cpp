// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_mesh_face_base_2.h>
#include <CGAL/Delaunay_mesh_size_criteria_2.h>
#include <CGAL/Delaunay_mesh_vertex_base_2.h>
#include <CGAL/Delaunay_mesher_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <array>
#include <map>
#include <utility>
#include <vector>

#include "validation/cases/paper/measure.hpp"

namespace pcbmesh::validation::paper {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Tds =
    CGAL::Triangulation_data_structure_2<CGAL::Delaunay_mesh_vertex_base_2<Kernel>, CGAL::Delaunay_mesh_face_base_2<Kernel>>;
using Cdt = CGAL::Constrained_Delaunay_triangulation_2<Kernel, Tds, CGAL::Exact_predicates_tag>;
using Criteria = CGAL::Delaunay_mesh_size_criteria_2<Cdt>;

}  // namespace

mesh::PlanarMesh mesh_with_cgal(const mesh::PlanarGraph& graph, double longest_edge_mm) {
  Cdt cdt;
  std::vector<Cdt::Vertex_handle> handles;
  for (const geometry::Point p : graph.vertices())
    handles.push_back(cdt.insert({static_cast<double>(p.x) / 1e6, static_cast<double>(p.y) / 1e6}));
  for (const auto& [u, v] : graph.edges())
    cdt.insert_constraint(handles[static_cast<std::size_t>(u)], handles[static_cast<std::size_t>(v)]);
  CGAL::Delaunay_mesher_2<Cdt, Criteria> mesher(cdt, Criteria(0.125, longest_edge_mm));
  mesher.refine_mesh();

  mesh::PlanarMeshParts parts;
  std::map<Cdt::Vertex_handle, std::int32_t> ids;
  for (auto face = cdt.finite_faces_begin(); face != cdt.finite_faces_end(); ++face) {
    if (!face->is_in_domain()) continue;
    std::array<std::int32_t, 3> corners{};
    for (int k = 0; k < 3; ++k) {
      const Cdt::Vertex_handle v = face->vertex(k);
      const auto [at, is_new] = ids.try_emplace(v, static_cast<std::int32_t>(parts.points_m.size()));
      if (is_new) parts.points_m.push_back({v->point().x() * 1e-3, v->point().y() * 1e-3});
      corners[static_cast<std::size_t>(k)] = at->second;
    }
    parts.triangles.push_back(corners);
  }
  parts.regions.assign(parts.triangles.size(), 0);
  parts.region_body_offsets = {0, 0};
  return mesh::PlanarMesh::from_parts(std::move(parts));
}

}  // namespace pcbmesh::validation::paper
