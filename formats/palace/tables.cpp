// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/palace/tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "formats/deck/deck_file.hpp"

namespace pcbmesh::formats::palace {
namespace {

/// Names come as a document of the shell, which takes every character for itself.
std::string table(const std::string& opening, std::string_view variables, std::string_view program, const std::string& from,
                  const std::string& to) {
  return fmt::format("cat > {0} <<'END_OF_OPENING'\n{1}END_OF_OPENING\nawk -F, {2}'{3}' {4} >> {0}\n", deck::shell_word(to),
                     opening, variables, program, deck::shell_word(from));
}

// A wave of 1 V enters a port of its own impedance: Palace's waves are those of power.
constexpr std::string_view rows_of_ports = R"(
NR == 1 { count = split(ohms, ohm, " "); for (i = 2; i < NF; i += 2) { split($i, part, /[][]+/); observed[i] = part[2]; excited[i] = part[3] } next }
{ for (i = 2; i < NF; i += 2) {
    size = exp($i * log(10) / 20) * sqrt(ohm[observed[i]] / ohm[excited[i]]); angle = $(i + 1) * atan2(0, -1) / 180
    printf "%.15g %d %d %.15g %.15g\n", $1 * 1e9, excited[i], observed[i], size * cos(angle), size * sin(angle) } }
)";

constexpr std::string_view rows_of_terminals = R"(
NR > 1 { for (i = $1 + 1; i <= NF; ++i) printf "%d %d %.15g\n", $1, i - 1, $i }
)";

constexpr std::string_view rows_of_modes = R"(
NR > 1 { hz[n] = $2 * 1e9; q[n] = $4; ++n }
END {
  print "# frequency_hz"; for (i = 0; i < n; ++i) printf "%d %.15g\n", i, hz[i]
  print "# quality factor"; for (i = 0; i < n; ++i) printf "%d %.15g\n", i, q[i] }
)";

}  // namespace

std::string table_script(const deck::FieldProblem& problem, const std::string& folder) {
  // Modes of wave ports are normalised to the power they carry: where there is loss, S12 and S21 differ a little.
  const bool has_waves =
      std::ranges::any_of(problem.ports, [](const deck::FieldPort& port) { return port.port.kind == mesh::PortKind::wave; });
  const deck::ResultFiles results = deck::result_files(problem, has_waves ? " --tolerance 1e-3" : "");
  std::string opening;
  switch (problem.options.problem) {
    case Problem::eigenmode:
      return table("", "-v n=0 ", rows_of_modes, folder + "/eig.csv", results.written) + results.after;
    case Problem::electrostatic:
      opening = "# pcbmesh capacitance results 1\n";
      for (std::size_t c = 0; c < problem.conductors.size(); ++c)
        opening += fmt::format("# net {} {}\n", c + 1, deck::plain(problem.conductors[c].name));
      opening += "# net net farad\n";
      return table(opening, "", rows_of_terminals, folder + "/terminal-C.csv", results.written) + results.after;
    case Problem::driven:
      break;
  }
  opening = "# pcbmesh port results 1\n";
  std::string ohms;
  for (std::size_t p = 0; p < problem.ports.size(); ++p) {
    const mesh::Port& port = problem.ports[p].port;
    opening += fmt::format("# port {} {} {}\n", p + 1, port.impedance_ohm, deck::plain(port.name));
    ohms += fmt::format("{}{}", p == 0 ? "" : " ", port.impedance_ohm);
  }
  opening += "# frequency_hz excited observed re im\n";
  return table(opening, fmt::format("-v ohms=\"{}\" ", ohms), rows_of_ports, folder + "/port-S.csv", results.written) +
         results.after;
}

}  // namespace pcbmesh::formats::palace
