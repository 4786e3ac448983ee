// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/cli/mesh_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/resource.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "pcbmesh/base/version.hpp"
#include "pcbmesh/mesh/port_measures.hpp"
#include "src/cli/diagnostics_json.hpp"
#include "src/cli/explain_text.hpp"
#include "src/cli/forecast_report.hpp"
#include "src/cli/quality_text.hpp"
#include "src/cli/terminal.hpp"

namespace pcbmesh::cli {
namespace {

using Json = nlohmann::ordered_json;

double peak_memory_mib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

/// Ledger entries by largest move; the whole ledger of a big board has thousands of lines, so the worst hundred are kept.
Json ledger_json(const std::vector<overlay::SnapRecord>& ledger) {
  constexpr std::size_t most = 100;
  std::vector<overlay::SnapRecord> sorted = ledger;
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.max_move_nm > b.max_move_nm; });
  if (sorted.size() > most) sorted.resize(most);
  Json out = Json::array();
  for (const overlay::SnapRecord& r : sorted)
    out.push_back({{"body", r.body},
                   {"moved", r.num_moved},
                   {"max_move_um", static_cast<double>(r.max_move_nm) * 1e-3},
                   {"at_mm", {static_cast<double>(r.at.x) * 1e-6, static_cast<double>(r.at.y) * 1e-6}},
                   {"area_before_mm2", r.area_before_mm2},
                   {"area_after_mm2", r.area_after_mm2}});
  return out;
}

/// Size of a file, or of all files of a folder.
double megabytes_of(const std::filesystem::path& file) {
  std::error_code ignored;
  std::uintmax_t bytes = 0;
  if (std::filesystem::is_directory(file, ignored)) {
    for (const auto& entry : std::filesystem::directory_iterator(file, ignored)) bytes += entry.file_size(ignored);
  } else {
    bytes = std::filesystem::file_size(file, ignored);
  }
  return static_cast<double>(bytes) * 1e-6;
}

/// How finely each port is meshed.
Json ports_json(const mesh::PrismMesh& mesh) {
  Json out = Json::array();
  const std::vector<mesh::PortMeasure> measures = mesh::measure_ports(mesh);
  const auto count = [](int n) { return n > 0 ? Json(n) : Json(nullptr); };
  for (std::size_t i = 0; i < measures.size(); ++i) {
    const mesh::PortMeasure& m = measures[i];
    out.push_back({{"name", mesh.ports()[i].name},
                   {"faces", m.num_faces},
                   {"elements_along", count(m.least_along)},
                   {"elements_across", count(m.least_across)},
                   {"shortest_edge_m", m.shortest_edge_m},
                   {"longest_edge_m", m.longest_edge_m},
                   {"worst_aspect", m.worst_aspect}});
  }
  return out;
}

std::string ports_text(const mesh::PrismMesh& mesh) {
  std::int64_t faces = 0;
  double worst = 0;
  std::size_t where = 0;
  const std::vector<mesh::PortMeasure> measures = mesh::measure_ports(mesh);
  for (std::size_t i = 0; i < measures.size(); ++i) {
    faces += measures[i].num_faces;
    if (measures[i].worst_aspect <= worst) continue;
    worst = measures[i].worst_aspect;
    where = i;
  }
  return fmt::format("{}, {} faces, longest over shortest edge of one at most {:.3g} ({})", measures.size(), grouped(faces),
                     worst, mesh.ports()[where].name);
}

}  // namespace

std::string report_json(const MeshRun& run) {
  const pipeline::MeshBoardResult& r = run.result;
  Json times = Json::object();
  double total = 0;
  for (const pipeline::StepTime& t : r.times) {
    times[t.step] = t.cpu_s;
    total += t.cpu_s;
  }
  times["total"] = total;
  Json out{{"pcbmesh", version()},
           {"board", run.board.source()},
           {"counts",
            {{"triangles", r.mesh.planar().num_triangles()},
             {"sublayers", r.mesh.plan().num_sublayers()},
             {"prisms", r.mesh.num_prisms()},
             {"nodes", r.mesh.num_nodes()},
             {"tagged_triangles", r.mesh.num_tagged_triangles()},
             {"tagged_quads", r.mesh.num_tagged_quads()},
             {"volume_groups", r.mesh.volume_tags().size()},
             {"face_groups", r.mesh.face_tags().size()}}},
           {"overlay",
            {{"tolerance_um", static_cast<double>(r.overlay.tolerance_nm) * 1e-3},
             {"attempts", r.overlay.attempts},
             {"vertices_in", r.overlay.num_input_vertices},
             {"vertices_snapped", r.overlay.num_snapped},
             {"crossings", r.overlay.num_crossings},
             {"passes", r.overlay.num_passes},
             {"worst_area_error", r.overlay.worst_body_area_error},
             {"total_area_error", r.overlay.total_area_error},
             {"largest_moves", ledger_json(r.ledger)}}},
           {"triangulation",
            {{"seed", study::name_of(r.resolved.seed)},
             {"smooth", r.resolved.smooth},
             {"longest_edge_bound_m", r.longest_edge_m},
             {"min_angle_deg", r.triangulate.min_angle_deg},
             {"triangles_below_bound", r.triangulate.num_below_bound},
             {"input_vertices", r.triangulate.num_input_vertices},
             {"steiner_vertices", r.triangulate.num_steiner}}},
           {"heights",
            {{"policy", study::name_of(r.resolved.policy)},
             {"sublayers", study::name_of(r.resolved.sublayers)},
             {"common_height_m", r.common_height_m},
             {"fed_back", r.fed_back},
             {"optimal_min_m", r.heights.minimum},
             {"optimal_weighted_m", r.heights.weighted},
             {"optimal_average_m", r.heights.average},
             {"optimal_max_m", r.heights.maximum}}},
           {"layers", layers_json(r, run.layers)},
           {"match", match_json(r)},
           {"quality",
            {{"mean_triangle", r.quality.mean_triangle},
             {"min_triangle", r.quality.min_triangle},
             {"mean_prism", r.quality.mean_prism},
             {"volume_weighted_prism", r.quality.volume_weighted_prism},
             {"min_prism", r.quality.min_prism},
             {"quantile1_prism", r.quality.quantile1_prism},
             {"shortest_edge_m", r.quality.shortest_edge_m},
             {"longest_edge_m", r.quality.longest_edge_m}}},
           {"quality_report", quality_json(run.quality)},
           {"ports", ports_json(r.mesh)},
           {"cpu_s", times},
           {"peak_memory_mib", peak_memory_mib()},
           {"forecast", forecast_json(r.forecast)},
           {"measured", run.measured ? forecast_json(*run.measured) : Json(nullptr)},
           {"assumptions", assumptions_json(r.diagnostics)},
           {"diagnostics", diagnostics_json(r.diagnostics)},
           {"check", run.check == nullptr ? Json(nullptr) : Json::parse(validation::to_json(*run.check))},
           {"files", run.files}};
  if (run.second_order)
    out["second_order"] = {{"curved_edges", run.second_order->num_curved_edges},
                           {"straightened_edges", run.second_order->num_straightened_edges},
                           {"folded_triangles", run.second_order->num_folded_triangles}};
  return out.dump(2);
}

std::string report_text(const MeshRun& run) {
  const pipeline::MeshBoardResult& r = run.result;
  const auto line = [](std::string_view name, const std::string& text) { return fmt::format("  {:<13} {}\n", name, text); };
  std::string out = fmt::format("{}\n", run.board.source());
  out += line("outlines", fmt::format("tolerance {}, {} of {} vertices moved, worst copper area error {:.2g} %",
                                      format_length(r.overlay.tolerance_nm), grouped(r.overlay.num_snapped),
                                      grouped(r.overlay.num_input_vertices), 100 * r.overlay.worst_body_area_error));
  out += line("triangles",
              fmt::format("{}, smallest angle {:.1f} deg, {} below {:.1f} deg", grouped(r.mesh.planar().num_triangles()),
                          r.triangulate.min_angle_deg, grouped(r.triangulate.num_below_bound), r.resolved.min_angle_deg));
  const std::string height = r.common_height_m > 0 ? fmt::format(", common height {:.4g} um{}", r.common_height_m * 1e6,
                                                                 r.fed_back ? ", fed back as longest edge" : "")
                                                   : "";
  out += line("sub-layers", fmt::format("{} in {} slabs (policy {}{})", r.mesh.plan().num_sublayers(),
                                        r.mesh.plan().num_slabs(), study::name_of(r.resolved.policy), height));
  out += line("prisms", fmt::format("{} on {} nodes, {} volume groups, {} face groups", grouped(r.mesh.num_prisms()),
                                    grouped(r.mesh.num_nodes()), r.mesh.volume_tags().size(), r.mesh.face_tags().size()));
  out +=
      line("quality", fmt::format("triangles {:.4f}, prisms {:.4f} (by volume {:.4f}, worst {:.4f})", r.quality.mean_triangle,
                                  r.quality.mean_prism, r.quality.volume_weighted_prism, r.quality.min_prism));
  if (!r.mesh.ports().empty()) out += line("ports", ports_text(r.mesh));
  if (run.second_order)
    out += line("order 2",
                fmt::format("{} chords of the plane lie on their arcs; {} stay straight, because {} triangles would fold",
                            grouped(run.second_order->num_curved_edges), grouped(run.second_order->num_straightened_edges),
                            grouped(run.second_order->num_folded_triangles)));
  double total = 0;
  for (const pipeline::StepTime& t : r.times) total += t.cpu_s;
  out += line("effort", fmt::format("{:.2f} s CPU to mesh, peak memory {:.0f} MiB", total, peak_memory_mib()));
  if (run.check == nullptr) {
    out += line("check", "not run");
  } else {
    std::int64_t errors = 0;
    for (const validation::Finding& f : run.check->findings)
      errors += f.severity == validation::FindingSeverity::error ? f.count : 0;
    out += line("check", run.check->passed() ? fmt::format("passed: {} checks, no error", run.check->checks.size())
                                             : fmt::format("FAILED with {} errors", grouped(errors)));
    std::int64_t as_laid_out = 0, judged = 0;
    for (const validation::NetVerdict& net : run.check->nets) {
      if (net.expected_pieces >= 0) ++judged;
      if (net.expected_pieces == net.pieces) ++as_laid_out;
    }
    out += line("nets", fmt::format("{} of {} connected as in the layout, {} not judged", as_laid_out, judged,
                                    static_cast<std::int64_t>(run.check->nets.size()) - judged));
    for (const validation::Finding& f : run.check->findings)
      out += fmt::format("    {} [{}] {}\n", f.severity == validation::FindingSeverity::error ? "error" : "warning", f.code,
                         f.text);
  }
  for (const std::string& file : run.files) out += line("wrote", fmt::format("{} ({:.1f} MB)", file, megabytes_of(file)));
  return out;
}

}  // namespace pcbmesh::cli
