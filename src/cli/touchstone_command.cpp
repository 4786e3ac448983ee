// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>

#include "formats/touchstone/port_results.hpp"
#include "pcbmesh/base/error.hpp"
#include "src/cli/commands.hpp"

namespace pcbmesh::cli {
namespace {

struct Options {
  std::string results, output;
  double impedance = 0;
  double tolerance = 1e-6;  // of a direct solution; what is above has another cause than rounding
  bool quiet = false;
};

std::string verdict(bool holds, const char* name) {
  return fmt::format("{}{}", holds ? "" : "NOT ", name);
}

int run(const Options& options) {
  using namespace formats::touchstone;
  ScatteringSweep sweep = read_port_results(options.results);
  const bool equal = std::ranges::all_of(
      sweep.ports, [&](const ScatteringSweep::Port& port) { return port.impedance_ohm == sweep.ports.front().impedance_ohm; });
  const double wanted = options.impedance > 0 ? options.impedance : sweep.ports.front().impedance_ohm;
  const bool changed = !equal || wanted != sweep.ports.front().impedance_ohm;
  if (changed) sweep = renormalised(sweep, wanted);
  const NetworkCheck check = check_network(sweep);
  write_touchstone(sweep, options.output);
  const bool passive = check.largest_gain <= 1 + options.tolerance, reciprocal = check.asymmetry <= options.tolerance;
  if (!options.quiet) {
    fmt::print("{}: {} ports, {} frequencies from {:.6g} to {:.6g} Hz, {} ohm{}\n", options.output, sweep.ports.size(),
               sweep.frequencies_hz.size(), sweep.frequencies_hz.front(), sweep.frequencies_hz.back(), wanted,
               changed ? " (Touchstone 1 knows one impedance: renormalised)" : "");
    fmt::print("  {}: largest singular value {:.9f} at {:.6g} Hz\n", verdict(passive, "passive"), check.largest_gain,
               check.largest_gain_hz);
    if (sweep.ports.size() > 1)
      fmt::print("  {}: largest |S_ij - S_ji| {:.3g} at {:.6g} Hz\n", verdict(reciprocal, "reciprocal"), check.asymmetry,
                 check.asymmetry_hz);
  }
  return passive && reciprocal ? 0 : 1;
}

}  // namespace

Command add_touchstone_command(CLI::App& program) {
  CLI::App* command =
      program.add_subcommand("touchstone", "Turn a solver's port results into a Touchstone file, and judge them");
  auto options = std::make_shared<Options>();
  command->add_option("results", options->results, "Port results of a deck (x.ports.txt)")->required();
  command->add_option("-o,--output", options->output, "Touchstone file, .s1p, .s2p ...")->required();
  command->add_option("--impedance", options->impedance, "Reference impedance in ohm (default: of the first port)")
      ->check(CLI::PositiveNumber);
  command->add_option("--tolerance", options->tolerance, "How far a network may be from passive and reciprocal")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_flag("--quiet", options->quiet, "Print errors alone");
  command->footer(
      "Exit code 1 if the network is not passive or not reciprocal within the tolerance; the file is written all the same.\n\n"
      "Example:\n"
      "  pcbmesh touchstone out/board.ports.txt -o out/board.s2p");
  return {command, [options] { return run(*options); }};
}

}  // namespace pcbmesh::cli
