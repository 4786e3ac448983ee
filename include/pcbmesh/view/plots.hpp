// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "pcbmesh/layering/prism_quality.hpp"
#include "pcbmesh/layering/quality_report.hpp"
#include "pcbmesh/mesh/prism_mesh.hpp"

namespace pcbmesh::view {

// Small SVG drawings, whole in themselves and fit to stand in a page: text and axes take the colour of the text around them.

/// Bars on a logarithmic scale of counts, so that a handful of bad cells among a million shows.
[[nodiscard]] std::string histogram_svg(const layering::QualityHistogram& histogram);
/// Every layer's height and how it is cut, bottom to top, beside the mean optimal height.
[[nodiscard]] std::string layer_heights_svg(const mesh::PrismMesh& mesh, const layering::HeightStatistics& heights);
/// Mean prism quality over one common height. @source Ye and Daniels, Figure 4.
[[nodiscard]] std::string height_sensitivity_svg(const layering::HeightStatistics& heights);
/// Optimal heights of the triangles, at most 1500 of them, evenly chosen. @source Ye and Daniels, Figure 6.
[[nodiscard]] std::string optimal_heights_svg(const mesh::PrismMesh& mesh, const layering::HeightStatistics& heights);

/// A choice between prisms and quality: the smaller one of both means, over the number of prisms.
struct FrontPlot {
  struct Point {
    double prisms = 0, quality = 0;
  };
  std::vector<Point> front;      ///< predicted, ascending in both
  std::optional<Point> knee{};   ///< where more prisms begin to buy little
  std::vector<Point> made;       ///< meshes made on the way
  std::size_t chosen = 0;        ///< index into made
  std::optional<double> goal{};  ///< quality asked for
};
/// Pareto front of policy matched, the meshes that were made, and the one that was taken.
[[nodiscard]] std::string pareto_front_svg(const FrontPlot& plot);

}  // namespace pcbmesh::view
