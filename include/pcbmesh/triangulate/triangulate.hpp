// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "pcbmesh/base/diagnostics.hpp"
#include "pcbmesh/base/progress.hpp"
#include "pcbmesh/mesh/planar_graph.hpp"
#include "pcbmesh/mesh/planar_mesh.hpp"
#include "pcbmesh/model/model.hpp"

namespace pcbmesh::triangulate {

/// Edge length that grows with the distance to copper outlines.
struct Grading {
  double edge_at_copper_nm = 0;  ///< > 0
  double growth = 0.3;           ///< edge length gained per unit of distance
};

/// What refinement starts from.
enum class Seed {
  delaunay,  ///< the outlines alone, as in the paper
  hexagonal  ///< a lattice of equilateral triangles between outlines cut to its edge
};

struct TriangulateOptions {
  double longest_edge_nm = 2e6;  ///< > 0; a double: the feedback of h must not be rounded
  double min_angle_deg = 20.7;   ///< in (0, 28.6]
  std::optional<Grading> grading{};
  Seed seed = Seed::delaunay;  ///< hexagonal excludes grading; the lattice's edge is longest_edge_nm * lattice_over_longest
  bool smooth = false;         ///< guarded smoothing of the vertices inside faces; angle and edge bounds still hold
  bool split_sheet_chords = false;  ///< two elements at least across every sheet: Palace's rule
  std::int64_t max_vertices = 50'000'000;
  /// CGAL's stock mesher on millimetre doubles, as the paper's program had it: reproduces its triangle counts, which
  /// hang on rounding (a right angle is not quite right in binary millimetres). Slower, and unsafe for near-coincident edges.
  bool as_in_paper = false;
};

/// Edge of the hexagonal lattice over the bound on edges: between lattice and outlines some edges are longer.
inline constexpr double lattice_over_longest = 0.625;

struct TriangulateStatistics {
  std::int64_t num_input_vertices = 0;
  std::int64_t num_steiner = 0;
  double min_angle_deg = 0;                     ///< reached
  std::int64_t num_chord_splits = 0;            ///< vertices added for split_sheet_chords
  std::int64_t num_below_bound = 0;             ///< triangles below the bound (forced by input angles)
  double cdt_s = 0, refine_s = 0, label_s = 0;  ///< process CPU seconds; seeding and smoothing count as refinement
};

struct TriangulateResult {
  mesh::PlanarMesh mesh;
  TriangulateStatistics statistics;
};

/// Constrained Delaunay triangulation of the graph, refined (CGAL 2D mesher; bound 20.7 degrees is B = 0.125 = sin^2),
/// and labelled by one flood from the outside. Triangles outside body 0 (domain) are dropped.
///
/// @guarantee T1  every graph edge is a union of mesh edges
/// @guarantee T2  each triangle lies in exactly one face of the graph
/// @guarantee T3  same input and options give the same bytes
/// @guarantee T5  with split_sheet_chords no edge inside a sheet has both its ends on the sheet's rim
/// @guarantee T6  inside the footprint of a lumped port no edge is longer than half its width, and half its length if it is
/// flat; inside that of any port none is longer than the study's bound for it (but not with as_in_paper)
/// @guarantee T4  refinement ends: vertices are capped, and forced small angles are reported, not chased
/// @guarantee T6  where the model calls opposite sides periodic, both have the same vertices, in the same order of their ids
/// @throws Error study_invalid (102) where periodic sides do not show the same, usage (101), planar_crossing_edges (403),
/// triangulation_limit (404), cancelled (103).
/// @cost about 1 us and 120 bytes at the peak per triangle, linear (benchmarks/triangulate_bench.cpp).
/// @source Ye and Daniels sec. 3; Shewchuk 2002, Ruppert 1995 through CGAL Mesh_2.
[[nodiscard]] TriangulateResult triangulate(const mesh::PlanarGraph& graph, const model::Model& model,
                                            const TriangulateOptions& options, Diagnostics& diagnostics,
                                            const Progress& progress = Progress{});

}  // namespace pcbmesh::triangulate
