// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/elmer_deck/format.hpp"

#include <fmt/format.h>

#include "formats/deck/deck_file.hpp"
#include "formats/elmer_deck/write_sif.hpp"

namespace pcbmesh::formats::elmer_deck {
namespace {

using mesh::BoundaryCondition;

void require_expressible(const deck::FieldProblem& problem) {
  constexpr const char* me = "Elmer";
  for (const deck::Volume& volume : problem.volumes)
    if (volume.is_conductor)
      deck::refuse(me, fmt::format("solid copper, '{}': it has no boundary of its own", volume.name),
                   "hollow or sheet conductors (--conductors hollow)");
  for (const deck::FieldPort& port : problem.ports)
    if (port.port.kind == mesh::PortKind::coaxial && problem.options.problem == Problem::driven)
      deck::refuse(me, fmt::format("coaxial port '{}' in this deck", port.port.name),
                   "a lumped port on the track beside the via; GetDP and Palace have coaxial ports");
  for (const deck::FieldPort& port : problem.ports)
    if (port.port.kind == mesh::PortKind::wave && problem.options.problem == Problem::driven)
      deck::refuse(me, fmt::format("wave port '{}' in this deck", port.port.name),
                   "a lumped port across the gap between trace and reference; Palace has wave ports");
  for (const deck::Face& face : problem.faces) {
    if (face.condition == BoundaryCondition::periodic)
      deck::refuse(me, fmt::format("the periodic side '{}' in this deck", face.name), "pec, pmc or absorbing there");
    if (problem.options.problem == Problem::eigenmode &&
        (face.condition == BoundaryCondition::absorbing || face.condition == BoundaryCondition::impedance ||
         face.condition == BoundaryCondition::port))
      deck::refuse(me, fmt::format("resonances with the {} boundary '{}'", mesh::name_of(face.condition), face.name),
                   "pec or pmc there, or a driven sweep");
  }
}

void require(const mesh::PrismMesh& mesh, const DeckOptions& options) {
  Diagnostics ignored;
  require_expressible(deck::state(mesh, options, 0, ignored));
}

Deck write(const mesh::PrismMesh& mesh, const DeckOptions& options, const std::filesystem::path& folder,
           Diagnostics& diagnostics) {
  const deck::FieldProblem problem = deck::state(mesh, options, 0, diagnostics);
  require_expressible(problem);
  const std::string stem = problem.stem();
  Deck deck;
  std::string run = fmt::format("ElmerGrid 14 2 {} -out {}\n", deck::shell_word(options.mesh), deck::shell_word(stem));
  const auto add = [&](const std::string& name, std::size_t excited) {
    deck::put_file(folder / name, sif(problem, excited), deck);
    run += fmt::format("ElmerSolver {}\n", deck::shell_word(name));
  };
  if (options.problem == Problem::driven) {
    for (std::size_t p = 0; p < problem.ports.size(); ++p)
      if (problem.ports[p].port.is_excited) add(fmt::format("{}.port{}.sif", stem, p + 1), p);
    deck.result = stem + ".port1.dat";
  } else {
    add(stem + ".sif", 0);
    deck.result = options.problem == Problem::electrostatic ? stem + ".capacitance.dat" : stem;
  }
  deck::put_run_script(folder / (stem + ".run.sh"),
                       "Makes Elmer's mesh folder (-autoclean would renumber boundaries) and solves.", run, deck);
  return deck;
}

}  // namespace

constinit const DeckFormat deck_format{
    "elmer",
    "Elmer: full wave by edge elements on prisms, resonances, capacitances",
    {.format = "msh", .version = "2.2", .ending = ".msh", .binary = false, .one_number_space = false, .tetrahedra = false},
    &require,
    &write};

}  // namespace pcbmesh::formats::elmer_deck
