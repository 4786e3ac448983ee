// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "pcbmesh/mesh/prism_mesh.hpp"

namespace pcbmesh::layering {

/// Measures of one right prism over a triangle. Verdict's definitions for wedges, which a right prism makes simple: its side
/// faces meet at the triangle's angles and its caps at right angles to them.
struct PrismMeasures {
  double quality = 0;    ///< q_p
  double nine_edge = 0;  ///< F11; 1 = regular prism
  double scaled_jacobian =
      0;                    ///< 2/sqrt(3) times the sine of the smallest angle: Verdict's normalisation, 1 = equilateral base
  double aspect_ratio = 0;  ///< longest over shortest of the nine edges (Verdict: edge ratio)
  double min_dihedral_deg = 0;   ///< the triangle's smallest angle
  double max_dihedral_deg = 90;  ///< the triangle's largest angle, at least 90
};
[[nodiscard]] PrismMeasures prism_measures(double area_m2, const std::array<double, 3>& squared_edges_m2, double height_m);

/// Quality of the prisms of one layer, material or net.
struct QualityGroup {
  std::string name;
  std::int64_t num_prisms = 0;
  double volume_m3 = 0;
  double mean_prism = 0, volume_weighted_prism = 0, min_prism = 0, mean_nine_edge = 0;
  double min_dihedral_deg = 0, max_aspect_ratio = 0;
};

/// Prisms by one measure: equal bins from low to high; the first and last bin also hold what lies beyond.
struct QualityHistogram {
  std::string measure;
  double low = 0, high = 1;
  std::vector<std::int64_t> counts;
};

/// A bad prism and where to look for it. It stands for all sub-layers of its height in its slab.
struct WorstPrism {
  double quality = 0;
  std::array<double, 2> at_m{};  ///< centroid of the triangle
  double z_m = 0;                ///< middle of the lowest of these sub-layers
  double height_m = 0;
  std::int32_t triangle = 0, slab = 0, num_sublayers = 0;
  std::string group;  ///< volume tag, "layer|material|net"
};

struct QualityReport {
  std::vector<QualityGroup> layers, materials, nets;  ///< only those with prisms; in the mesh's order, prisms without net last
  std::vector<QualityHistogram> histograms;           ///< q_p, nine-edge, scaled Jacobian, aspect ratio, smallest dihedral
  std::vector<WorstPrism> worst;                      ///< by quality, then slab, then triangle
};

/// Void cells do not count. Heights that differ by less than 1e-9 of themselves are one.
/// @cost O(triangles x (slabs + distinct heights per slab)); memory O(volume tags).
[[nodiscard]] QualityReport quality_report(const mesh::PrismMesh& mesh, int num_worst = 10);

}  // namespace pcbmesh::layering
