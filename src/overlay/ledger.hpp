// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "pcbmesh/overlay/overlay.hpp"
#include "src/overlay/sheets.hpp"

namespace pcbmesh::overlay {

/// How far the final outlines of copper, barrels and holes lie from the exact ones, measured at the final vertices.
/// @cost O(n) with a grid per sheet.
[[nodiscard]] std::vector<SnapRecord> make_ledger(const model::Model& model, const Sheets& sheets, const EdgeGraph& graph,
                                                  const std::vector<double>& area_mm2, const LabelPool& labels, Nm tolerance,
                                                  const Progress& progress);

}  // namespace pcbmesh::overlay
