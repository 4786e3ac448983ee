// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/view/plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "src/view/svg.hpp"

namespace pcbmesh::view {
namespace {

constexpr int width = 360, height = 190, left = 46, right = 12, top = 30, bottom = 36;
constexpr double inner_width = width - left - right, inner_height = height - top - bottom;
constexpr std::string_view bar_colour = "#3d8f8a", mark_colour = "#c8643c";

std::size_t index(std::int64_t i) {
  return static_cast<std::size_t>(i);
}

/// Frame, title and axes of one plot.
class Plot {
 public:
  Plot(std::string_view title, int plot_height = height) : height_(plot_height) {
    text_ = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" role=\"img\" aria-label=\"{2}\" "
        "font-family=\"system-ui, sans-serif\" font-size=\"11\" fill=\"currentColor\">\n<title>{2}</title>\n"
        "<text x=\"{3}\" y=\"18\" font-size=\"12.5\" font-weight=\"600\">{2}</text>\n",
        width, plot_height, escape_xml(title), 4);
  }
  void put(std::string_view markup) { text_ += markup; }
  void axes() {
    put(fmt::format("<path d=\"M{0} {1}V{2}H{3}\" fill=\"none\" stroke=\"currentColor\" stroke-opacity=\".5\"/>\n", left, top,
                    height_ - bottom, width - right));
  }
  void x_tick(double at, std::string_view label) {
    put(
        fmt::format("<path d=\"M{0:.1f} {1}v4\" stroke=\"currentColor\" stroke-opacity=\".5\"/><text x=\"{0:.1f}\" y=\"{2}\" "
                    "text-anchor=\"middle\">{3}</text>\n",
                    at, height_ - bottom, height_ - bottom + 16, label));
  }
  void y_tick(double at, std::string_view label) {
    put(fmt::format(
        "<path d=\"M{0} {1:.1f}H{2}\" stroke=\"currentColor\" stroke-opacity=\".12\"/><text x=\"{3}\" y=\"{4:.1f}\" "
        "text-anchor=\"end\">{5}</text>\n",
        left, at, width - right, left - 5, at + 4, label));
  }
  void x_label(std::string_view label) {
    put(fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\" fill-opacity=\".75\">{}</text>\n",
                    left + inner_width / 2, height_ - 4, label));
  }
  [[nodiscard]] std::string finish() { return text_ + "</svg>\n"; }

 private:
  std::string text_;
  int height_;
};

/// Four to six round numbers from low to high.
std::vector<double> round_ticks(double low, double high) {
  const double rough = (high - low) / 4, power = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10 * power;
  for (const double s : {1.0, 2.0, 2.5, 5.0})
    if (s * power >= rough * 0.8) {
      step = s * power;
      break;
    }
  std::vector<double> ticks;
  for (double at = std::ceil(low / step - 1e-9) * step; at <= high + 1e-9 * step; at += step) ticks.push_back(at + 0.0);
  return ticks;
}

/// The measures of layering::quality_report in words; others by their own name.
std::string_view title_of(std::string_view measure) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 5> titles{{
      {"prism_quality", "Prism quality q_p"},
      {"nine_edge_quality", "Nine-edge quality"},
      {"scaled_jacobian", "Scaled Jacobian"},
      {"aspect_ratio", "Aspect ratio"},
      {"min_dihedral_deg", "Smallest dihedral angle, degrees"},
  }};
  for (const auto& [name, title] : titles)
    if (name == measure) return title;
  return measure;
}

std::string power_of_ten(int exponent) {
  return exponent <= 3 ? fmt::format("{}", static_cast<int>(std::pow(10, exponent)))
                       : fmt::format("10<tspan dy=\"-4\" font-size=\"8\">{}</tspan>", exponent);
}

}  // namespace

std::string histogram_svg(const layering::QualityHistogram& histogram) {
  Plot plot(title_of(histogram.measure));
  const std::int64_t most = std::max<std::int64_t>(1, *std::max_element(histogram.counts.begin(), histogram.counts.end()));
  const double decades = std::max(1.0, std::ceil(std::log10(static_cast<double>(most)) + 1e-9)) + 0.15;
  // A count of one stands a little above the axis.
  const auto height_of = [&](double count) { return inner_height * (std::log10(count) + 0.15) / decades; };
  const double step = inner_width / static_cast<double>(histogram.counts.size());
  const double bin = (histogram.high - histogram.low) / static_cast<double>(histogram.counts.size());
  for (int d = 0; d <= static_cast<int>(decades); ++d)
    plot.y_tick(height - bottom - height_of(std::pow(10, d)), power_of_ten(d));
  for (std::size_t i = 0; i < histogram.counts.size(); ++i) {
    if (histogram.counts[i] == 0) continue;
    const double bar = height_of(static_cast<double>(histogram.counts[i])), at = static_cast<double>(i);
    plot.put(fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\"><title>{:.3g} to {:.3g}: {} "
        "prisms</title></rect>\n",
        left + at * step + 0.6, height - bottom - bar, step - 1.2, bar, bar_colour, histogram.low + at * bin,
        histogram.low + (at + 1) * bin, histogram.counts[i]));
  }
  plot.axes();
  for (const double at : round_ticks(histogram.low, histogram.high))
    plot.x_tick(left + inner_width * (at - histogram.low) / (histogram.high - histogram.low), fmt::format("{:.4g}", at));
  plot.x_label("prisms on a logarithmic scale");
  return plot.finish();
}

std::string layer_heights_svg(const mesh::PrismMesh& mesh, const layering::HeightStatistics& heights) {
  const std::int32_t num_slabs = mesh.plan().num_slabs();
  struct Row {
    std::string name;
    double thickness_m = 0;
    std::int32_t cuts = 0;
  };
  std::vector<Row> rows;
  for (std::int32_t s = 0; s < num_slabs; ++s) {
    const std::int32_t first = mesh.plan().first_sublayer(s), last = mesh.plan().first_sublayer(s + 1);
    std::string name;
    for (std::int32_t t = 0; t < mesh.planar().num_triangles() && name.empty(); ++t)
      if (const std::int32_t group = mesh.tag_of(s, t); group >= 0)
        name = mesh.layers()[index(mesh.volume_tags()[index(group)].layer)];
    if (name.empty()) name = "empty";
    rows.push_back({name, mesh.plan().z_m()[index(last)] - mesh.plan().z_m()[index(first)], last - first});
  }
  constexpr int row_height = 18, name_width = 104;
  const int plot_height = top + row_height * num_slabs + 24;
  Plot plot("Layers: height and cuts", plot_height);
  double largest = 0, smallest = heights.average > 0 ? heights.average : 1;
  for (const Row& row : rows) {
    largest = std::max(largest, row.thickness_m);
    smallest = std::min(smallest, row.thickness_m / row.cuts);
  }
  largest = std::max(largest, heights.average);
  const double low = smallest / 1.6, span = std::log(largest / low);
  const double room = width - right - name_width - 96;
  const auto x_of = [&](double length) { return name_width + room * std::log(length / low) / span; };
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[rows.size() - 1 - i];
    const double y = top + row_height * static_cast<double>(i);
    const std::string name = row.name.size() > 16 ? row.name.substr(0, 15) + "\xe2\x80\xa6" : row.name;
    plot.put(fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{}</text>", name_width - 6, y + 12, escape_xml(name)));
    plot.put(
        fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{:.1f}\" height=\"{}\" fill=\"{}\" fill-opacity=\".3\"/><rect x=\"{}\" "
                    "y=\"{}\" width=\"{:.1f}\" height=\"{}\" fill=\"{}\"/>",
                    name_width, y + 2, x_of(row.thickness_m) - name_width, row_height - 5, bar_colour, name_width, y + 2,
                    x_of(row.thickness_m / row.cuts) - name_width, row_height - 5, bar_colour));
    plot.put(fmt::format("<text x=\"{:.1f}\" y=\"{}\">{} &#215; {:.3g} &#181;m</text>\n", x_of(row.thickness_m) + 5, y + 12,
                         row.cuts, row.thickness_m / row.cuts * 1e6));
  }
  if (heights.average > 0)
    plot.put(
        fmt::format("<path d=\"M{0:.1f} {1}V{2}\" stroke=\"{3}\" stroke-dasharray=\"4 3\"/><text x=\"{0:.1f}\" y=\"{4}\" "
                    "text-anchor=\"middle\">mean optimal height {5:.3g} &#181;m</text>\n",
                    x_of(heights.average), top, plot_height - 20, mark_colour, plot_height - 6, heights.average * 1e6));
  return plot.finish();
}

std::string height_sensitivity_svg(const layering::HeightStatistics& heights) {
  Plot plot("Mean prism quality over one common height");
  if (!(heights.minimum > 0)) return plot.finish();
  const double low = heights.minimum / 3, high = heights.maximum * 3, span = std::log10(high / low);
  const auto x_of = [&](double h) { return left + inner_width * std::log10(h / low) / span; };
  const auto y_of = [&](double q) { return height - bottom - inner_height * q / 1.05; };
  for (const double q : {0.0, 0.25, 0.5, 0.75, 1.0}) plot.y_tick(y_of(q), fmt::format("{}", q));
  std::string path;
  double best = 0, best_height = low;
  constexpr int steps = 160;
  for (int i = 0; i <= steps; ++i) {
    const double h = low * std::pow(10.0, span * i / steps), q = layering::mean_quality_at(heights, h);
    path += fmt::format("{}{:.1f} {:.1f}", i == 0 ? "M" : "L", x_of(h), y_of(q));
    if (q > best) {
      best = q;
      best_height = h;
    }
  }
  plot.put(fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"/>\n", path, bar_colour));
  plot.put(
      fmt::format("<circle cx=\"{0:.1f}\" cy=\"{1:.1f}\" r=\"3.5\" fill=\"{2}\"/><text x=\"{0:.1f}\" y=\"{3:.1f}\" "
                  "text-anchor=\"middle\">{4:.3f} at {5:.3g} &#181;m</text>\n",
                  x_of(best_height), y_of(best), mark_colour, y_of(best) - 8, best, best_height * 1e6));
  plot.axes();
  for (int d = static_cast<int>(std::ceil(std::log10(low * 1e6) - 1e-9));
       d <= static_cast<int>(std::floor(std::log10(high * 1e6))); ++d)
    plot.x_tick(x_of(std::pow(10.0, d) * 1e-6), fmt::format("{:.3g}", std::pow(10.0, d)));
  plot.x_label("height, &#181;m");
  return plot.finish();
}

std::string optimal_heights_svg(const mesh::PrismMesh& mesh, const layering::HeightStatistics& heights) {
  Plot plot("Optimal prism height of every triangle");
  constexpr std::int64_t most_dots = 1500;
  const std::int64_t num_triangles = mesh.planar().num_triangles();
  const double high = heights.maximum > 0 ? heights.maximum * 1.05 : 1;
  const auto y_of = [&](double h) { return height - bottom - inner_height * h / high; };
  for (const double at : round_ticks(0, high * 1e6)) plot.y_tick(y_of(at * 1e-6), fmt::format("{:.4g}", at));
  const std::int64_t dots = std::min(num_triangles, most_dots);
  std::string path;
  for (std::int64_t i = 0; i < dots; ++i) {
    const auto t = static_cast<std::int32_t>(i * num_triangles / dots);
    const auto squared = mesh.planar().squared_edges_m2(t);
    const double h = layering::optimal_height(squared[0] + squared[1] + squared[2]);
    path += fmt::format("M{:.1f} {:.1f}h0", left + inner_width * static_cast<double>(t) / static_cast<double>(num_triangles),
                        y_of(h));
  }
  plot.put(
      fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2.4\" stroke-linecap=\"round\" "
                  "stroke-opacity=\".7\"/>\n",
                  path, bar_colour));
  plot.put(
      fmt::format("<path d=\"M{0} {1:.1f}H{2}\" stroke=\"{3}\" stroke-dasharray=\"4 3\"/><text x=\"{2}\" y=\"{4:.1f}\" "
                  "text-anchor=\"end\">mean {5:.3g} &#181;m</text>\n",
                  left, y_of(heights.average), width - right, mark_colour, y_of(heights.average) - 5, heights.average * 1e6));
  plot.axes();
  plot.x_label(dots < num_triangles ? fmt::format("{} of {} triangles; h*, &#181;m", dots, num_triangles)
                                    : fmt::format("{} triangles; h*, &#181;m", num_triangles));
  return plot.finish();
}

std::string pareto_front_svg(const FrontPlot& front) {
  Plot plot("Pareto front: quality over prisms");
  std::vector<FrontPlot::Point> all = front.front;
  all.insert(all.end(), front.made.begin(), front.made.end());
  if (all.empty()) return plot.finish();
  double low = all.front().prisms, high = low, worst = all.front().quality, best = worst;
  for (const FrontPlot::Point& p : all) {
    low = std::min(low, p.prisms);
    high = std::max(high, p.prisms);
    worst = std::min(worst, p.quality);
    best = std::max(best, p.quality);
  }
  if (front.goal) best = std::max(best, *front.goal);
  low /= 1.15;
  high *= 1.15;
  const double margin = std::max(0.08 * (best - worst), 0.004), bottom_q = worst - margin, top_q = best + 2 * margin;
  const auto x_of = [&](double n) { return left + inner_width * std::log(n / low) / std::log(high / low); };
  const auto y_of = [&](double q) { return height - bottom - inner_height * (q - bottom_q) / (top_q - bottom_q); };
  for (const double at : round_ticks(bottom_q, top_q)) plot.y_tick(y_of(at), fmt::format("{:.4g}", at));
  if (front.goal)
    plot.put(
        fmt::format("<path d=\"M{} {:.1f}H{}\" stroke=\"currentColor\" stroke-opacity=\".6\" "
                    "stroke-dasharray=\"4 3\"><title>goal {:.4g}</title></path>\n",
                    left, y_of(*front.goal), width - right, *front.goal));
  std::string path;
  for (const FrontPlot::Point& p : front.front)
    path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", x_of(p.prisms), y_of(p.quality));
  plot.put(fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"><title>predicted front</title></path>\n",
                       path, bar_colour));
  for (std::size_t i = 0; i < front.made.size(); ++i) {
    const FrontPlot::Point& p = front.made[i];
    const bool is_chosen = i == front.chosen;
    plot.put(
        fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" fill=\"{}\"><title>{}: {:.0f} prisms, quality "
                    "{:.4f}</title></circle>\n",
                    x_of(p.prisms), y_of(p.quality), is_chosen ? 5 : 3, is_chosen ? mark_colour : bar_colour,
                    is_chosen ? "taken" : "tried", p.prisms, p.quality));
  }
  if (front.knee)
    plot.put(
        fmt::format("<path d=\"M{:.1f} {:.1f}m0 -5l5 5l-5 5l-5 -5z\" fill=\"none\" stroke=\"currentColor\"><title>knee: "
                    "{:.0f} prisms, quality {:.4f}</title></path>\n",
                    x_of(front.knee->prisms), y_of(front.knee->quality), front.knee->prisms, front.knee->quality));
  plot.axes();
  const double decade = std::floor(std::log10(low));
  double last = -1e9;
  for (double power = std::pow(10.0, decade); power <= high; power *= 10)
    for (const double step : {1.0, 2.0, 5.0}) {
      const double at = step * power, x = at >= low && at <= high ? x_of(at) : last;
      if (x < last + 38) continue;
      plot.x_tick(x, at >= 1e6   ? fmt::format("{:g} M", at / 1e6)
                     : at >= 1e3 ? fmt::format("{:g} k", at / 1e3)
                                 : fmt::format("{:g}", at));
      last = x;
    }
  plot.x_label("prisms; line predicted, dots made, large one taken, \u25c7 knee");
  return plot.finish();
}

}  // namespace pcbmesh::view
