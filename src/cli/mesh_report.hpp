// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pcbmesh/board/board.hpp"
#include "pcbmesh/extrude/second_order_source.hpp"
#include "pcbmesh/layering/divide_layers.hpp"
#include "pcbmesh/layering/quality_report.hpp"
#include "pcbmesh/pipeline/mesh_board.hpp"
#include "pcbmesh/validation/report.hpp"

namespace pcbmesh::cli {

/// What one mesh run found out: counts, qualities, times, snap ledger, diagnostics, verdict.
struct MeshRun {
  const board::Board& board;
  const pipeline::MeshBoardResult& result;
  layering::QualityReport quality;
  std::vector<layering::LayerExplanation> layers;  ///< one per slab
  const validation::Report* check = nullptr;       ///< null: not checked
  std::vector<std::string> files;                  ///< written, in order
  std::optional<pipeline::Forecast> measured{};    ///< exact sizes
  std::optional<extrude::SecondOrderStatistics> second_order{};
};

/// JSON for machines: x.report.json and --json. @unit as the keys say.
[[nodiscard]] std::string report_json(const MeshRun& run);
/// The same for people, a dozen lines.
[[nodiscard]] std::string report_text(const MeshRun& run);

/// What was forecast beside what came, unknowns and solver memory.
[[nodiscard]] std::string forecast_text(const MeshRun& run);

}  // namespace pcbmesh::cli
