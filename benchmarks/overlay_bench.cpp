// SPDX-License-Identifier: GPL-3.0-or-later
// Cleaning and triangulating four real boards of Debian's kicad-demos package, beside what they must come to: 20 um tolerance,
// chords within 5 um of the arcs, copper without drills, edges at most 2 mm. Prints a table; docs/evidence/overlay.md keeps it.
// usage: overlay_bench [folder with the demo boards]
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <string>
#include <vector>

#include "pcbmesh/compose/compose.hpp"
#include "pcbmesh/formats/registry.hpp"
#include "pcbmesh/overlay/overlay.hpp"
#include "pcbmesh/triangulate/triangulate.hpp"

namespace {

using namespace pcbmesh;

/// What a board must come to.
struct Limits {
  const char* file;
  double triangles, prep_s, refine_s, label_s, min_angle_deg, share_below_percent, min_edge_um, total_area_percent,
      p99_area_percent;
};

constexpr std::array boards{
    Limits{"sonde xilinx.kicad_pcb", 32e3, 0.3, 0.15, 0.05, 8, 0.05, 15, 0.05, 1},
    Limits{"StickHub.kicad_pcb", 38e3, 0.7, 0.15, 0.05, 10, 0.05, 8, 0.05, 2},
    Limits{"kit-dev-coldfire-xilinx_5213.kicad_pcb", 440e3, 6, 3, 0.7, 5, 0.1, 6, 0.05, 2.5},
    Limits{"video.kicad_pcb", 1.25e6, 22, 10, 2, 4, 0.05, 5, 0.05, 2.5},
};

double cpu_s() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

std::filesystem::path find(const std::filesystem::path& folder, const std::string& name) {
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.path().filename() == name || entry.path().filename() == name + ".gz") return entry.path();
  return {};
}

board::Board without_drills(const board::Board& board) {
  board::BoardParts parts;
  parts.name = board.name();
  parts.source = board.source();
  parts.materials.assign(board.materials().begin(), board.materials().end());
  parts.stackup.assign(board.stackup().begin(), board.stackup().end());
  parts.nets.assign(board.nets().begin(), board.nets().end());
  parts.outlines.assign(board.outlines().begin(), board.outlines().end());
  parts.shapes.assign(board.shapes().begin(), board.shapes().end());
  return board::Board::from_parts(std::move(parts));
}

struct Angles {
  double smallest = 180, shortest_edge_um = 1e9;
  std::int64_t below = 0;  ///< triangles with an angle below 20.5 degrees
};

Angles angles_of(const mesh::PlanarMesh& mesh) {
  Angles out;
  for (std::int32_t t = 0; t < mesh.num_triangles(); ++t) {
    std::array<double, 3> e = mesh.squared_edges_m2(t);
    std::sort(e.begin(), e.end());
    const double angle = std::acos((e[1] + e[2] - e[0]) / (2 * std::sqrt(e[1] * e[2]))) * 57.29577951308232;
    out.smallest = std::min(out.smallest, angle);
    out.shortest_edge_um = std::min(out.shortest_edge_um, std::sqrt(e[0]) * 1e6);
    out.below += angle < 20.5 ? 1 : 0;
  }
  return out;
}

/// "value (limit)", with a cross where it is missed.
std::string cell(double value, double limit, bool at_least, const char* format) {
  const bool holds = at_least ? value >= limit : value <= limit;
  return fmt::format("{} ({} {:g}){}", fmt::format(fmt::runtime(format), value), at_least ? ">=" : "<=", limit,
                     holds ? "" : " MISSED");
}

bool run(const std::filesystem::path& folder, const Limits& limits) {
  const std::filesystem::path file = find(folder, limits.file);
  if (file.empty()) {
    fmt::print("| {} | not found below {} |\n", limits.file, folder.string());
    return false;
  }
  study::Study study;
  study.air_above = study.air_below = 0;
  Diagnostics diagnostics;
  const model::Model model = compose::compose(without_drills(formats::read_board(file).board), study, diagnostics);
  const double start = cpu_s();
  const overlay::OverlayResult graph = overlay::overlay(model, {.tolerance_nm = 20 * nm_per_um}, diagnostics);
  const double prep_s = cpu_s() - start;
  std::vector<double> errors;
  for (const overlay::SnapRecord& r : graph.ledger)
    if (model.bodies()[static_cast<std::size_t>(r.body)].kind == model::BodyKind::copper && r.area_before_mm2 > 0)
      errors.push_back(100 * std::abs(r.area_after_mm2 / r.area_before_mm2 - 1));
  std::sort(errors.begin(), errors.end());
  const double p99 = errors.empty() ? 0 : errors[errors.size() * 99 / 100];
  const triangulate::TriangulateResult planar = triangulate::triangulate(graph.graph, model, {}, diagnostics);
  const Angles angles = angles_of(planar.mesh);
  const auto& s = planar.statistics;
  const double num = planar.mesh.num_triangles();
  fmt::print("| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", limits.file, graph.statistics.attempts,
             cell(num, limits.triangles, false, "{:.0f}"), cell(prep_s, limits.prep_s, false, "{:.2f}"),
             cell(s.cdt_s + s.refine_s, limits.refine_s, false, "{:.2f}"), cell(s.label_s, limits.label_s, false, "{:.2f}"),
             cell(angles.smallest, limits.min_angle_deg, true, "{:.2f}"),
             cell(100 * static_cast<double>(angles.below) / num, limits.share_below_percent, false, "{:.3f}"),
             cell(angles.shortest_edge_um, limits.min_edge_um, true, "{:.1f}"),
             cell(100 * std::abs(graph.statistics.total_area_error), limits.total_area_percent, false, "{:.3f}"),
             cell(p99, limits.p99_area_percent, false, "{:.2f}"), graph.touching_nets.size());
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  const std::filesystem::path folder = argc > 1 ? argv[1] : "/usr/share/kicad/demos";
  fmt::print(
      "| board | attempts | triangles | overlay s | CDT + refine s | label s | smallest angle | below 20.5 deg, % | shortest "
      "edge um | copper area error % | "
      "99 % of bodies within % | touching nets |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  bool all = true;
  for (const Limits& limits : boards) all = run(folder, limits) && all;
  return all ? 0 : 1;
}
