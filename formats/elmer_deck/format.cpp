// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/elmer_deck/format.hpp"

#include <fmt/format.h>

#include "formats/deck/deck_file.hpp"
#include "formats/deck/limits.hpp"
#include "formats/elmer_deck/write_sif.hpp"

namespace pcbmesh::formats::elmer_deck {
namespace {

constexpr deck::Limits limits{.solver = "Elmer", .solid_copper = false};

void require(const mesh::PrismMesh& mesh, const DeckOptions& options) {
  Diagnostics ignored;
  (void)deck::state_within(limits, mesh, options, 0, ignored);
}

Deck write(const mesh::PrismMesh& mesh, const DeckOptions& options, const std::filesystem::path& folder,
           Diagnostics& diagnostics) {
  const deck::FieldProblem problem = deck::state_within(limits, mesh, options, 0, diagnostics);
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
    deck.result = options.problem == Problem::electrostatic ? stem + ".capacitance.dat" : stem + ".modes.dat";
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
