// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/mfem_deck/format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "formats/deck/deck_file.hpp"
#include "formats/deck/limits.hpp"
#include "formats/mfem_deck/solve_text.hpp"

namespace pcbmesh::formats::mfem_deck {
namespace {

constexpr deck::Limits limits{.solver = "MFEM"};

/// As std::quoted reads it.
std::string in_quotes(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' || c == '\\' ? std::string{'\\', c} : std::string(1, c);
  return out + "\"";
}

std::string material(const board::Material& m) {
  return fmt::format("{} {} {} {}", m.eps_r, m.tan_delta, m.mu_r, m.sigma_s_per_m);
}

std::string face_line(const deck::Face& face) {
  std::string out = fmt::format("face {} {}", in_quotes(face.name), mesh::name_of(face.condition));
  switch (face.condition) {
    case mesh::BoundaryCondition::impedance:
      return out + fmt::format(" {}", face.impedance_ohm);
    case mesh::BoundaryCondition::conductor:
      return out + fmt::format(" {} {} {}", face.thickness_m, face.is_inner ? 2 : 1, material(face.metal));
    case mesh::BoundaryCondition::port:
      return out + fmt::format(" {}", face.port);
    case mesh::BoundaryCondition::absorbing:
      out += fmt::format(" {}", face.media.size());
      for (const deck::Medium& medium : face.media) out += fmt::format("  {} {}", medium.z_high_m, material(medium.material));
      return out;
    default:
      return out;
  }
}

/// Count and names of the groups with these ids.
template <class Groups>
std::string named(const Groups& groups, const std::vector<std::int32_t>& ids) {
  std::string out = fmt::format(" {}", ids.size());
  for (const std::int32_t id : ids)
    for (const auto& group : groups)
      if (group.id == id) out += " " + in_quotes(group.name);
  return out;
}

std::string problem_text(const deck::FieldProblem& problem, const std::string& results) {
  const DeckOptions& options = problem.options;
  std::string out = fmt::format(
      "# A field problem for MFEM, written by pcbmesh. Materials: eps_r, tan delta, mu_r, S/m.\nproblem {}\nmesh {}\nunit_m "
      "{}\n"
      "result {}\n",
      study::name_of(options.problem), in_quotes(options.mesh), metres_per(options.unit), in_quotes(results));
  if (options.problem == Problem::driven)
    for (const double hz : options.frequencies_hz) out += fmt::format("frequency_hz {}\n", hz);
  if (options.problem == Problem::eigenmode) out += fmt::format("modes {} {}\n", options.modes.number, options.modes.above_hz);
  for (const deck::Volume& volume : problem.volumes) {
    const bool floats = std::ranges::find(problem.floating, volume.id) != problem.floating.end();
    const char* kind = floats ? "floating" : volume.is_conductor ? "conductor" : "dielectric";
    out += fmt::format("volume {} {} {}\n", in_quotes(volume.name), kind, material(volume.material));
  }
  for (const deck::Face& face : problem.faces) out += face_line(face) + "\n";
  for (const deck::FieldPort& port : problem.ports) {
    const mesh::Port& p = port.port;
    out += fmt::format("port {} {} {} {}  {} {} {}  {}\n", in_quotes(deck::plain(p.name)), p.impedance_ohm, p.length_m,
                       p.width_m, p.direction[0], p.direction[1], p.direction[2], p.is_excited ? 1 : 0);
  }
  for (const deck::Conductor& conductor : problem.conductors)
    out += fmt::format("net {}{}{}\n", in_quotes(deck::plain(conductor.name)), named(problem.volumes, conductor.volumes),
                       named(problem.faces, conductor.faces));
  std::vector<std::int32_t> ground;
  for (const deck::Face& face : problem.faces)
    if (face.condition == mesh::BoundaryCondition::pec && face.kind == mesh::FaceTagKind::outer) ground.push_back(face.id);
  return out + fmt::format("ground{}\n", named(problem.faces, ground));
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
  deck::put_file(folder / (stem + ".problem.txt"), problem_text(problem, deck::result_files(problem).written), deck);
  deck::put_file(folder / (stem + ".solve.cpp"), solve_text, deck);
  const std::string source = deck::shell_word(stem + ".solve.cpp"), program = deck::shell_word("./" + stem + ".solve");
  const std::string_view arpack = options.problem == Problem::eigenmode ? " -DPCBMESH_ARPACK" : "",
                         library = options.problem == Problem::eigenmode ? " -larpack" : "";
  deck::put_run_script(
      folder, problem, "MFEM, by the driver that it compiles first,",
      fmt::format("MFEM_DIR: where MFEM was built or installed; ORDER: of the elements; PCBMESH: where that is.{}",
                  library.empty() ? "" : " ARPACK finds the eigenvalues (Debian: apt-get install libarpack2-dev)."),
      fmt::format("config=\"${{MFEM_DIR:-/usr}}/config/config.mk\"\n[ -f \"$config\" ] || "
                  "config=\"${{MFEM_DIR:-/usr}}/share/mfem/config.mk\"\n"
                  "if [ ! -f \"$config\" ]; then\n  echo \"MFEM is not found: set MFEM_DIR to the folder where it was built or "
                  "installed\" >&2\n  exit 1\nfi\n"
                  "printf 'include %s\nall:\n\t$(MFEM_CXX) $(MFEM_FLAGS){3} %s -o %s $(MFEM_LIBS){4}\n' \"$config\" {0} {1} | "
                  "make -s -f - all\n{1} {2} \"${{ORDER:-1}}\"",
                  source, program, deck::shell_word(stem + ".problem.txt"), arpack, library),
      deck);
  return deck;
}

}  // namespace

constinit const DeckFormat deck_format{
    "mfem",
    "MFEM: named attribute sets and a driver in C++: full wave and resonances by edge elements on prisms, capacitances; ends "
    "in Touchstone",
    {.format = "mfem", .version = "1.3", .ending = ".mesh", .binary = true, .one_number_space = false, .tetrahedra = false},
    &require,
    &write};

}  // namespace pcbmesh::formats::mfem_deck
