// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pcbmesh/base/diagnostics.hpp"
#include "pcbmesh/base/progress.hpp"
#include "pcbmesh/board/board.hpp"
#include "pcbmesh/geometry/path.hpp"
#include "pcbmesh/layering/divide_layers.hpp"
#include "pcbmesh/layering/prism_quality.hpp"
#include "pcbmesh/mesh/prism_mesh.hpp"
#include "pcbmesh/overlay/overlay.hpp"
#include "pcbmesh/pipeline/forecast.hpp"
#include "pcbmesh/pipeline/match_quality.hpp"
#include "pcbmesh/study/study.hpp"
#include "pcbmesh/triangulate/triangulate.hpp"

namespace pcbmesh::pipeline {

/// Process CPU seconds of one step.
struct StepTime {
  std::string step;
  double cpu_s = 0;
};

struct MeshBoardResult {
  mesh::PrismMesh mesh;
  study::Study resolved;  ///< every choice the study left open, filled in
  overlay::OverlayStatistics overlay;
  std::vector<overlay::SnapRecord> ledger;
  triangulate::TriangulateStatistics triangulate;
  layering::HeightStatistics heights;         ///< of the final planar mesh
  double common_height_m = 0;                 ///< 0 = none
  bool fed_back = false;                      ///< the common height became the longest edge
  double longest_edge_m = 0;                  ///< bound of the final triangulation
  std::vector<layering::LayerChoice> layers;  ///< per slab: how it is cut, and why
  std::optional<MatchResult> match;           ///< policy matched
  layering::QualityStatistics quality;
  Forecast forecast;  ///< made before the last triangulation
  Diagnostics diagnostics;
  std::vector<StepTime> times;
  std::vector<geometry::OutlineCircle> circles{};  ///< that outlines may follow; only for elements of second order
};

/// The whole way from board to mesh: compose, overlay, triangulate, choose layers (with the paper's feedback), extrude.
/// @throws Error from any step; prism_limit (601) when a forecast exceeds a limit of the study, before anything large is built.
[[nodiscard]] MeshBoardResult mesh_board(const board::Board& board, const study::Study& study,
                                         const Progress& progress = Progress{});

}  // namespace pcbmesh::pipeline
