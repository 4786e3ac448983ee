// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "pcbmesh/layering/divide_layers.hpp"
#include "pcbmesh/pipeline/mesh_board.hpp"

namespace pcbmesh::cli {

/// One layer after the other, bottom to top: heights, who forced them, prisms and quality before and after the bounds, and what
/// one sub-layer fewer or more would do. As report.json has them.
[[nodiscard]] nlohmann::ordered_json layers_json(const pipeline::MeshBoardResult& result,
                                                 std::span<const layering::LayerExplanation> explained);
/// Meshes made by policy matched, its Pareto front and knee; null for other policies.
[[nodiscard]] nlohmann::ordered_json match_json(const pipeline::MeshBoardResult& result);
/// Both as tables for a terminal, with the common heights of all policies beside the one taken.
[[nodiscard]] std::string explain_text(const pipeline::MeshBoardResult& result,
                                       std::span<const layering::LayerExplanation> explained);

}  // namespace pcbmesh::cli
