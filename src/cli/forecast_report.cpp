// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/cli/forecast_report.hpp"

#include <fmt/format.h>

#include "src/cli/mesh_report.hpp"
#include "src/cli/terminal.hpp"

namespace pcbmesh::cli {
namespace {

using Json = nlohmann::ordered_json;

Json unknowns_json(const std::array<mesh::Unknowns, pipeline::highest_order>& by_order) {
  Json out = Json::array();
  for (std::size_t i = 0; i < by_order.size(); ++i)
    out.push_back({{"order", i + 1},
                   {"unknowns", by_order[i].total},
                   {"on_boundary", by_order[i].on_boundary},
                   {"nonzeros", by_order[i].nonzeros}});
  return out;
}

double percent(std::int64_t forecast, std::int64_t exact) {
  return exact == 0 ? 0 : 100 * (static_cast<double>(forecast) / static_cast<double>(exact) - 1);
}

}  // namespace

Json forecast_json(const pipeline::Forecast& f) {
  Json memory = Json::array();
  for (const pipeline::SolverMemory& m : f.memory)
    memory.push_back({{"solver", m.solver}, {"low_mib", m.low_mib}, {"high_mib", m.high_mib}});
  return {{"exact", f.is_exact},
          {"triangles", f.triangles},
          {"sublayers", f.sublayers},
          {"prisms", f.counts.prisms},
          {"tetrahedra", 3 * f.counts.prisms},
          {"nodes", f.counts.nodes},
          {"edges", f.counts.edges},
          {"faces", f.counts.triangles + f.counts.quads},
          {"edge_elements_on_prisms", unknowns_json(f.on_prisms)},
          {"edge_elements_on_tetrahedra", unknowns_json(f.on_tetrahedra)},
          {"solver_memory", std::move(memory)}};
}

Json assumptions_json(const Diagnostics& diagnostics) {
  Json out = Json::array();
  for (const Diagnostic& d : diagnostics.entries()) {
    if (!d.is_assumption) continue;
    Json places = Json::array();
    for (const Spot& spot : d.spots) places.push_back(spot.text());
    out.push_back({{"code", d.code}, {"text", d.text}, {"count", d.count}, {"places", std::move(places)}});
  }
  return out;
}

std::string forecast_text(const MeshRun& run) {
  const pipeline::Forecast& before = run.result.forecast;
  if (!run.measured) return {};
  const pipeline::Forecast& exact = *run.measured;
  std::string out = fmt::format("  {:<26} {:>16} {:>16} {:>8}\n", "forecast", "before", "exact", "error");
  const auto line = [&](const std::string& name, std::int64_t guess, std::int64_t count) {
    out += fmt::format("  {:<26} {:>16} {:>16} {:>7.1f}%\n", name, grouped(guess), grouped(count), percent(guess, count));
  };
  line("triangles", before.triangles, exact.triangles);
  line("sub-layers", before.sublayers, exact.sublayers);
  line("prisms", before.counts.prisms, exact.counts.prisms);
  line("tetrahedra of the twin", 3 * before.counts.prisms, 3 * exact.counts.prisms);
  for (std::size_t i = 0; i < exact.on_prisms.size(); ++i) {
    line(fmt::format("order {} on prisms", i + 1), before.on_prisms[i].total, exact.on_prisms[i].total);
    line(fmt::format("order {} on tetrahedra", i + 1), before.on_tetrahedra[i].total, exact.on_tetrahedra[i].total);
  }
  line("on the boundary, order 1", before.on_prisms[0].on_boundary, exact.on_prisms[0].on_boundary);
  line("matrix nonzeros, order 1", static_cast<std::int64_t>(before.on_prisms[0].nonzeros),
       static_cast<std::int64_t>(exact.on_prisms[0].nonzeros));
  for (const pipeline::SolverMemory& m : exact.memory)
    out += fmt::format("  {:<30} {:.3g} to {:.3g} GiB for order 1 on prisms\n", m.solver, m.low_mib / 1024, m.high_mib / 1024);
  return out;
}

}  // namespace pcbmesh::cli
