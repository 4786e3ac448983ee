// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/cli/page_contents.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "src/cli/terminal.hpp"

namespace pcbmesh::cli {
namespace {

/// A warning's place on the board, at the top of the mesh.
std::vector<std::array<double, 3>> places(const Diagnostic& entry, const mesh::PrismMesh& mesh) {
  std::vector<std::array<double, 3>> out;
  for (const Spot& spot : entry.spots)
    if (spot.at_mm) out.push_back({(*spot.at_mm)[0] * 1e-3, (*spot.at_mm)[1] * 1e-3, mesh.plan().z_m().back()});
  return out;
}

std::vector<std::pair<std::string, std::string>> facts(const MeshRun& run) {
  const pipeline::MeshBoardResult& r = run.result;
  double seconds = 0;
  for (const pipeline::StepTime& t : r.times) seconds += t.cpu_s;
  std::vector<std::pair<std::string, std::string>> out{
      {"Prisms", grouped(r.mesh.num_prisms())},
      {"Nodes", grouped(r.mesh.num_nodes())},
      {"Triangles", grouped(r.mesh.planar().num_triangles())},
      {"Sub-layers", fmt::format("{} in {} slabs", r.mesh.plan().num_sublayers(), r.mesh.plan().num_slabs())},
      {"Height policy",
       fmt::format("{}, sub-layers {}", study::name_of(r.resolved.policy), study::name_of(r.resolved.sublayers))},
      {"Common height", r.common_height_m > 0 ? fmt::format("{:.4g} um", r.common_height_m * 1e6) : "none"},
      {"Smallest angle", fmt::format("{:.2f} deg", r.triangulate.min_angle_deg)},
      {"Mean q_p", fmt::format("{:.4f}, by volume {:.4f}", r.quality.mean_prism, r.quality.volume_weighted_prism)},
      {"Worst q_p", fmt::format("{:.4g}, 1 % below {:.4g}", r.quality.min_prism, r.quality.quantile1_prism)},
      {"Mean q_t", fmt::format("{:.4f}", r.quality.mean_triangle)},
      {"Edges", fmt::format("{:.4g} to {:.4g} um", r.quality.shortest_edge_m * 1e6, r.quality.longest_edge_m * 1e6)},
      {"Vertices moved", fmt::format("{} of {}, tolerance {}", grouped(r.overlay.num_snapped),
                                     grouped(r.overlay.num_input_vertices), format_length(r.overlay.tolerance_nm))},
      {"CPU time", fmt::format("{:.2f} s for meshing", seconds)}};
  if (run.check != nullptr)
    for (const validation::CheckRun& check : run.check->checks)
      out.emplace_back(fmt::format("Check {}", check.name),
                       fmt::format("{} examined, {} found", grouped(check.num_examined), grouped(check.num_found)));
  return out;
}

/// What policy matched weighed up.
std::optional<view::FrontPlot> front(const MeshRun& run) {
  if (!run.result.match) return {};
  const pipeline::MatchResult& match = *run.result.match;
  view::FrontPlot out;
  for (const layering::FrontPoint& p : match.front) out.front.push_back({p.prisms, p.choice.quality.least()});
  if (match.knee < out.front.size()) out.knee = out.front[match.knee];
  for (const pipeline::MatchStep& step : match.steps)
    out.made.push_back({static_cast<double>(step.prisms), std::min(step.mean_prism, step.volume_weighted_prism)});
  out.chosen = match.chosen;
  out.goal = run.result.resolved.match.target_quality;
  return out;
}

}  // namespace

view::PageContents page_contents(const MeshRun& run, double unit_m) {
  view::PageContents page;
  page.source = run.board.source();
  page.title = run.board.name().empty() ? std::filesystem::path(page.source).filename().string() : run.board.name();
  if (run.check != nullptr) {
    page.passed = run.check->passed();
    page.places = view::places_of(*run.check, unit_m);
  }
  page.facts = facts(run);
  for (const Diagnostic& entry : run.result.diagnostics.entries())
    page.places.push_back({entry.severity == Severity::warning ? "warning" : "note", entry.code, entry.text, entry.count,
                           places(entry, run.result.mesh)});
  for (view::PagePlace& worst : view::places_of(run.quality)) page.places.push_back(std::move(worst));
  page.quality = run.quality;
  page.front = front(run);
  return page;
}

}  // namespace pcbmesh::cli
