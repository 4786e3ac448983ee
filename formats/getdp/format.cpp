// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/getdp/format.hpp"

#include <fmt/format.h>

#include <array>

#include "formats/deck/deck_file.hpp"
#include "formats/deck/limits.hpp"
#include "formats/getdp/wave_ports.hpp"
#include "formats/getdp/write_pro.hpp"
#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats::getdp {
namespace {

constexpr deck::Limits limits{.solver = "GetDP", .wave_ports = true, .coaxial_ports = true, .periodic_sides = true};

std::int32_t num_volumes(const mesh::PrismMesh& mesh) {
  return static_cast<std::int32_t>(mesh.volume_tags().size());
}

deck::FieldProblem state(const mesh::PrismMesh& mesh, const DeckOptions& options, Diagnostics& diagnostics) {
  deck::FieldProblem problem = deck::state_within(limits, mesh, options, num_volumes(mesh), diagnostics);
  if (options.problem == Problem::driven) require_tem_ports(problem, diagnostics);
  return problem;
}

void require(const mesh::PrismMesh& mesh, const DeckOptions& options) {
  Diagnostics ignored;
  (void)state(mesh, options, ignored);
}

Deck write(const mesh::PrismMesh& mesh, const DeckOptions& options, const std::filesystem::path& folder,
           Diagnostics& diagnostics) {
  const deck::FieldProblem problem = state(mesh, options, diagnostics);
  const std::string stem = problem.stem();
  std::string text, resolution;
  switch (options.problem) {
    case Problem::driven:
      text = driven_pro(problem);
      resolution = "Driven";
      break;
    case Problem::eigenmode:
      text = eigenmode_pro(problem);
      resolution = "Resonances";
      break;
    case Problem::electrostatic:
      text = electrostatic_pro(problem);
      resolution = "Capacitance";
      break;
  }
  Deck deck;
  deck::put_file(folder / (stem + ".pro"), text, deck);
  deck::put_run_script(folder, problem, "GetDP (Debian: apt-get install getdp)", "GETDP, PCBMESH: where the programs are.",
                       fmt::format("\"${{GETDP:-getdp}}\" {} -msh {} -solve {} -v 3", deck::shell_word(stem + ".pro"),
                                   deck::shell_word(options.mesh), resolution),
                       deck);
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
