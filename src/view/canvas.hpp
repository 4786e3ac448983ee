// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "pcbmesh/view/render.hpp"

namespace pcbmesh::view {

/// Picture with depth, 2 x 2 samples per pixel.
class Canvas {
 public:
  Canvas(int width, int height);

  /// Corner on the picture: pixels, and nearness (greater = nearer).
  using Corner = std::array<double, 3>;
  /// Fills a convex polygon that runs counter-clockwise on a picture with y down; others face away and are left out.
  /// @param edge_strength  0 to 1: how dark its sides are drawn. `sides`: bit i = side from corner i is drawn.
  void fill(std::span<const Corner> corners, Rgb colour, double edge_strength, unsigned sides);

  /// Averaged pixels over a background, RGB or RGBA.
  [[nodiscard]] std::vector<std::uint8_t> pixels(const Background& background) const;

 private:
  int width_, height_;  ///< in samples
  std::vector<float> nearness_;
  std::vector<std::uint32_t> colours_;  ///< 0 = nothing there; else 0xff000000 | rgb
};

}  // namespace pcbmesh::view
