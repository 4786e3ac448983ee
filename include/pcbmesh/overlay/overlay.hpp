// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "pcbmesh/base/diagnostics.hpp"
#include "pcbmesh/base/progress.hpp"
#include "pcbmesh/mesh/planar_graph.hpp"
#include "pcbmesh/model/model.hpp"

namespace pcbmesh::overlay {

struct OverlayOptions {
  std::optional<Nm> tolerance_nm;         ///< empty = auto: min(20 um, narrowest/8) for a whole board,
                                          ///< min(5 um, narrowest/20) when nets of interest are named
  std::optional<Nm> coarsest_auto_nm{};   ///< auto is at most this: up to the sagitta of arcs their corners stay on them
  double simplify_over_tolerance = 0.75;  ///< per-layer collapse distance over tolerance (15 um at 20 um)
  double blunt_angle_deg = 30.0;          ///< needle tips sharper than this are blunted; 0 = off
  double blunt_width_over_tolerance = 1.35;
};

/// One entry of the snap ledger: how far the copper of one body was moved.
struct SnapRecord {
  std::int32_t body = 0;
  std::int64_t num_moved = 0;
  Nm max_move_nm = 0;
  geometry::Point at;          ///< place of the largest move
  double area_before_mm2 = 0;  ///< exact union
  double area_after_mm2 = 0;
};

struct OverlayStatistics {
  Nm first_tolerance_nm = 0;  ///< the first one tried; given as an option, it repeats the result
  Nm tolerance_nm = 0;        ///< tolerance that was used in the end
  int attempts = 1;           ///< 1 = the first tolerance held
  std::int64_t num_input_vertices = 0;
  std::int64_t num_snapped = 0;    ///< vertices moved or merged
  std::int64_t num_crossings = 0;  ///< crossings made vertices
  int num_passes = 0;
  double worst_body_area_error = 0;  ///< relative, copper bodies
  double total_area_error = 0;       ///< relative, all copper
};

struct OverlayResult {
  mesh::PlanarGraph graph;
  std::vector<SnapRecord> ledger;  ///< copper and hole bodies, ascending
  OverlayStatistics statistics;
  /// Per net: connected pieces of copper (layers joined by barrels) in the layout within the domain; 0 = none there. Pieces of
  /// one net less than a micrometre apart, or joined by less, count as snapped (warning overlay.parts_joined).
  std::vector<std::int32_t> net_pieces;
  /// Pairs of nets (a < b) whose copper touches or overlaps in the exact layout itself.
  std::vector<std::array<std::int32_t, 2>> touching_nets;
};

/// All outlines of all slabs -> one clean planar graph.
///
/// 1. Per slab range: arrangement at 1 nm by winding numbers; keep edges where a body's membership changes.
/// 2. Reference: area and components per body, pieces per net.
/// 3. Per slab range: area-preserving simplification; 4. all together: noding with tolerance, blunting, to a fixed point.
/// 5. Verify components, touching nets and areas against 2. Where topology differs: first spare the bodies concerned from
/// blunting, then
///    retry at 3/4, 1/2, 1/4 ... of the tolerance. Where one body in a hundred changes its area by over 2 %: once more at
///    17/20.
///
/// @guarantee O1  the graph has no crossing, no overlap, and no vertex within the tolerance of a foreign edge (tolerance/2
/// where
///                the guard needed it)
/// @guarantee O2  nets that touch still touch, nets apart stay apart, each body keeps its number of components; gaps and necks
///                below 1 um within one net are the exception, each with a warning; parts thinner than 1 um are left out (note)
/// @guarantee O3  same input and options give the same bytes
/// @throws Error overlay_topology (401) naming the body, net and place; overlay_no_fixpoint (402); cancelled (103).
/// @cost near-linear in vertices plus crossings.
[[nodiscard]] OverlayResult overlay(const model::Model& model, const OverlayOptions& options, Diagnostics& diagnostics,
                                    const Progress& progress = Progress{});

}  // namespace pcbmesh::overlay
