// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/view/svg.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace pcbmesh::view {
namespace {

constexpr std::size_t most_entries = 24;
constexpr int row_height = 26, swatch = 14, letter_width = 8, ramp_height = 220;

bool is_dark(Rgb c) {
  return 299 * c.r + 587 * c.g + 114 * c.b < 128'000;
}

}  // namespace

std::string escape_xml(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
    }
  }
  return out;
}

Legend shortened(Legend legend) {
  if (legend.entries.size() > most_entries) {
    legend.num_left_out = legend.entries.size() - most_entries;
    legend.entries.resize(most_entries);
  }
  return legend;
}

Legend legend_of(const Paint& paint, const std::vector<char>& hidden_groups) {
  return shortened({std::string(title_of(paint.mode())), paint.legend(hidden_groups), paint.range()[0], paint.range()[1], 0});
}

int legend_width(const Legend& legend) {
  std::size_t longest = legend.title.size();
  for (const LegendEntry& e : legend.entries) longest = std::max(longest, e.name.size() + 3);
  return 40 + letter_width * static_cast<int>(std::min<std::size_t>(longest, 44));
}

SvgPage::SvgPage(int width, int height, const Background& background)
    : ink_(!background.transparent && is_dark(background.top) ? "#e6e9ed" : "#1d2733") {
  text_ = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
      "font-family=\"system-ui, sans-serif\" font-size=\"15\" fill=\"{2}\">\n",
      width, height, ink_);
  if (!background.transparent)
    text_ += fmt::format(
        "<defs><linearGradient id=\"sky\" x2=\"0\" y2=\"1\"><stop stop-color=\"{}\"/><stop offset=\"1\" "
        "stop-color=\"{}\"/></linearGradient></defs><rect width=\"100%\" height=\"100%\" fill=\"url(#sky)\"/>\n",
        hex(background.top), hex(background.bottom));
}

void SvgPage::title(std::string_view text) {
  if (text.empty()) return;
  text_ += fmt::format("<title>{0}</title>\n<text x=\"20\" y=\"30\" font-size=\"18\" font-weight=\"600\">{0}</text>\n",
                       escape_xml(text));
}

void SvgPage::legend(const Legend& legend, int x, int y) {
  text_ += fmt::format("<g transform=\"translate({} {})\">\n<text y=\"30\" font-weight=\"600\">{}</text>\n", x, y,
                       escape_xml(legend.title));
  if (legend.entries.empty()) {
    text_ += "<defs><linearGradient id=\"ramp\" x2=\"0\" y1=\"1\" y2=\"0\">";
    for (std::size_t i = 0; i < ramp().size(); ++i)
      text_ += fmt::format("<stop offset=\"{}\" stop-color=\"{}\"/>",
                           static_cast<double>(i) / static_cast<double>(ramp().size() - 1), hex(ramp()[i]));
    text_ += fmt::format(
        "</linearGradient></defs>\n<rect y=\"46\" width=\"{0}\" height=\"{1}\" fill=\"url(#ramp)\"/>\n"
        "<text x=\"{2}\" y=\"58\">{3:.3g}</text><text x=\"{2}\" y=\"{4}\">{5:.3g}</text>\n",
        swatch + 4, ramp_height, swatch + 12, legend.high, 46 + ramp_height, legend.low);
  }
  int row = 46;
  for (const LegendEntry& e : legend.entries) {
    text_ += fmt::format("<rect y=\"{}\" width=\"{}\" height=\"{}\" rx=\"3\" fill=\"{}\"/><text x=\"{}\" y=\"{}\">{}</text>\n",
                         row, swatch, swatch, hex(e.colour), swatch + 9, row + 12, escape_xml(e.name));
    row += row_height;
  }
  if (legend.num_left_out > 0) text_ += fmt::format("<text y=\"{}\">and {} more</text>\n", row + 12, legend.num_left_out);
  text_ += "</g>\n";
}

}  // namespace pcbmesh::view
