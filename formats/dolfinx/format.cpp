// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/dolfinx/format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "formats/deck/deck_file.hpp"
#include "formats/deck/limits.hpp"
#include "formats/dolfinx/solve_text.hpp"

namespace pcbmesh::formats::dolfinx {
namespace {

using Json = nlohmann::ordered_json;

constexpr deck::Limits limits{.solver = "dolfinx"};

Json material(const board::Material& m) {
  return {{"eps_r", m.eps_r}, {"tan_delta", m.tan_delta}, {"mu_r", m.mu_r}, {"sigma_s_per_m", m.sigma_s_per_m}};
}

Json volumes(const deck::FieldProblem& problem) {
  Json out = Json::array();
  for (const deck::Volume& volume : problem.volumes) {
    Json entry{{"id", volume.id}, {"name", volume.name}, {"is_conductor", volume.is_conductor}};
    entry.update(material(volume.material));
    out.push_back(std::move(entry));
  }
  return out;
}

Json faces(const deck::FieldProblem& problem) {
  Json out = Json::array();
  for (const deck::Face& face : problem.faces) {
    Json entry{{"id", face.id},
               {"name", face.name},
               {"kind", face.kind == mesh::FaceTagKind::outer ? "outer" : "inner"},
               {"condition", mesh::name_of(face.condition)},
               {"is_inner", face.is_inner}};
    switch (face.condition) {
      case mesh::BoundaryCondition::impedance:
        entry["impedance_ohm"] = face.impedance_ohm;
        break;
      case mesh::BoundaryCondition::conductor:
        entry["metal"] = material(face.metal);
        entry["metal"]["thickness_m"] = face.thickness_m;
        break;
      case mesh::BoundaryCondition::port:
        entry["port"] = face.port;
        break;
      case mesh::BoundaryCondition::absorbing:
        entry["media"] = Json::array();
        for (const deck::Medium& medium : face.media) {
          Json layer{{"z_high_m", medium.z_high_m}};
          layer.update(material(medium.material));
          entry["media"].push_back(std::move(layer));
        }
        break;
      default:
        break;
    }
    out.push_back(std::move(entry));
  }
  return out;
}

Json ports(const deck::FieldProblem& problem) {
  Json out = Json::array();
  for (const deck::FieldPort& port : problem.ports)
    out.push_back({{"name", deck::plain(port.port.name)},
                   {"impedance_ohm", port.port.impedance_ohm},
                   {"length_m", port.port.length_m},
                   {"width_m", port.port.width_m},
                   {"direction", port.port.direction},
                   {"is_excited", port.port.is_excited},
                   {"faces", port.faces}});
  return out;
}

Json conductors(const deck::FieldProblem& problem) {
  Json out = Json::array();
  for (const deck::Conductor& conductor : problem.conductors)
    out.push_back({{"name", deck::plain(conductor.name)}, {"volumes", conductor.volumes}, {"faces", conductor.faces}});
  return out;
}

/// One line per entry of a list, for people who read decks.
std::string listed(const Json& list) {
  std::string out = "[";
  for (const Json& entry : list)
    out += fmt::format("{}\n    {}", out.size() > 1 ? "," : "", entry.dump(-1, ' ', true, Json::error_handler_t::replace));
  return out + "]";
}

std::string study_text(const deck::FieldProblem& problem, const std::string& results) {
  const DeckOptions& options = problem.options;
  Json head{{"mesh", options.mesh},
            {"unit_m", metres_per(options.unit)},
            {"problem", study::name_of(options.problem)},
            {"result", results}};
  if (options.problem == Problem::driven) head["frequencies_hz"] = options.frequencies_hz;
  if (options.problem == Problem::eigenmode)
    head["modes"] = {{"number", options.modes.number}, {"above_hz", options.modes.above_hz}};
  head["floating"] = problem.floating;
  std::string text = head.dump(-1, ' ', true, Json::error_handler_t::replace);
  text.pop_back();
  return fmt::format("{},\n  \"volumes\": {},\n  \"faces\": {},\n  \"ports\": {},\n  \"conductors\": {}}}", text,
                     listed(volumes(problem)), listed(faces(problem)), listed(ports(problem)), listed(conductors(problem)));
}

void require(const mesh::PrismMesh& mesh, const DeckOptions& options) {
  Diagnostics ignored;
  (void)deck::state_within(limits, mesh, options, 0, ignored);
}

Deck write(const mesh::PrismMesh& mesh, const DeckOptions& options, const std::filesystem::path& folder,
           Diagnostics& diagnostics) {
  const deck::FieldProblem problem = deck::state_within(limits, mesh, options, 0, diagnostics);
  const std::string stem = problem.stem();
  Deck deck;
  deck::put_file(folder / (stem + ".py"),
                 fmt::format("#!/usr/bin/python3\n# {}, written by pcbmesh. Run it: sh {}\nimport json\n\nPROBLEM = "
                             "json.loads(r\"\"\"{}\"\"\")\n\n{}",
                             deck::plain(options.mesh), deck::plain(stem + ".run.sh"),
                             study_text(problem, deck::result_files(problem).written), solve_text),
                 deck);
  deck::put_run_script(folder, problem, "dolfinx (Debian: apt-get install python3-dolfinx-complex python3-h5py)",
                       "PYTHON, PCBMESH: where the programs are.",
                       fmt::format("# Debian keeps dolfinx for real and for complex numbers apart.\n"
                                   "[ -n \"${{PETSC_DIR:-}}\" ] || [ ! -d /usr/lib/petscdir/petsc-complex ] || export "
                                   "PETSC_DIR=/usr/lib/petscdir/petsc-complex SLEPC_DIR=/usr/lib/slepcdir/slepc-complex\n"
                                   "export OMP_NUM_THREADS=\"${{OMP_NUM_THREADS:-1}}\"\n\"${{PYTHON:-/usr/bin/python3}}\" {}",
                                   deck::shell_word(stem + ".py")),
                       deck);
  return deck;
}

}  // namespace

constinit const DeckFormat deck_format{
    "dolfinx",
    "dolfinx: full wave and resonances by edge elements on tetrahedra, capacitances on prisms; ends in Touchstone",
    {.format = "vtkhdf", .version = "", .ending = ".vtkhdf", .binary = true, .one_number_space = false, .tetrahedra = true},
    &require,
    &write};

}  // namespace pcbmesh::formats::dolfinx
