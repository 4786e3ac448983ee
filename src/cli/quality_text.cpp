// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/cli/quality_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "src/cli/terminal.hpp"

namespace pcbmesh::cli {
namespace {

using Json = nlohmann::ordered_json;

Json groups_json(const std::vector<layering::QualityGroup>& groups) {
  Json out = Json::array();
  for (const layering::QualityGroup& g : groups)
    out.push_back({{"name", g.name},
                   {"prisms", g.num_prisms},
                   {"volume_m3", g.volume_m3},
                   {"mean_prism", g.mean_prism},
                   {"volume_weighted_prism", g.volume_weighted_prism},
                   {"min_prism", g.min_prism},
                   {"mean_nine_edge", g.mean_nine_edge},
                   {"min_dihedral_deg", g.min_dihedral_deg},
                   {"max_aspect_ratio", g.max_aspect_ratio}});
  return out;
}

std::string groups_text(std::string_view kind, const std::vector<layering::QualityGroup>& groups) {
  constexpr std::size_t most = 20;  // the rest is in report.json
  std::string out = fmt::format("  by {:<20} {:>12} {:>8} {:>9} {:>8} {:>9} {:>8} {:>8}\n", kind, "prisms", "mean", "by volume",
                                "worst", "nine-edge", "angle", "aspect");
  for (std::size_t i = 0; i < std::min(most, groups.size()); ++i) {
    const layering::QualityGroup& g = groups[i];
    out += fmt::format("    {:<21} {:>12} {:>8.4f} {:>9.4f} {:>8.4f} {:>9.4f} {:>8.2f} {:>8.1f}\n", g.name.substr(0, 21),
                       grouped(g.num_prisms), g.mean_prism, g.volume_weighted_prism, g.min_prism, g.mean_nine_edge,
                       g.min_dihedral_deg, g.max_aspect_ratio);
  }
  if (groups.size() > most) out += fmt::format("    and {} more in report.json\n", groups.size() - most);
  return out;
}

std::string histogram_text(const layering::QualityHistogram& histogram) {
  constexpr double widest = 50;
  const std::int64_t most = *std::max_element(histogram.counts.begin(), histogram.counts.end());
  std::string out = fmt::format("  {}\n", histogram.measure);
  for (std::size_t i = 0; i < histogram.counts.size(); ++i) {
    if (histogram.counts[i] == 0) continue;
    const double step = (histogram.high - histogram.low) / static_cast<double>(histogram.counts.size());
    const auto bar = static_cast<std::size_t>(widest * static_cast<double>(histogram.counts[i]) / static_cast<double>(most));
    out += fmt::format("    {:>8.3f} {:>14} {}\n", histogram.low + step * static_cast<double>(i), grouped(histogram.counts[i]),
                       std::string(bar, '#'));
  }
  return out;
}

}  // namespace

Json quality_json(const layering::QualityReport& report) {
  Json histograms = Json::array(), worst = Json::array();
  for (const layering::QualityHistogram& h : report.histograms)
    histograms.push_back({{"measure", h.measure}, {"low", h.low}, {"high", h.high}, {"counts", h.counts}});
  for (const layering::WorstPrism& w : report.worst)
    worst.push_back({{"quality", w.quality},
                     {"at_mm", {w.at_m[0] * 1e3, w.at_m[1] * 1e3, w.z_m * 1e3}},
                     {"height_m", w.height_m},
                     {"triangle", w.triangle},
                     {"slab", w.slab},
                     {"sublayers", w.num_sublayers},
                     {"group", w.group}});
  return {{"layers", groups_json(report.layers)},
          {"materials", groups_json(report.materials)},
          {"nets", groups_json(report.nets)},
          {"histograms", histograms},
          {"worst", worst}};
}

std::string quality_text(const layering::QualityReport& report) {
  std::string out =
      groups_text("layer", report.layers) + groups_text("material", report.materials) + groups_text("net", report.nets);
  for (const layering::QualityHistogram& histogram : report.histograms) out += histogram_text(histogram);
  out += "  worst prisms\n";
  for (const layering::WorstPrism& w : report.worst)
    out += fmt::format("    {:.4f} at ({:.4f}, {:.4f}, {:.4f}) mm, height {:.4g} um, {} sub-layers, {}\n", w.quality,
                       w.at_m[0] * 1e3, w.at_m[1] * 1e3, w.z_m * 1e3, w.height_m * 1e6, w.num_sublayers, w.group);
  return out;
}

}  // namespace pcbmesh::cli
