// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>

#include "pcbmesh/mesh/layer_plan.hpp"
#include "pcbmesh/mesh/planar_mesh.hpp"
#include "pcbmesh/mesh/prism_mesh.hpp"

namespace pcbmesh::layering {

/// 16 sqrt(3) / 27: the largest prism quality there is.
inline constexpr double max_prism_quality = 1.0264004785593347;

/// Triangle quality q_t = 4 sqrt(3) A / (h1^2 + h2^2 + h3^2), in (0, 1]; 1 = equilateral. @source Ye and Daniels eq. 1.
/// `beta` is the sum of squared edges.
[[nodiscard]] double triangle_quality(double area, double beta);
/// Prism quality q_p = (32 sqrt(3)/3) V / (h1^2 + h2^2 + h3^2 + h4^2)^(3/2). @source eq. 2.
[[nodiscard]] double prism_quality(double area, double beta, double height);
/// Height of best quality, sqrt(beta / 2). @source eq. 3.
[[nodiscard]] double optimal_height(double beta);
/// q_p(h) / q_p(h*) as a function of s = h / h*: the same curve for every triangle. F6 of docs/evidence/paper.md.
[[nodiscard]] double quality_falloff(double s);
/// Ratio H/h* above which n + 1 cuts beat n (F10). n >= 1.
[[nodiscard]] double cut_threshold(int n);
/// Number of equal cuts of a layer of height H that maximises quality_falloff(H / n / h). @guarantee exact thresholds F10.
[[nodiscard]] int optimal_cuts(double layer_height, double optimal_height);

/// Optimal heights over a planar mesh, metres.
struct HeightStatistics {
  double minimum = 0, average = 0, maximum = 0;
  double mean_triangle_quality = 0;
  std::int64_t num_below_average = 0;
};
[[nodiscard]] HeightStatistics height_statistics(const mesh::PlanarMesh& mesh);

/// Quality of a whole prism mesh. @cost O(triangles x distinct sub-layer heights).
struct QualityStatistics {
  double mean_triangle = 0, min_triangle = 0;
  double mean_prism = 0, volume_weighted_prism = 0, min_prism = 0, quantile1_prism = 0;
  double min_angle_deg = 0, longest_edge_m = 0, shortest_edge_m = 0;
};
[[nodiscard]] QualityStatistics quality_statistics(const mesh::PrismMesh& mesh);

}  // namespace pcbmesh::layering
