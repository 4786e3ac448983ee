// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/palace/format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "formats/deck/deck_file.hpp"
#include "formats/deck/limits.hpp"
#include "formats/palace/tables.hpp"

namespace pcbmesh::formats::palace {
namespace {

using Json = nlohmann::ordered_json;
using mesh::BoundaryCondition;

constexpr double hz_per_ghz = 1e9;
constexpr int element_order = 2;

constexpr deck::Limits limits{
    .solver = "Palace", .solid_copper = false, .wave_ports = true, .coaxial_ports = true, .lossy_resonances = true};

deck::FieldProblem state(const mesh::PrismMesh& mesh, const DeckOptions& options, Diagnostics& diagnostics) {
  deck::FieldProblem problem = deck::state_within(limits, mesh, options, 0, diagnostics);
  std::string waves;
  for (const deck::FieldPort& port : problem.ports)
    if (port.port.kind == mesh::PortKind::wave) waves += (waves.empty() ? "" : ", ") + port.port.name;
  if (!waves.empty() && options.problem == Problem::driven)
    diagnostics.note(
        "deck.wave_port_mode",
        "Palace takes the slowest mode of a wave port, so all copper on it but the net must be joined there (planes "
        "above and below by pec sides, the port as wide as the side); its S-parameters refer to the impedance of "
        "that mode, and the Touchstone file can only state that of the study: " +
            waves);
  for (const deck::FieldPort& port : problem.ports)
    if (port.port.kind == mesh::PortKind::wave)
      for (const deck::Face& face : problem.faces)
        if (face.is_inner && std::ranges::find(port.faces, face.id) != port.faces.end())
          deck::refuse(limits.solver, fmt::format("wave port '{}' inside the domain", port.port.name),
                       "a lumped port there, or the port on the hull");
  return problem;
}

/// "+Z" along an axis, "-R" towards the axis of a ring, else a unit vector.
Json direction(const mesh::Port& port) {
  if (port.kind == mesh::PortKind::coaxial) return "-R";
  const std::array<double, 3>& d = port.direction;
  constexpr std::array<const char*, 3> plus{"+X", "+Y", "+Z"}, minus{"-X", "-Y", "-Z"};
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (std::abs(std::abs(d[axis]) - 1) < 1e-9) return d[axis] > 0 ? plus[axis] : minus[axis];
  return d;
}

Json materials(const deck::FieldProblem& problem) {
  Json out = Json::array();
  for (const deck::Volume& volume : problem.volumes) {
    const board::Material& m = volume.material;
    Json entry{{"Attributes", {volume.id}}, {"Permittivity", m.eps_r}, {"Permeability", m.mu_r}};
    if (problem.options.problem != Problem::electrostatic) {
      entry["LossTan"] = m.tan_delta;
      if (m.sigma_s_per_m > 0) entry["Conductivity"] = m.sigma_s_per_m;
    }
    out.push_back(std::move(entry));
  }
  return out;
}

void add_ports(const deck::FieldProblem& problem, Json& boundaries) {
  for (std::size_t p = 0; p < problem.ports.size(); ++p) {
    const deck::FieldPort& port = problem.ports[p];
    const auto number = static_cast<std::int64_t>(p) + 1;
    // Every excited port is an excitation of its own: the full matrix in one run.
    const std::int64_t excitation = port.port.is_excited ? number : 0;
    if (port.port.kind == mesh::PortKind::wave) {
      boundaries["WavePort"].push_back(
          {{"Index", number}, {"Attributes", port.faces}, {"Mode", 1}, {"Offset", 0.0}, {"Excitation", excitation}});
      continue;
    }
    Json entry{{"Index", number}};
    if (port.faces.size() == 1) {
      entry["Attributes"] = port.faces;
      entry["Direction"] = direction(port.port);
    } else {
      for (const std::int32_t face : port.faces)
        entry["Elements"].push_back({{"Attributes", {face}}, {"Direction", direction(port.port)}});
    }
    entry["R"] = port.port.impedance_ohm;
    entry["Excitation"] = excitation;
    boundaries["LumpedPort"].push_back(std::move(entry));
  }
}

Json wave_boundaries(const deck::FieldProblem& problem, double unit_m) {
  Json out = Json::object();
  if (const auto pec = problem.faces_with(BoundaryCondition::pec); !pec.empty()) out["PEC"] = {{"Attributes", pec}};
  if (const auto pmc = problem.faces_with(BoundaryCondition::pmc); !pmc.empty()) out["PMC"] = {{"Attributes", pmc}};
  if (const auto absorbing = problem.faces_with(BoundaryCondition::absorbing); !absorbing.empty())
    out["Absorbing"] = {{"Attributes", absorbing}, {"Order", 1}};
  for (const deck::Face& face : problem.faces) {
    if (face.condition == BoundaryCondition::impedance)
      out["Impedance"].push_back({{"Attributes", {face.id}}, {"Rs", face.impedance_ohm}});
    if (face.condition == BoundaryCondition::conductor) {
      Json entry{{"Attributes", {face.id}}, {"Conductivity", face.metal.sigma_s_per_m}, {"Permeability", face.metal.mu_r}};
      if (face.thickness_m > 0) entry["Thickness"] = face.thickness_m / unit_m;
      if (!face.is_inner) entry["External"] = true;
      out["Conductivity"].push_back(std::move(entry));
    }
  }
  add_ports(problem, out);
  // A mode with lossy copper at its rim is not the one that Palace projects on: two ports lost 0.4 % that nothing absorbs.
  if (const auto lossy = problem.faces_with(BoundaryCondition::conductor); out.contains("WavePort") && !lossy.empty())
    out["WavePortPEC"] = {{"Attributes", lossy}};
  return out;
}

Json static_boundaries(const deck::FieldProblem& problem) {
  Json out = Json::object();
  std::vector<std::int32_t> ground, open;
  for (const deck::Face& face : problem.faces) {
    if (face.kind != mesh::FaceTagKind::outer) continue;
    (face.condition == BoundaryCondition::pec ? ground : open).push_back(face.id);
  }
  if (!ground.empty()) out["Ground"] = {{"Attributes", ground}};
  if (!open.empty()) out["ZeroCharge"] = {{"Attributes", open}};
  for (std::size_t c = 0; c < problem.conductors.size(); ++c)
    out["Terminal"].push_back({{"Index", c + 1}, {"Attributes", problem.conductors[c].faces}});
  return out;
}

Json solver(const deck::FieldProblem& problem) {
  const DeckOptions& options = problem.options;
  Json out{{"Order", element_order}, {"Device", "CPU"}};
  switch (options.problem) {
    case Problem::driven: {
      Json frequencies = Json::array();
      for (const double hz : options.frequencies_hz) frequencies.push_back(hz / hz_per_ghz);
      out["Driven"] = {{"Samples", {{{"Type", "Point"}, {"Freq", frequencies}}}}};
      break;
    }
    case Problem::eigenmode:
      out["Eigenmode"] = {
          {"N", options.modes.number}, {"Target", options.modes.above_hz / hz_per_ghz}, {"Save", options.modes.number}};
      // Skins make the eigenvalue problem non-linear, and Palace's own choice of method lost modes of a plain cavity.
      if (!problem.faces_with(BoundaryCondition::conductor).empty()) out["Eigenmode"]["NonlinearType"] = "SLP";
      break;
    case Problem::electrostatic:
      out["Electrostatic"] = {{"Save", 0}};
      break;
  }
  // Residuals of 1e-8 left S12 and S21 1e-6 apart, which reads as a network that is not reciprocal.
  out["Linear"] = {{"Type", "Default"}, {"KSPType", "Default"}, {"Tol", 1e-11}, {"MaxIts", 500}};
  return out;
}

void require(const mesh::PrismMesh& mesh, const DeckOptions& options) {
  Diagnostics ignored;
  (void)state(mesh, options, ignored);
}

Deck write(const mesh::PrismMesh& mesh, const DeckOptions& options, const std::filesystem::path& folder,
           Diagnostics& diagnostics) {
  const deck::FieldProblem problem = state(mesh, options, diagnostics);
  constexpr std::array<const char*, 3> types{"Driven", "Eigenmode", "Electrostatic"};
  const std::string stem = problem.stem();
  const double unit_m = metres_per(options.unit);
  Json out;
  out["Problem"] = {{"Type", types[static_cast<std::size_t>(options.problem)]}, {"Verbose", 2}, {"Output", "postpro/" + stem}};
  // Splitting elements along cracks would turn the whole mesh into tetrahedra as soon as one sheet is one element wide.
  out["Model"] = {{"Mesh", options.mesh}, {"L0", unit_m}, {"RefineCrackElements", false}};
  out["Domains"] = {{"Materials", materials(problem)}};
  out["Boundaries"] = options.problem == Problem::electrostatic ? static_boundaries(problem) : wave_boundaries(problem, unit_m);
  out["Solver"] = solver(problem);
  Deck deck;
  deck::put_file(folder / (stem + ".palace.json"), out.dump(1, ' ', false, Json::error_handler_t::replace) + "\n", deck);
  const deck::ResultFiles results = deck::result_files(problem);
  const std::string config = deck::shell_word(stem + ".palace.json");
  deck::put_run_script(
      folder / (stem + ".run.sh"),
      fmt::format(
          "Solves {} with Palace and ends in {}. PALACE: its launcher; NP: number of processes; ORDER: of the elements, "
          "{} unless said; PCBMESH: where that is.",
          deck::plain(options.mesh), deck::plain(results.final), element_order),
      fmt::format("deck={0}\nif [ -n \"${{ORDER:-}}\" ]; then\n  deck={1}\n  sed \"/\\\"Solver\\\"/,\\$ s/\\\"Order\\\": "
                  "[0-9]*/\\\"Order\\\": $ORDER/\" {0} > \"$deck\"\nfi\n\"${{PALACE:-palace}}\" -np \"${{NP:-2}}\" "
                  "\"$deck\"\n{2}",
                  config, deck::shell_word(stem + ".order.palace.json"), table_script(problem, "postpro/" + stem)),
      deck);
  deck.result = results.final;
  deck.calls_pcbmesh = options.problem == Problem::driven;
  return deck;
}

}  // namespace

constinit const DeckFormat deck_format{
    "palace",
    "Palace: full wave of any order on prisms, resonances, capacitances",
    {.format = "msh", .version = "2.2", .ending = ".msh", .binary = true, .one_number_space = false, .tetrahedra = false},
    &require,
    &write};

}  // namespace pcbmesh::formats::palace
