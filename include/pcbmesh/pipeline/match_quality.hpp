// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pcbmesh/base/diagnostics.hpp"
#include "pcbmesh/base/progress.hpp"
#include "pcbmesh/layering/match_quality.hpp"
#include "pcbmesh/model/model.hpp"
#include "pcbmesh/overlay/overlay.hpp"
#include "pcbmesh/study/study.hpp"
#include "pcbmesh/triangulate/triangulate.hpp"

namespace pcbmesh::pipeline {

/// One mesh that was made and measured on the way.
struct MatchStep {
  double longest_edge_m = 0;
  std::int64_t triangles = 0, sublayers = 0, prisms = 0, unknowns = 0;  ///< void cells do not count
  double mean_prism = 0, volume_weighted_prism = 0;
  bool meets = false;  ///< the goal
};

struct MatchResult {
  std::vector<MatchStep> steps;             ///< in the order they were tried
  std::size_t chosen = 0;                   ///< index into steps
  std::vector<layering::FrontPoint> front;  ///< predicted from the measured ones; ascending
  std::size_t knee = 0;                     ///< index into front
};

struct MatchedMesh {
  triangulate::TriangulateResult planar;
  std::vector<int> counts;  ///< per slab, before grading
  double longest_edge_m = 0;
  MatchResult result;
};

/// Policy matched: predict the Pareto front, triangulate at the edge it proposes, choose the counts on that mesh, extrude and
/// measure, learn, repeat. Never overlays again. At most 12 triangulations.
/// @param first  triangulation with options.longest_edge_nm, which bounds every other
/// @throws Error target_unreachable (502) if no mesh within budget and study.max_prisms meets the goal.
[[nodiscard]] MatchedMesh match_quality(const overlay::OverlayResult& graph, const model::Model& model,
                                        const study::Study& study, triangulate::TriangulateOptions options,
                                        triangulate::TriangulateResult first, std::span<const layering::SlabLimits> limits,
                                        Diagnostics& diagnostics, const Progress& progress);

}  // namespace pcbmesh::pipeline
