// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

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

}  // namespace pcbmesh::view
