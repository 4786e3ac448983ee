// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "pcbmesh/view/paint.hpp"
#include "pcbmesh/view/render.hpp"

namespace pcbmesh::view {

/// '&', '<', '>', '"' and control characters made harmless.
[[nodiscard]] std::string escape_xml(std::string_view text);

struct Legend {
  std::string title;
  std::vector<LegendEntry> entries;  ///< empty for a ramp
  double low = 0, high = 1;          ///< at the ends of the ramp
  std::size_t num_left_out = 0;
};
/// With as many entries as fit beside a picture.
[[nodiscard]] Legend shortened(Legend legend);
[[nodiscard]] Legend legend_of(const Paint& paint, const std::vector<char>& hidden_groups);
/// Width of a legend's panel, pixels.
[[nodiscard]] int legend_width(const Legend& legend);

inline constexpr int svg_title_height = 44;

/// A drawing with title and legend.
class SvgPage {
 public:
  SvgPage(int width, int height, const Background& background);
  void title(std::string_view text);
  void put(std::string_view markup) { text_ += markup; }
  void legend(const Legend& legend, int x, int y);
  [[nodiscard]] std::string finish() { return text_ + "</svg>\n"; }
  /// Colour of text that reads well on the background.
  [[nodiscard]] std::string_view ink() const { return ink_; }

 private:
  std::string text_;
  std::string_view ink_;
};

}  // namespace pcbmesh::view
