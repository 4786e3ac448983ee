// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pcbmesh/study/study.hpp"

namespace pcbmesh::study {

/// Gathers faults, so that one run tells them all.
class FaultList {
 public:
  void add(std::string_view field, std::string text) { faults_.push_back({std::string(field), std::move(text)}); }
  void require_length(std::string_view field, Nm value, Nm least, Nm most) {
    if (value < least || value > most)
      add(field, fmt::format("{} is out of range; expected {} to {}", format_length(value), format_length(least),
                             format_length(most)));
  }
  [[nodiscard]] std::vector<Fault> take() { return std::move(faults_); }

 private:
  std::vector<Fault> faults_;
};

[[nodiscard]] inline bool is_frequency(double hz) {
  constexpr double highest_hz = 1e13;
  return hz > 0 && hz <= highest_hz;
}

/// Holes, etching, fills, materials, unknowns.
void check_fabrication(const Fabrication& fabrication, FaultList& faults);
/// Ports, boundaries, sweep, solver.
void check_physics(const Study& study, FaultList& faults);

}  // namespace pcbmesh::study
