// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/triangulate/triangulate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <ctime>
#include <limits>
#include <numbers>
#include <utility>

#include "pcbmesh/base/error.hpp"
#include "src/triangulate/extract.hpp"
#include "src/triangulate/flood.hpp"
#include "src/triangulate/hex_seed.hpp"
#include "src/triangulate/insert_graph.hpp"
#include "src/triangulate/periodic_sides.hpp"
#include "src/triangulate/refine.hpp"
#include "src/triangulate/sheet_chords.hpp"
#include "src/triangulate/smooth.hpp"

namespace pcbmesh::triangulate {
namespace {

// Far below any feature and far above what doubles resolve on a board of a metre.
constexpr double floor_nm = 50;
// Measured on the paper's examples and real boards: later sweeps gain less than 0.1 % of quality.
constexpr int seed_sweeps = 10;
constexpr int guarded_sweeps = 20;
constexpr int chord_rounds = 3;
// Splits go down to where the triangles are good; a handful of rounds is normal.
constexpr int most_mirrorings = 40;
// Before refinement needles at outlines are normal; this keeps smoothing from making new ones (8 degrees).
constexpr double seed_guard_sine2 = 0.02;

/// CPU seconds of the process since the last call.
class CpuClock {
 public:
  double lap() {
    const double now = read(), spent = now - last_;
    last_ = now;
    return spent;
  }

 private:
  static double read() {
    std::timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  }
  double last_ = read();
};

void check(const TriangulateOptions& options) {
  const auto is_positive = [](double x) { return std::isfinite(x) && x > 0; };
  if (!is_positive(options.longest_edge_nm)) throw Error(ErrorCode::usage, "the longest edge must be a length above 0");
  if (!(options.min_angle_deg > 0 && options.min_angle_deg <= 28.6)) {
    throw Error(ErrorCode::usage,
                fmt::format("the smallest angle is {} degrees; it must be above 0 and at most 28.6", options.min_angle_deg));
  }
  if (options.grading && !(is_positive(options.grading->edge_at_copper_nm) && is_positive(options.grading->growth))) {
    throw Error(ErrorCode::usage, "grading needs an edge length at copper and a growth above 0");
  }
  if (options.grading && options.seed == Seed::hexagonal) {
    throw Error(ErrorCode::usage, "the hexagonal seed has edges of one length; leave out grading, or take the Delaunay seed");
  }
  if (options.grading && options.as_in_paper)
    throw Error(ErrorCode::usage, "the paper's meshes are not graded: drop one of the two");
}

std::vector<SegmentDistance::Segment> copper_segments(const mesh::PlanarGraph& graph, const model::Model& model,
                                                      double unit_nm) {
  const auto bodies = model.bodies();
  const auto is_copper = [&](const mesh::Increment& increment) {
    const auto kind = bodies[static_cast<std::size_t>(increment.body)].kind;
    return kind == model::BodyKind::copper || kind == model::BodyKind::barrel;
  };
  std::vector<SegmentDistance::Segment> segments;
  for (std::size_t e = 0; e < graph.edges().size(); ++e) {
    const auto increments = graph.increments(e);
    if (std::none_of(increments.begin(), increments.end(), is_copper)) continue;
    const auto p = graph.vertices()[static_cast<std::size_t>(graph.edges()[e][0])];
    const auto q = graph.vertices()[static_cast<std::size_t>(graph.edges()[e][1])];
    segments.push_back({static_cast<double>(p.x) / unit_nm, static_cast<double>(p.y) / unit_nm,
                        static_cast<double>(q.x) / unit_nm, static_cast<double>(q.y) / unit_nm});
  }
  return segments;
}

/// Ports want two elements at least across and along, and what the study says.
void bound_ports(const model::Model& model, double unit_nm, MeshBounds& bounds) {
  for (const model::Port& port : model.ports()) {
    double longest_m = port.longest_edge_m > 0 ? port.longest_edge_m : std::numeric_limits<double>::infinity();
    if (!port.is_wave) longest_m = std::min(longest_m, 0.5 * port.width_m);
    if (port.faces == model::PortFaces::cap) longest_m = std::min(longest_m, 0.5 * port.length_m);
    if (!std::isfinite(longest_m)) continue;
    MeshBounds::Spot spot{{}, longest_m / metres_per_nm / unit_nm};
    for (const model::BodyShape& shape : model.shapes()) {
      if (shape.body != port.body) continue;
      for (const geometry::Ring& ring : shape.rings) {
        auto& corners = spot.rings.emplace_back();
        for (const geometry::Point p : ring)
          corners.push_back({static_cast<double>(p.x) / unit_nm, static_cast<double>(p.y) / unit_nm});
      }
    }
    bounds.add_spot(std::move(spot));
  }
}

/// Area, in squared units of the triangulation, of the faces inside the domain.
double mark_domain(Cdt& cdt, const Regions& regions) {
  double area = 0;
  for (auto face = cdt.all_faces_begin(); face != cdt.all_faces_end(); ++face) {
    const bool is_inside = regions.is_in_domain(face->ticket() - 1);
    face->set_in_domain(is_inside);
    face->set_ticket(0);
    if (is_inside) area += cdt.triangle(face).area();
  }
  return area;
}

}  // namespace

TriangulateResult triangulate(const mesh::PlanarGraph& graph, const model::Model& model, const TriangulateOptions& options,
                              Diagnostics& diagnostics, const Progress& progress) {
  check(options);
  for (std::size_t e = 0; e < graph.edges().size(); ++e) {
    PCBMESH_ASSERT(static_cast<std::size_t>(graph.increments(e).back().body) < model.bodies().size());
  }
  progress.at("triangulate", 0);
  CpuClock clock;
  TriangulateStatistics statistics;
  const double unit_nm = options.as_in_paper ? 1e6 : 1;
  Cdt cdt;
  insert_graph(graph, unit_nm, cdt, progress);
  if (cdt.dimension() < 2) {  // no ring, so no domain
    return {mesh::PlanarMesh::from_parts({.points_m = {},
                                          .triangles = {},
                                          .regions = {},
                                          .constrained = {},
                                          .region_body_offsets = {0},
                                          .region_bodies = {}}),
            statistics};
  }
  const GraphEdgeIndex graph_edges(graph);
  const PeriodicSides periodic(model, unit_nm);
  if (!periodic.is_empty()) {
    (void)periodic.mirror(cdt, graph_edges);
    periodic.require_same(cdt, flood(cdt, graph, graph_edges), model);
  }
  const double area = mark_domain(cdt, flood(cdt, graph, graph_edges));
  statistics.num_input_vertices = static_cast<std::int64_t>(graph.vertices().size());
  statistics.cdt_s = clock.lap();

  MeshBounds bounds(options.longest_edge_nm / unit_nm, options.min_angle_deg, floor_nm / unit_nm);
  const SegmentDistance copper(options.grading ? copper_segments(graph, model, unit_nm)
                                               : std::vector<SegmentDistance::Segment>{});
  if (options.grading && !copper.is_empty()) {
    bounds.set_grading(options.grading->edge_at_copper_nm / unit_nm, options.grading->growth, copper);
  }
  bound_ports(model, unit_nm, bounds);
  // For the progress bar only. Where the longest edge drives, triangles have about 0.2 L^2 and share half a vertex each.
  const double longest = options.longest_edge_nm / unit_nm;
  const double expected = 3 * static_cast<double>(graph.vertices().size()) + 2.6 * area / (longest * longest);
  const RefineLimits limits{options.max_vertices, expected, unit_nm};
  // Each side gets the vertices that refinement put on its partner, until neither asks for more.
  const auto refine_all = [&] {
    for (int round = 0;; ++round) {
      refine(cdt, bounds, graph_edges, limits, options.as_in_paper, progress);
      if (periodic.is_empty() || periodic.mirror(cdt, graph_edges) == 0) return;
      if (round == most_mirrorings)
        throw Error(ErrorCode::triangulation_limit,
                    fmt::format("the triangles of periodic sides do not settle within {} rounds; take a longer edge, or a "
                                "region whose sides are crossed at right angles",
                                most_mirrorings));
      mark_domain(cdt, flood(cdt, graph, graph_edges));
    }
  };
  if (options.seed == Seed::hexagonal) {
    seed_hexagonal(cdt, graph_edges, {.edge = lattice_over_longest * longest, .max_vertices = options.max_vertices}, progress);
    mark_domain(cdt, flood(cdt, graph, graph_edges));
    smooth(cdt, bounds, {seed_sweeps, seed_guard_sine2}, progress);
  }
  refine_all();
  if (options.smooth) {
    smooth(cdt, bounds, {guarded_sweeps, bounds.sine2_bound()}, progress);
    refine_all();  // flips may have made an edge too long
  }
  if (options.split_sheet_chords) {
    // Splitting makes angles smaller and refinement may put vertices on rims again: twice for quality, at last for the rule.
    for (int round = 0; round < chord_rounds; ++round) {
      const std::int64_t num_splits = split_sheet_chords(cdt, graph, graph_edges, model);
      statistics.num_chord_splits += num_splits;
      if (num_splits == 0 || round + 1 == chord_rounds) break;
      mark_domain(cdt, flood(cdt, graph, graph_edges));
      refine_all();
    }
  }
  statistics.refine_s = clock.lap();

  const Regions regions = flood(cdt, graph, graph_edges);
  Extraction extraction = extract(cdt, unit_nm, regions, bounds.sine2_bound(), periodic.in_order(cdt));
  statistics.num_steiner = extraction.num_vertices - statistics.num_input_vertices;
  statistics.num_below_bound = extraction.num_below_bound;
  statistics.min_angle_deg = std::asin(std::sqrt(std::min(extraction.smallest_sine2, 0.75))) * 180 / std::numbers::pi;
  TriangulateResult result{mesh::PlanarMesh::from_parts(std::move(extraction.parts)), statistics};
  result.statistics.label_s = clock.lap();
  if (statistics.num_below_bound > 0) {
    diagnostics.note(
        "triangulate.angle_below_bound",
        fmt::format("{} of {} triangles have an angle below {} degrees (smallest {:.2f}): the features meet at small angles",
                    statistics.num_below_bound, result.mesh.num_triangles(), options.min_angle_deg, statistics.min_angle_deg));
  }
  progress.at("triangulate", 1);
  return result;
}

}  // namespace pcbmesh::triangulate
