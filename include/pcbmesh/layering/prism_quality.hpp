// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "pcbmesh/mesh/layer_plan.hpp"
#include "pcbmesh/mesh/planar_mesh.hpp"
#include "pcbmesh/mesh/prism_mesh.hpp"
#include "pcbmesh/mesh/prism_source.hpp"

namespace pcbmesh::layering {

/// 16 sqrt(3) / 27: the largest prism quality there is.
inline constexpr double max_prism_quality = 1.0264004785593347;

/// Triangle quality q_t = 4 sqrt(3) A / (h1^2 + h2^2 + h3^2), in (0, 1]; 1 = equilateral. @source Ye and Daniels eq. 1.
/// `beta` is the sum of squared edges.
[[nodiscard]] double triangle_quality(double area, double beta);
/// Prism quality q_p = (32 sqrt(3)/3) V / (h1^2 + h2^2 + h3^2 + h4^2)^(3/2). @source eq. 2.
[[nodiscard]] double prism_quality(double area, double beta, double height);
/// The same, to the last bit, for prisms of one height: several at a time. Fits mesh::PrismQuality.
void prism_qualities(std::span<const mesh::PrismBase> bases, double height, std::span<double> qualities);
/// Height of best quality, sqrt(beta / 2). @source eq. 3.
[[nodiscard]] double optimal_height(double beta);
/// q_p(h) / q_p(h*) as a function of s = h / h*: the same curve for every triangle. F6 of docs/evidence/paper.md.
[[nodiscard]] double quality_falloff(double s);
/// Ratio H/h* above which n + 1 cuts beat n (F10): s_n = (n + 1) sqrt(2 / (r (r + 1))), r = ((n + 1)/n)^(2/3). n >= 1.
[[nodiscard]] double cut_threshold(int n);
/// Number of equal cuts of a layer of height H that maximises quality_falloff(H / n / h); on a tie the smaller. Exact
/// thresholds F10. Both heights > 0. Results above 2^31 - 1 are given as 2^31 - 1.
[[nodiscard]] int optimal_cuts(double layer_height, double optimal_height);

/// Height that is the mean of the three edges, the rule of Yamakawa and Shimada the paper compares with.
[[nodiscard]] double average_edge_height(const std::array<double, 3>& squared_edges);
/// Quality with nine edges, 36 sqrt(3) V / (2 beta + 3 h^2)^(3/2): best at h = sqrt(beta / 3), where it equals the triangle
/// quality (F11).
[[nodiscard]] double nine_edge_quality(double area, double beta, double height);

/// Triangles of about the same optimal height: best quality in sum and the mean height.
struct HeightBin {
  double height = 0;            ///< mean, metres
  double sum_quality = 0;       ///< of the prism quality at the optimal height
  double count = 0;             ///< triangles
  double area_m2 = 0;           ///< of the triangles
  double sum_area_quality = 0;  ///< of area times quality at the optimal height
};

/// Optimal heights over a planar mesh, metres.
struct HeightStatistics {
  double minimum = 0, average = 0, maximum = 0;
  double weighted = 0;  ///< sum of q*/h* over sum of q*/h*^2: where the parabolas of F8, added up, are highest
  double mean_triangle_quality = 0;
  std::int64_t num_below_average = 0;
  std::int64_t num_triangles = 0;
  std::vector<HeightBin> bins;  ///< ascending, each 0.8 % wide: enough for mean qualities to 1e-4
};
/// All zero for a mesh without triangles. @cost O(triangles).
[[nodiscard]] HeightStatistics height_statistics(const mesh::PlanarMesh& mesh);

/// Mean over the triangles, and over their area, of the prism quality at one height. @cost O(bins).
[[nodiscard]] double mean_quality_at(const HeightStatistics& heights, double height);
[[nodiscard]] double area_quality_at(const HeightStatistics& heights, double height);

/// Quality of a whole prism mesh. Void cells do not count; a planar triangle counts once if any prism stands on it.
struct QualityStatistics {
  double mean_triangle = 0, min_triangle = 0;
  double mean_prism = 0, volume_weighted_prism = 0, min_prism = 0, quantile1_prism = 0;  ///< 1 %: relative error below 2.5e-4
  double min_angle_deg = 0, longest_edge_m = 0, shortest_edge_m = 0;
};
/// All zero for a mesh without prisms. Heights that differ by less than 1e-9 of themselves are one.
/// @cost O(triangles x distinct sub-layer heights); memory O(regions x distinct heights).
[[nodiscard]] QualityStatistics quality_statistics(const mesh::PrismMesh& mesh);

}  // namespace pcbmesh::layering
