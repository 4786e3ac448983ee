// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/triangulate/refine.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "src/triangulate/mesher_levels.hpp"

namespace pcbmesh::triangulate {
namespace {

[[noreturn]] void throw_limit(const Cdt& cdt, const RefineLimits& limits) {
  // The youngest vertex is where refinement was at work.
  Cdt::Vertex_handle last = cdt.finite_vertices_begin();
  for (auto v = cdt.finite_vertices_begin(); v != cdt.finite_vertices_end(); ++v) {
    if (last->time_stamp() < v->time_stamp()) last = v;
  }
  Spot spot;
  spot.at_mm = {last->point().x() * limits.unit_nm * 1e-6, last->point().y() * limits.unit_nm * 1e-6};
  throw Error(
      ErrorCode::triangulation_limit,
      fmt::format("refinement reached the limit of {} vertices. Ask for longer edges or a smaller angle, raise the limit, "
                  "or use a larger --tolerance if features nearly touch here",
                  limits.max_vertices),
      spot);
}

template <class Faces, class Criteria>
void refine_with(Cdt& cdt, Criteria& criteria, const EdgeSplittingSetup& setup, const RefineLimits& limits,
                 const Progress& progress) {
  CGAL::Mesh_2::Clusters<Cdt> clusters(cdt);
  CGAL::Null_mesher_level no_level;
  CGAL::Null_mesh_visitor no_visitor;
  EdgeLevel edges(cdt, clusters, no_level);
  edges.configure(setup);
  Faces faces(cdt, criteria, edges);
  CGAL::Mesh_2::Refine_edges_visitor_from_faces<Faces> visitor(faces, edges, no_visitor);
  clusters.create_clusters();
  edges.scan_triangulation();
  faces.scan_triangulation();
  for (std::int64_t step = 1; faces.try_to_insert_one_point(visitor); ++step) {
    const auto num_vertices = static_cast<std::int64_t>(cdt.number_of_vertices());
    if (num_vertices > limits.max_vertices) throw_limit(cdt, limits);
    if ((step & 0x3fff) == 0) {
      progress.at("triangulate", std::min(0.99, static_cast<double>(num_vertices) / std::max(limits.expected_vertices, 1.0)));
    }
  }
}

}  // namespace

void refine(Cdt& cdt, const MeshBounds& bounds, const GraphEdgeIndex& graph_edges, const RefineLimits& limits, bool as_in_paper,
            const Progress& progress) {
  const EdgeSplittingSetup setup{&graph_edges, bounds.floor(), limits.unit_nm, as_in_paper};
  if (as_in_paper) {
    PaperCriteria criteria(bounds.sine2_bound(), bounds.longest_edge());
    refine_with<PaperFaceLevel>(cdt, criteria, setup, limits, progress);
  } else {
    refine_with<FaceLevel>(cdt, bounds, setup, limits, progress);
  }
}

}  // namespace pcbmesh::triangulate
