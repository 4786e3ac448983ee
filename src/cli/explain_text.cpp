// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/cli/explain_text.hpp"

#include <fmt/format.h>

#include <cmath>

#include "src/cli/terminal.hpp"

namespace pcbmesh::cli {
namespace {

using Json = nlohmann::ordered_json;
using layering::LayerChoice;
using layering::LayerExplanation;

Json finite(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

std::string heights_text(const LayerChoice& layer) {
  const double low = layer.lowest_m * 1e6, high = layer.highest_m * 1e6;
  return high - low > 1e-6 * high ? fmt::format("{:.4g}-{:.4g}", low, high) : fmt::format("{:.4g}", high);
}

std::string change(const std::string& before, const std::string& after) {
  return before == after ? after : before + " > " + after;
}

/// What a bound asked for, where it decided.
std::string reason_text(const LayerChoice& layer) {
  switch (layer.cause) {
    case layering::HeightCause::wavelength:
      return fmt::format("wavelength: at most {:.4g} um", layer.limits.wavelength_height_m * 1e6);
    case layering::HeightCause::across:
      return fmt::format("across: at least {}", layer.limits.least_count);
    case layering::HeightCause::port:
      return fmt::format("port: at least {}", layer.limits.port_count);
    case layering::HeightCause::skin_depth:
      return fmt::format("skin depth {:.4g} um: {:.4g} um at faces", layer.limits.skin_depth_m * 1e6,
                         layer.limits.face_height_m * 1e6);
    case layering::HeightCause::slab:
    case layering::HeightCause::policy:
    case layering::HeightCause::growth:
      break;
  }
  return std::string(name_of(layer.cause));
}

std::string quality_cell(const LayerExplanation& e, double quality) {
  return e.num_triangles == 0 || quality == 0 ? "-" : fmt::format("{:.3f}", quality);
}

std::string match_text(const pipeline::MeshBoardResult& result) {
  const pipeline::MatchResult& match = *result.match;
  std::string out = fmt::format("  meshes made\n    {:>12} {:>12} {:>12} {:>12} {:>8} {:>9}\n", "edge, um", "triangles",
                                "prisms", "unknowns", "mean", "by volume");
  for (std::size_t i = 0; i < match.steps.size(); ++i) {
    const pipeline::MatchStep& s = match.steps[i];
    out += fmt::format("    {:>12.5g} {:>12} {:>12} {:>12} {:>8.4f} {:>9.4f}{}{}\n", s.longest_edge_m * 1e6,
                       grouped(s.triangles), grouped(s.prisms), grouped(s.unknowns), s.mean_prism, s.volume_weighted_prism,
                       s.meets ? "  meets the goal" : "", i == match.chosen ? ", chosen" : "");
  }
  const layering::FrontPoint& knee = match.front[match.knee];
  const auto point = [](const layering::FrontPoint& p) {
    return fmt::format("quality {:.3f} with {:.3g} prisms", p.choice.quality.least(), p.prisms);
  };
  out += fmt::format("  Pareto front, predicted: {} to {}; knee: {}\n", point(match.front.front()), point(match.front.back()),
                     point(knee));
  return out;
}

}  // namespace

Json layers_json(const pipeline::MeshBoardResult& result, std::span<const LayerExplanation> explained) {
  Json out = Json::array();
  for (std::size_t s = 0; s < result.layers.size(); ++s) {
    const LayerChoice& layer = result.layers[s];
    const LayerExplanation& e = explained[s];
    Json heights = Json::array();
    const mesh::LayerPlan& plan = result.mesh.plan();
    const auto slab = static_cast<std::int32_t>(s);
    // Equal heights are told once.
    const bool is_equal = layer.highest_m - layer.lowest_m <= 1e-9 * layer.highest_m;
    for (std::int32_t k = plan.first_sublayer(slab);
         k < (is_equal ? plan.first_sublayer(slab) + 1 : plan.first_sublayer(slab + 1)); ++k)
      heights.push_back(plan.height_m(k));
    out.push_back({{"layer", layer.layer},
                   {"height_m", layer.height_m},
                   {"sublayers_by_policy", layer.policy_count},
                   {"sublayers", layer.count},
                   {"sublayer_heights_m", std::move(heights)},
                   {"equal_heights", is_equal},
                   {"forced_by", name_of(layer.cause)},
                   {"wavelength_height_m", finite(layer.limits.wavelength_height_m)},
                   {"least_sublayers", layer.limits.least_count},
                   {"skin_depth_m", layer.limits.skin_depth_m},
                   {"face_height_m", finite(layer.limits.face_height_m)},
                   {"triangles", e.num_triangles},
                   {"prisms_by_policy", e.prisms_before},
                   {"prisms", e.prisms_after},
                   {"quality_by_policy", e.quality_before},
                   {"quality", e.quality_after},
                   {"quality_one_fewer", e.quality_one_fewer},
                   {"quality_one_more", e.quality_one_more},
                   {"best_height_m", e.best_height_m},
                   {"relative_height", e.relative_height},
                   {"sensitivity_per_m2", e.sensitivity_per_m2}});
  }
  return out;
}

Json match_json(const pipeline::MeshBoardResult& result) {
  if (!result.match) return nullptr;
  const pipeline::MatchResult& match = *result.match;
  Json steps = Json::array(), front = Json::array();
  for (const pipeline::MatchStep& s : match.steps)
    steps.push_back({{"longest_edge_m", s.longest_edge_m},
                     {"triangles", s.triangles},
                     {"sublayers", s.sublayers},
                     {"prisms", s.prisms},
                     {"unknowns", s.unknowns},
                     {"mean_prism", s.mean_prism},
                     {"volume_weighted_prism", s.volume_weighted_prism},
                     {"meets", s.meets}});
  for (const layering::FrontPoint& p : match.front)
    front.push_back({{"longest_edge_m", p.longest_edge_m},
                     {"prisms", p.prisms},
                     {"mean_prism", p.choice.quality.mean},
                     {"volume_weighted_prism", p.choice.quality.by_volume},
                     {"sublayers", p.choice.counts}});
  return {{"meshes", steps}, {"chosen", match.chosen}, {"front", front}, {"knee", match.knee}};
}

std::string explain_text(const pipeline::MeshBoardResult& result, std::span<const LayerExplanation> explained) {
  std::string out = fmt::format("  layers, bottom to top\n    {:<18} {:>9} {:>10} {:>16} {:>19} {:>15} {:>6} {:>6} {:>5}  {}\n",
                                "layer", "um", "sub-layers", "of um", "prisms", "q_p", "1 less", "1 more", "s", "forced by");
  for (std::size_t s = 0; s < result.layers.size(); ++s) {
    const LayerChoice& layer = result.layers[s];
    const LayerExplanation& e = explained[s];
    out += fmt::format("    {:<18} {:>9.5g} {:>10} {:>16} {:>19} {:>15} {:>6} {:>6} {:>5.2f}  {}\n", layer.layer.substr(0, 18),
                       layer.height_m * 1e6, change(fmt::to_string(layer.policy_count), fmt::to_string(layer.count)),
                       heights_text(layer), change(grouped(e.prisms_before), grouped(e.prisms_after)),
                       change(quality_cell(e, e.quality_before), quality_cell(e, e.quality_after)),
                       quality_cell(e, e.quality_one_fewer), quality_cell(e, e.quality_one_more), e.relative_height,
                       reason_text(layer));
  }
  // f of F6: what a height off its optimum costs, the same for every triangle.
  out +=
      "    a > b: by the policy alone > with the bounds. s: mean sub-layer height over the mean optimal height; a prism keeps "
      "99 %\n"
      "    of its best quality for s of 0.88 to 1.13, 90 % for 0.66 to 1.47, half for 0.29 to 2.68. 1 less, 1 more: q_p with "
      "equal\n"
      "    sub-layers, one fewer or one more: where they hardly differ, the number of sub-layers decides little\n";
  const layering::HeightStatistics& h = result.heights;
  out += fmt::format("  optimal heights of the final mesh, um: min {:.4g}, weighted {:.4g}, average {:.4g}, max {:.4g}\n",
                     h.minimum * 1e6, h.weighted * 1e6, h.average * 1e6, h.maximum * 1e6);
  if (result.match) out += match_text(result);
  return out;
}

}  // namespace pcbmesh::cli
