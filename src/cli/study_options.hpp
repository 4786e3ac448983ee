// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pcbmesh/study/study.hpp"
#include "src/cli/fabrication_options.hpp"

namespace pcbmesh::cli {

/// The flags of a study, as typed. A study file comes first; flags override its fields.
struct StudyOptions {
  std::string file, nets, margin, region, polygon, conductors, air, air_above, air_below, air_around, frequency, longest_edge,
      edge_at_copper, seed, policy, sublayers, tolerance, arc_sagitta, unit, split, problem, solver, sweep;
  std::vector<std::string> hollow, solid, sheet, ports, boundaries;
  bool smooth = false, paper_compat = false;
  bool wedge15 = false, wedge18 = false;
  int order = 0;
  double min_angle = 0, growth = 0, max_prisms = 0;
  std::optional<double> elements_per_wavelength, height_growth, target_quality, budget_prisms, budget_unknowns;
  std::optional<int> elements_per_dielectric, skin_depth_layers;
  std::shared_ptr<FabricationOptions> fabrication;
};

/// Adds the flags to a command.
[[nodiscard]] std::shared_ptr<StudyOptions> add_study_options(CLI::App& command);

/// Study file, then flags. @throws Error usage (101), study_invalid (102).
[[nodiscard]] study::Study study_from(const StudyOptions& options);
/// The same without a look at ranges and combinations, which meshing looks at together with the board.
[[nodiscard]] study::Study unchecked_study_from(const StudyOptions& options);

}  // namespace pcbmesh::cli
