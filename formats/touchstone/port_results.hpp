// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <complex>
#include <filesystem>
#include <string>
#include <vector>

namespace pcbmesh::formats::touchstone {

using Complex = std::complex<double>;

/// S-parameters over a sweep.
struct ScatteringSweep {
  struct Port {
    std::string name;
    double impedance_ohm = 50;
  };
  std::vector<Port> ports;
  std::vector<double> frequencies_hz;         ///< ascending
  std::vector<std::vector<Complex>> scatter;  ///< per frequency: S, row by row (observed x excited)
};

/// Reads what a driven GetDP deck wrote: one row per frequency, excited and observed port, waves of the port's own impedance.
/// @throws Error file_unreadable (201), file_syntax (202) with the line, input_number (203); file_truncated (205) naming what
/// is missing when a run was stopped or a port not excited.
[[nodiscard]] ScatteringSweep read_port_results(const std::filesystem::path& file);

/// The same network seen from other port impedances (one for all).
[[nodiscard]] ScatteringSweep renormalised(const ScatteringSweep& sweep, double impedance_ohm);

/// Largest singular value of S over the sweep (passive: at most 1) and largest |S_ij - S_ji| (reciprocal: 0).
struct NetworkCheck {
  double largest_gain = 0;
  double largest_gain_hz = 0;
  double asymmetry = 0;
  double asymmetry_hz = 0;
};
[[nodiscard]] NetworkCheck check_network(const ScatteringSweep& sweep);

/// Touchstone 1.1 text: Hz, S, RI. REQUIRES all ports to have one impedance.
[[nodiscard]] std::string to_touchstone(const ScatteringSweep& sweep);

/// Writes it; the file appears whole or not at all. @throws Error usage (101) when the name does not end in .sNp with the
/// right N, write_failed (701).
void write_touchstone(const ScatteringSweep& sweep, const std::filesystem::path& file);

}  // namespace pcbmesh::formats::touchstone
