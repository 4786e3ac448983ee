// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/getdp/format.hpp"

#include <fmt/format.h>

#include <array>

#include "formats/deck/deck_file.hpp"
#include "formats/getdp/write_pro.hpp"
#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats::getdp {
namespace {

using mesh::BoundaryCondition;

void require_expressible(const deck::FieldProblem& problem) {
  constexpr const char* me = "GetDP";
  for (const deck::FieldPort& port : problem.ports)
    if (port.port.kind == mesh::PortKind::wave && problem.options.problem == Problem::driven)
      deck::refuse(me, fmt::format("wave port '{}'", port.port.name),
                   "a lumped port across the gap between trace and reference; Palace and Elmer have wave ports");
  for (const deck::Face& face : problem.faces) {
    if (face.condition == BoundaryCondition::periodic && problem.options.problem == Problem::electrostatic)
      deck::refuse(me, fmt::format("the periodic side '{}' in electrostatics", face.name), "pmc there, a plane of symmetry");
    if (problem.options.problem == Problem::eigenmode &&
        (face.condition == BoundaryCondition::absorbing || face.condition == BoundaryCondition::impedance ||
         face.condition == BoundaryCondition::port))
      deck::refuse(me,
                   fmt::format("resonances with the {} boundary '{}', which makes the eigenvalue problem non-linear",
                               mesh::name_of(face.condition), face.name),
                   "pec or pmc there, or a driven sweep");
  }
  for (const deck::Face& face : problem.faces)
    if (problem.options.problem == Problem::electrostatic && face.kind == mesh::FaceTagKind::conductor && face.net < 0)
      deck::refuse(me, fmt::format("hollow copper without a net, '{}', which floats", face.name),
                   "solid copper there, which floats as a body of very high permittivity");
}

void require(const mesh::PrismMesh& mesh, const DeckOptions& options) {
  Diagnostics ignored;
  require_expressible(deck::state(mesh, options, static_cast<std::int32_t>(mesh.volume_tags().size()), ignored));
}

Deck write(const mesh::PrismMesh& mesh, const DeckOptions& options, const std::filesystem::path& folder,
           Diagnostics& diagnostics) {
  const auto num_volumes = static_cast<std::int32_t>(mesh.volume_tags().size());
  const deck::FieldProblem problem = deck::state(mesh, options, num_volumes, diagnostics);
  require_expressible(problem);
  const std::string stem = problem.stem();
  std::string text;
  std::string resolution, results, after;
  switch (options.problem) {
    case Problem::driven:
      text = driven_pro(problem);
      resolution = "Driven";
      results = fmt::format("{}.s{}p", stem, problem.ports.size());
      after = fmt::format(
          "if command -v \"${{PCBMESH:=pcbmesh}}\" > /dev/null; then\n  \"$PCBMESH\" touchstone {} -o {}\nelse\n  echo "
          "\"pcbmesh is "
          "not on the path; run: pcbmesh touchstone {} -o {}\" >&2\n  exit 1\nfi\n",
          deck::shell_word(deck::plain(stem) + ".ports.txt"), deck::shell_word(results), deck::plain(stem) + ".ports.txt",
          deck::plain(results));
      break;
    case Problem::eigenmode:
      text = eigenmode_pro(problem);
      resolution = "Resonances";
      results = deck::plain(stem) + ".modes.txt";
      after = "cat " + deck::shell_word(results) + "\n";
      break;
    case Problem::electrostatic:
      text = electrostatic_pro(problem);
      resolution = "Capacitance";
      results = deck::plain(stem) + ".capacitance.txt";
      after = "cat " + deck::shell_word(results) + "\n";
      break;
  }
  Deck deck;
  deck::put_file(folder / (stem + ".pro"), text, deck);
  deck::put_run_script(
      folder / (stem + ".run.sh"),
      fmt::format(
          "Solves {} with GetDP (Debian: apt-get install getdp) and ends in {}. GETDP, PCBMESH: where the programs are.",
          deck::plain(options.mesh), deck::plain(results)),
      fmt::format("\"${{GETDP:-getdp}}\" {} -msh {} -solve {} -v 3\n{}", deck::shell_word(stem + ".pro"),
                  deck::shell_word(options.mesh), resolution, after),
      deck);
  deck.result = results;
  deck.calls_pcbmesh = options.problem == Problem::driven;
  return deck;
}

}  // namespace

constinit const DeckFormat deck_format{
    "getdp",
    "GetDP 3: full wave by edge elements on prisms, resonances, capacitances; ends in Touchstone",
    {.format = "msh", .version = "2.2", .ending = ".msh", .binary = true, .one_number_space = true, .tetrahedra = false},
    &require,
    &write};

}  // namespace pcbmesh::formats::getdp
