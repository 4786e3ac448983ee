// SPDX-License-Identifier: GPL-3.0-or-later
// Triangulation against CGAL's stock mesher: same graph, same bounds, same process. Process CPU seconds, best of the runs.
// Usage: triangulate_bench [runs [ours]]

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_mesh_face_base_2.h>
#include <CGAL/Delaunay_mesh_size_criteria_2.h>
#include <CGAL/Delaunay_mesh_vertex_base_2.h>
#include <CGAL/Delaunay_mesher_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "benchmarks/synthetic_graph.hpp"
#include "pcbmesh/triangulate/triangulate.hpp"

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using StockTds =
    CGAL::Triangulation_data_structure_2<CGAL::Delaunay_mesh_vertex_base_2<Kernel>, CGAL::Delaunay_mesh_face_base_2<Kernel>>;
using StockCdt =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, StockTds, CGAL::No_constraint_intersection_requiring_constructions_tag>;
using StockCriteria = CGAL::Delaunay_mesh_size_criteria_2<StockCdt>;

double cpu_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Hands free memory back and starts the peak anew (Linux).
void reset_peak() {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5";
}

double status_mb(const std::string& field) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.rfind(field, 0) == 0) return std::strtod(line.c_str() + field.size() + 1, nullptr) / 1024;
  }
  return 0;
}

struct Run {
  double seconds = 1e30;
  double peak_mb = 0;  // above what stood in memory before
  std::int64_t num_triangles = 0;
  double parts_s[3] = {0, 0, 0};
};

Run run_stock(const pcbmesh::mesh::PlanarGraph& graph, double longest_edge_nm) {
  reset_peak();
  const double before_mb = status_mb("VmRSS:"), start = cpu_seconds();
  Run run;
  {
    std::vector<Kernel::Point_2> points;
    for (const auto& p : graph.vertices()) points.emplace_back(static_cast<double>(p.x), static_cast<double>(p.y));
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    for (const auto& [u, v] : graph.edges()) pairs.emplace_back(static_cast<std::size_t>(u), static_cast<std::size_t>(v));
    StockCdt cdt;
    cdt.insert_constraints(points.begin(), points.end(), pairs.begin(), pairs.end());
    run.parts_s[0] = cpu_seconds() - start;
    CGAL::Delaunay_mesher_2<StockCdt, StockCriteria> mesher(cdt, StockCriteria(0.125, longest_edge_nm));
    mesher.refine_mesh();
    run.seconds = cpu_seconds() - start;
    run.parts_s[1] = run.seconds - run.parts_s[0];
    for (auto face = cdt.finite_faces_begin(); face != cdt.finite_faces_end(); ++face)
      run.num_triangles += face->is_in_domain() ? 1 : 0;
  }
  run.peak_mb = status_mb("VmHWM:") - before_mb;
  return run;
}

Run run_ours(const pcbmesh::mesh::PlanarGraph& graph, double longest_edge_nm) {
  static const pcbmesh::model::Model model = pcbmesh::benchmarks::synthetic_model();
  reset_peak();
  const double before_mb = status_mb("VmRSS:"), start = cpu_seconds();
  Run run;
  {
    pcbmesh::Diagnostics diagnostics;
    const auto result = pcbmesh::triangulate::triangulate(graph, model, {.longest_edge_nm = longest_edge_nm}, diagnostics);
    run.seconds = cpu_seconds() - start;
    run.num_triangles = result.mesh.num_triangles();
    run.parts_s[0] = result.statistics.cdt_s;
    run.parts_s[1] = result.statistics.refine_s;
    run.parts_s[2] = result.statistics.label_s;
  }
  run.peak_mb = status_mb("VmHWM:") - before_mb;
  return run;
}

void keep_best(Run& best, const Run& run) {
  if (run.seconds < best.seconds) best = run;
}

void compare(int width_mm, int height_mm, double longest_edge_nm, int runs, bool with_stock) {
  const auto graph = pcbmesh::benchmarks::synthetic_graph(width_mm, height_mm, 1);
  Run ours, stock;
  for (int i = 0; i < runs; ++i) {
    keep_best(ours, run_ours(graph, longest_edge_nm));
    if (with_stock) keep_best(stock, run_stock(graph, longest_edge_nm));
  }
  fmt::print("{}x{} mm, edges <= {:.0f} um: {} vertices, {} edges\n", width_mm, height_mm, longest_edge_nm / 1000,
             graph.vertices().size(), graph.edges().size());
  const auto row = [](const char* name, const Run& run) {
    const auto count = static_cast<double>(run.num_triangles);
    fmt::print(
        "  {:<6} {:>9} triangles {:8.3f} s (cdt {:.3f}, refine {:.3f}, label {:.3f}) {:8.0f} ktri/s {:7.1f} MB {:6.1f} "
        "B/triangle\n",
        name, run.num_triangles, run.seconds, run.parts_s[0], run.parts_s[1], run.parts_s[2], count / run.seconds / 1000,
        run.peak_mb, run.peak_mb * 1024 * 1024 / count);
  };
  row("ours", ours);
  if (!with_stock) return;
  row("stock", stock);
  fmt::print("  ratio: {:.2f} x (refinement alone {:.2f} x; triangles {:.4f}; stock leaves the labels out)\n",
             stock.seconds / ours.seconds, stock.parts_s[1] / ours.parts_s[1],
             static_cast<double>(ours.num_triangles) / static_cast<double>(stock.num_triangles));
}

}  // namespace

int main(int argc, char** argv) {
  const int runs = argc > 1 ? std::max(1, std::atoi(argv[1])) : 3;
  const bool with_stock = argc <= 2;
  compare(30, 23, 5e5, runs, with_stock);
  compare(50, 40, 1.1e5, runs, with_stock);
  compare(100, 80, 2.2e5, runs, with_stock);
  return 0;
}
