// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pcbmesh/layering/divide_layers.hpp"
#include "pcbmesh/layering/prism_quality.hpp"

namespace pcbmesh::layering {

/// Triangles that refinement makes where the bound on edges, not the outlines, decides; lengths over the longest edge.
/// @source measured, docs/evidence/paper.md; the first predictor of the paper's boards.
struct TriangleShape {
  double height = 0.86;  ///< mean optimal height over longest edge
  double area = 0.198;   ///< mean area over its square
  double triangle_quality = 0.912;
};
[[nodiscard]] TriangleShape triangle_shape(study::TriangleSeed seed, bool smooth);

/// What a triangulation with longest edge `to` will be like, from one with `from`: triangles about as large as the edge bound
/// allows scale with it; smaller ones belong to outlines and stay, or are cut where they become too large.
/// Exact for to == from. @cost O(bins).
[[nodiscard]] HeightStatistics predict_heights(const HeightStatistics& measured, double from_m, double to_m,
                                               const TriangleShape& shape);

/// Both means of the prism quality of a plan of equal sub-layers, nothing void.
struct PlanQuality {
  double mean = 0, by_volume = 0;
  [[nodiscard]] double least() const { return mean < by_volume ? mean : by_volume; }
};
[[nodiscard]] PlanQuality plan_quality(const HeightStatistics& heights, std::span<const double> layer_heights_m,
                                       std::span<const int> counts);

/// Best counts for one number of sub-layers in all.
struct CountChoice {
  std::vector<int> counts;  ///< per layer
  int num_sublayers = 0;
  PlanQuality quality;
};
/// For every number of sub-layers in all, counts whose smaller mean is as great as greedy search finds: from `least` on, the
/// cut that raises a weighted sum of both means most, for five weights; the best of the five. Only choices better than all with
/// fewer sub-layers, ascending; at least one. @cost O(cuts x (layers + bins)).
[[nodiscard]] std::vector<CountChoice> best_counts(const HeightStatistics& heights, std::span<const double> layer_heights_m,
                                                   std::span<const int> least);

/// One way to spend prisms.
struct FrontPoint {
  double longest_edge_m = 0, triangles = 0, prisms = 0;
  CountChoice choice;
};
/// A triangulation that was made.
struct MeasuredEdge {
  double longest_edge_m = 0;
  HeightStatistics heights;
};
/// Pareto front over longest edges from the longest measured one down, in steps of 2 %, and over counts: ascending in prisms
/// and in the smaller one of both means. Predicted from the nearest measured triangulation. Empty if even the coarsest has too
/// many prisms.
/// @param measured      at least one
/// @param extra         sub-layers that grading adds to the counts, in all
[[nodiscard]] std::vector<FrontPoint> pareto_front(std::span<const MeasuredEdge> measured,
                                                   std::span<const double> layer_heights_m, std::span<const int> least,
                                                   const TriangleShape& shape, int extra, double most_prisms);

/// Where more prisms begin to buy little: the point farthest above the chord of the front, quality over the logarithm of the
/// prisms. Front not empty.
[[nodiscard]] std::size_t knee_of(std::span<const FrontPoint> front);

/// Edges of the mesh without those of void cells alone: unknowns of edge elements of lowest order before boundary conditions.
/// @cost O(planar edges x slabs).
[[nodiscard]] std::int64_t num_edges(const mesh::PrismMesh& mesh);

}  // namespace pcbmesh::layering
