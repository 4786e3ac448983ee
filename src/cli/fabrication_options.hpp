// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "pcbmesh/study/study.hpp"

namespace pcbmesh::cli {

/// Flags of how the board is made.
struct FabricationOptions {
  std::string vias, plating, merge_vias, materials;
  double etch = 0, max_unknowns = 0;
  bool solder_mask = false;
};

[[nodiscard]] std::shared_ptr<FabricationOptions> add_fabrication_options(CLI::App& command);
/// @throws Error usage (101) naming the flag.
void take_fabrication_options(const FabricationOptions& options, study::Fabrication& into);

}  // namespace pcbmesh::cli
