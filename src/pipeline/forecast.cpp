// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/pipeline/forecast.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/layering/choose_layers.hpp"
#include "pcbmesh/layering/divide_layers.hpp"
#include "pcbmesh/layering/match_quality.hpp"
#include "pcbmesh/layering/prism_quality.hpp"

namespace pcbmesh::pipeline {
namespace {

std::size_t index(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

/// Area of a triangle where the bound on edges, not the features, decides, over the square of the bound.
constexpr double area_over_edge_squared = layering::TriangleShape{}.area;

/// Triangles and heights to come.
struct PlaneForecast {
  std::vector<double> triangles_of_region;
  double triangles = 0;
  double mean_height_m = 0, least_height_m = 0, greatest_height_m = 0;
};

PlaneForecast forecast_plane(const mesh::PlanarMesh& outlines, std::optional<double> fed_back_m) {
  PlaneForecast plane;
  plane.triangles_of_region.assign(index(outlines.num_regions()), 0);
  double sum = 0;
  for (std::int32_t t = 0; t < outlines.num_triangles(); ++t) {
    const auto squares = outlines.squared_edges_m2(t);
    double children = 1;
    if (fed_back_m && *std::ranges::max_element(squares) > *fed_back_m * *fed_back_m)
      children = std::max(1.0, outlines.area_m2(t) / (area_over_edge_squared * *fed_back_m * *fed_back_m));
    const double height = layering::optimal_height(squares[0] + squares[1] + squares[2]) / std::sqrt(children);
    plane.triangles_of_region[index(outlines.regions()[index(t)])] += children;
    plane.triangles += children;
    sum += children * height;
    plane.least_height_m = t == 0 ? height : std::min(plane.least_height_m, height);
    plane.greatest_height_m = std::max(plane.greatest_height_m, height);
  }
  plane.mean_height_m = plane.triangles > 0 ? sum / plane.triangles : 0;
  return plane;
}

std::int64_t rounded(double value) {
  return std::llround(value);
}

/// Entities of triangles stacked in slabs: in the plane there are three edges to two triangles, and one vertex.
mesh::EntityCounts stack_up(const PlaneForecast& plane, const mesh::PlanarMesh& outlines, const mesh::LayerPlan& plan,
                            const model::Model& model) {
  constexpr double edges_per_triangle = 1.5, vertices_per_triangle = 0.5;
  const std::int32_t num_slabs = plan.num_slabs();
  double prisms = 0, caps = 0;  // caps: horizontal faces of the boundary
  for (std::int32_t r = 0; r < outlines.num_regions(); ++r) {
    const double here = plane.triangles_of_region[index(r)];
    if (here == 0) continue;
    bool was_there = false;
    for (std::int32_t s = 0; s < num_slabs; ++s) {
      const bool is_there = !model.resolve(s, outlines.bodies_of_region(r)).is_void();
      if (is_there) prisms += here * (plan.first_sublayer(s + 1) - plan.first_sublayer(s));
      if (is_there != was_there) caps += here;
      was_there = is_there;
    }
    if (was_there) caps += here;
  }
  mesh::EntityCounts counts;
  const double triangles = prisms + caps / 2, quads = edges_per_triangle * prisms;
  const double uprights = vertices_per_triangle * prisms, level_edges = edges_per_triangle * triangles;
  counts.prisms = rounded(prisms);
  counts.nodes = rounded(vertices_per_triangle * triangles);
  counts.triangles = rounded(triangles);
  counts.inner_triangles = rounded(triangles - caps);
  counts.quads = counts.inner_quads = rounded(quads);
  counts.edges = rounded(level_edges + uprights);
  counts.boundary_edges = rounded(edges_per_triangle * caps);
  counts.closed_edges = counts.edges - counts.boundary_edges;
  return counts;
}

/// Iterative solvers hold the matrix a few times over (levels, preconditioner, real and imaginary part); direct ones its
/// factors, whose entries grow with n^(4/3) for a solid body and n log n for a flat one.
/// Source: A. George, SIAM J. Numer. Anal. 10, 1973 (n log n); R. Lipton, D. Rose, R. Tarjan, ibid. 16, 1979 (n^(4/3)).
std::vector<SolverMemory> memory_of(const mesh::Unknowns& u) {
  constexpr double mib = 1.0 / (1024.0 * 1024.0), bytes_per_entry = 12, complex_bytes = 16;
  const double n = static_cast<double>(std::max<std::int64_t>(2, u.total));
  const double matrix = u.nonzeros * bytes_per_entry;
  const double flat = 8 * n * std::log2(n) * complex_bytes, solid = 15 * std::pow(n, 4.0 / 3.0) * complex_bytes;
  return {{"palace, mfem (iterative)", 4 * matrix * mib, 12 * matrix * mib},
          {"getdp, elmer, dolfinx (direct)", std::min(flat, solid) * mib, std::max(flat, solid) * mib}};
}

void add_unknowns(Forecast& forecast) {
  for (int order = 1; order <= highest_order; ++order) {
    const auto at = static_cast<std::size_t>(order - 1);
    forecast.on_prisms[at] = mesh::count_unknowns(forecast.counts, order, mesh::Cells::prisms);
    forecast.on_tetrahedra[at] = mesh::count_unknowns(forecast.counts, order, mesh::Cells::tetrahedra);
  }
  forecast.memory = memory_of(forecast.on_prisms.front());
}

}  // namespace

Forecast forecast(const mesh::PlanarMesh& outlines, std::optional<double> fed_back_m, std::optional<double> height_m,
                  std::span<const int> counts, const model::Model& model, const study::Study& study) {
  const PlaneForecast plane = forecast_plane(outlines, fed_back_m);
  layering::HeightStatistics heights = layering::height_statistics(outlines);
  if (fed_back_m) {
    heights.average = plane.mean_height_m;
    heights.minimum = plane.least_height_m;
    heights.maximum = plane.greatest_height_m;
    heights.num_triangles = rounded(plane.triangles);
  }
  std::vector<int> chosen(counts.begin(), counts.end());
  if (chosen.empty())
    chosen = study.paper_compat ? layering::paper_counts(model.slabs(), study.policy)
                                : layering::sublayer_counts(model.slabs(), study.sublayers, height_m, heights);
  const mesh::LayerPlan plan =
      layering::divide_layers(model.slabs(), chosen, layering::slab_limits(model, study), study.height_bounds.height_growth)
          .plan;
  Forecast made{.triangles = rounded(plane.triangles), .sublayers = plan.num_sublayers(), .counts = {}, .memory = {}};
  made.counts = stack_up(plane, outlines, plan, model);
  add_unknowns(made);
  return made;
}

Forecast measured(const mesh::PrismMesh& mesh) {
  Forecast made{.is_exact = true,
                .triangles = mesh.planar().num_triangles(),
                .sublayers = mesh.plan().num_sublayers(),
                .counts = mesh::count_entities(mesh),
                .memory = {}};
  add_unknowns(made);
  return made;
}

void require_within_limits(const Forecast& forecast, const study::Study& study, std::string_view what) {
  const char* about = forecast.is_exact ? "exactly" : "about";
  if (forecast.counts.prisms > study.max_prisms)
    throw Error(
        ErrorCode::prism_limit,
        fmt::format("{} would give {} {:.3g} prisms, above the budget of {:.3g}; mesh a region (--nets, --region), take "
                    "a longer edge or another height policy, or raise --max-prisms",
                    what, about, static_cast<double>(forecast.counts.prisms), static_cast<double>(study.max_prisms)));
  const std::optional<std::int64_t> most = study.fabrication.max_unknowns;
  const std::int64_t total = forecast.on_prisms.front().total;
  if (!most || total <= *most) return;
  throw Error(ErrorCode::prism_limit,
              fmt::format("{}: {} prisms would give {} {} unknowns of first-order edge elements, above the limit of {}; mesh a "
                          "region (--nets, --region), take a longer edge or another height policy, or raise --max-unknowns",
                          what, forecast.counts.prisms, about, total, *most));
}

}  // namespace pcbmesh::pipeline
