// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "pcbmesh/view/paint.hpp"
#include "pcbmesh/view/report.hpp"
#include "src/view/packing.hpp"

namespace pcbmesh::view {

using Json = nlohmann::ordered_json;

/// What every page carries beside its mesh: title, places, ramp, arrays.
[[nodiscard]] Json shared_tables(const PageContents& contents, const PackedArrays& packed);
[[nodiscard]] Json material_json(const board::Material& material, Rgb colour);
/// Layers, materials and nets with their colours.
[[nodiscard]] Json names_json(std::span<const std::string> layers, std::span<const board::Material> materials,
                              std::span<const std::string> nets);
/// The page. @param plots  figures, as HTML.
[[nodiscard]] std::string fill_page(const Json& tables, const PackedArrays& packed, const std::string& plots,
                                    const PageContents& contents);
/// "<figure>...</figure>" around an SVG.
[[nodiscard]] std::string figure(const std::string& svg);
/// Histograms and the Pareto front, as figures.
[[nodiscard]] std::string shared_plots(const PageContents& contents);

}  // namespace pcbmesh::view
