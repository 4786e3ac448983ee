// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/pipeline/mesh_board.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <optional>
#include <utility>
#include <vector>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/compose/compose.hpp"
#include "pcbmesh/extrude/extrude.hpp"
#include "pcbmesh/layering/choose_layers.hpp"
#include "src/pipeline/straight_ports.hpp"

namespace pcbmesh::pipeline {
namespace {

constexpr double speed_of_light_m_per_s = 299'792'458.0;
/// Longest edge where the study names neither a length nor a frequency: the paper's 2 mm.
constexpr Nm default_longest_edge_nm = 2 * nm_per_mm;

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Runs steps one after another and books their CPU time.
class Stopwatch {
 public:
  explicit Stopwatch(std::vector<StepTime>& times) : times_(times) {}
  template <class Step>
  auto operator()(const char* name, Step&& step) {
    const double start = cpu_seconds();
    auto result = step();
    times_.push_back({name, cpu_seconds() - start});
    return result;
  }

 private:
  std::vector<StepTime>& times_;
};

Nm longest_edge_nm(const study::Study& study, const model::Model& model) {
  std::optional<Nm> edge = study.longest_edge;
  if (const std::optional<double> frequency_hz = study::highest_frequency_hz(study)) {
    double slowest = 1;
    for (const model::Slab& slab : model.slabs()) slowest = std::max(slowest, layering::slowness(model, slab));
    const double wavelength_m = speed_of_light_m_per_s / *frequency_hz / slowest;
    const double edge_m = wavelength_m / study.height_bounds.elements_per_wavelength;
    const auto bound = static_cast<Nm>(std::max(1.0, std::floor(edge_m / metres_per_nm)));
    edge = std::min(edge.value_or(bound), bound);
  }
  return edge.value_or(default_longest_edge_nm);
}

}  // namespace

MeshBoardResult mesh_board(const board::Board& board, const study::Study& given, const Progress& progress) {
  study::Study study = given;
  study.frequency_hz = study::highest_frequency_hz(given);
  Diagnostics diagnostics;
  std::vector<StepTime> times;
  Stopwatch timed(times);
  study::Study resolved = study;
  resolved.boundaries = study::resolved_boundaries(study);

  progress.at("compose", 0);
  const model::Model model = timed("compose", [&] { return compose::compose(board, study, diagnostics); });
  resolved.longest_edge = longest_edge_nm(study, model);

  overlay::OverlayOptions overlay_options;
  overlay_options.tolerance_nm = study.tolerance;
  // Simplification by more than a sagitta moves the corners of chords off their arcs, which second order needs.
  if (study.order == 2) overlay_options.coarsest_auto_nm = study.arcs.sagitta_nm;
  const auto lay_over = [&] {
    overlay::OverlayResult made = overlay::overlay(model, overlay_options, diagnostics, progress);
    // Outlines within the tolerance of a port bend it. Where the tolerance is ours, a smaller one is tried for the ports' sake.
    while (!study.tolerance && made.statistics.tolerance_nm >= 2 * nm_per_um) {
      const std::vector<std::size_t> bent = bent_ports(made.graph, model);
      if (bent.empty()) break;
      diagnostics.note("overlay.bent_port",
                       fmt::format("tolerance {}: outlines within it bend port '{}'; a smaller one is taken",
                                   format_length(made.statistics.tolerance_nm), model.ports()[bent.front()].name));
      overlay_options.tolerance_nm = made.statistics.tolerance_nm / 2;
      made = overlay::overlay(model, overlay_options, diagnostics, progress);
    }
    return made;
  };
  overlay::OverlayResult graph = timed("overlay", lay_over);
  // Not the tolerance that held in the end: a run that starts there would take other ways, and the resolved study repeats this
  // one.
  resolved.tolerance = graph.statistics.first_tolerance_nm;

  triangulate::TriangulateOptions options;
  options.longest_edge_nm = static_cast<double>(*resolved.longest_edge);
  options.min_angle_deg = study.min_angle_deg;
  if (study.edge_at_copper) options.grading = triangulate::Grading{static_cast<double>(*study.edge_at_copper), study.growth};
  options.seed = study.seed == study::TriangleSeed::hex ? triangulate::Seed::hexagonal : triangulate::Seed::delaunay;
  options.smooth = study.smooth;
  options.split_sheet_chords = study.solver == study::Solver::palace;
  options.as_in_paper = study.paper_compat;
  triangulate::TriangulateResult planar =
      timed("triangulate", [&] { return triangulate::triangulate(graph.graph, model, options, diagnostics, progress); });

  // Where nets overlap in the layout itself, one of them owns the common copper and the other may be cut by it: how many pieces
  // it has is then no measure of the mesh.
  for (const auto& pair : graph.touching_nets)
    for (const std::int32_t net : pair) graph.net_pieces[static_cast<std::size_t>(net)] = -1;

  const std::vector<layering::SlabLimits> limits = layering::slab_limits(model, study);
  layering::HeightStatistics heights = layering::height_statistics(planar.mesh);
  std::vector<int> counts;
  std::optional<MatchResult> match;
  Forecast expected;
  const std::optional<double> height_m = layering::common_height_m(study.policy, heights, model.slabs());
  std::optional<double> feedback_m;
  if (study.policy == study::HeightPolicy::matched) {
    // Edge and counts together: predict, triangulate, measure, repeat.
    MatchedMesh matched = timed("match quality", [&] {
      return match_quality(graph, model, study, options, std::move(planar), limits, diagnostics, progress);
    });
    options.longest_edge_nm = matched.longest_edge_m / metres_per_nm;
    planar = std::move(matched.planar);
    counts = std::move(matched.counts);
    match = std::move(matched.result);
    heights = layering::height_statistics(planar.mesh);
    expected = forecast(planar.mesh, std::nullopt, std::nullopt, counts, model, study);
  } else {
    // The paper's feedback: the common height of the first mesh becomes the longest edge of the second.
    if (height_m) feedback_m = layering::feedback_edge_m(study.policy, *height_m, options.longest_edge_nm * metres_per_nm);
    expected = forecast(planar.mesh, feedback_m, height_m, {}, model, study);
    require_within_limits(expected, study,
                          fmt::format("height policy '{}' with edges of {:.4g} um", study::name_of(study.policy),
                                      feedback_m.value_or(options.longest_edge_nm * metres_per_nm) * 1e6));
    if (feedback_m) {
      options.longest_edge_nm = *feedback_m / metres_per_nm;
      planar = timed("triangulate again",
                     [&] { return triangulate::triangulate(graph.graph, model, options, diagnostics, progress); });
      heights = layering::height_statistics(planar.mesh);
    }
    counts = study.paper_compat ? layering::paper_counts(model.slabs(), study.policy)
                                : layering::sublayer_counts(model.slabs(), study.sublayers, height_m, heights);
  }

  progress.at("choose layers", 0);
  layering::DividedLayers layers = layering::divide_layers(model.slabs(), counts, limits, study.height_bounds.height_growth);
  require_within_limits(forecast(planar.mesh, std::nullopt, std::nullopt, counts, model, study), study,
                        fmt::format("{} triangles in {} sub-layers", planar.mesh.num_triangles(), layers.plan.num_sublayers()));

  progress.at("extrude", 0);
  mesh::PrismMesh prisms = timed(
      "extrude", [&] { return extrude::extrude(planar.mesh, layers.plan, model, graph.net_pieces, graph.touching_nets); });
  if (study.fabrication.max_unknowns) require_within_limits(measured(prisms), study, "the finished mesh");
  progress.at("quality", 0);
  const layering::QualityStatistics quality = timed("quality", [&] { return layering::quality_statistics(prisms); });

  return {std::move(prisms),
          std::move(resolved),
          graph.statistics,
          std::move(graph.ledger),
          planar.statistics,
          heights,
          height_m.value_or(0),
          feedback_m.has_value(),
          options.longest_edge_nm * metres_per_nm,
          std::move(layers.layers),
          std::move(match),
          quality,
          expected,
          std::move(diagnostics),
          std::move(times),
          {model.circles().begin(), model.circles().end()}};
}

}  // namespace pcbmesh::pipeline
