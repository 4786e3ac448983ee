// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/view/canvas.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcbmesh::view {
namespace {

constexpr std::size_t most_corners = 6;
constexpr double samples = 2;            ///< per pixel, each way
constexpr double edge_half_width = 0.9;  ///< in samples
constexpr std::uint32_t drawn = 0xff000000U;

std::uint32_t packed(Rgb c) {
  return drawn | static_cast<std::uint32_t>(c.r) << 16 | static_cast<std::uint32_t>(c.g) << 8 | c.b;
}

/// Signed distance from a line in samples, positive inside: dx x + dy y + c.
struct HalfPlane {
  double dx = 0, dy = 0, c = 0;
};

}  // namespace

Canvas::Canvas(int width, int height)
    : width_(width * static_cast<int>(samples)),
      height_(height * static_cast<int>(samples)),
      nearness_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), -std::numeric_limits<float>::max()),
      colours_(nearness_.size(), 0) {}

void Canvas::fill(std::span<const Corner> corners, Rgb colour, double edge_strength, unsigned sides) {
  const std::size_t size = std::min(corners.size(), most_corners);
  std::array<Corner, most_corners> at{};
  double twice_area = 0, top = std::numeric_limits<double>::max(), bottom = -top;
  for (std::size_t i = 0; i < size; ++i) {
    at[i] = {corners[i][0] * samples - 0.5, corners[i][1] * samples - 0.5, corners[i][2]};
    top = std::min(top, at[i][1]);
    bottom = std::max(bottom, at[i][1]);
  }
  for (std::size_t i = 1; i + 1 < size; ++i)
    twice_area += (at[i][0] - at[0][0]) * (at[i + 1][1] - at[0][1]) - (at[i + 1][0] - at[0][0]) * (at[i][1] - at[0][1]);
  // y points down, so what runs counter-clockwise in space has a negative area here.
  if (!(twice_area < 0) || bottom < 0 || top > height_ - 1) return;

  std::array<HalfPlane, most_corners> lines{};
  for (std::size_t i = 0; i < size; ++i) {
    const Corner &p = at[i], &q = at[(i + 1) % size];
    const double x = q[0] - p[0], y = q[1] - p[1], length = std::hypot(x, y);
    const double scale = length > 0 ? 1 / length : 0;
    lines[i] = {y * scale, -x * scale, (x * p[1] - y * p[0]) * scale};
  }
  // Nearness is a plane over the picture; it is taken from the largest triangle of the fan, so that slivers can't spoil it.
  double slope_x = 0, slope_y = 0, largest = 0;
  for (std::size_t i = 1; i + 1 < size; ++i) {
    const double ux = at[i][0] - at[0][0], uy = at[i][1] - at[0][1], un = at[i][2] - at[0][2];
    const double vx = at[i + 1][0] - at[0][0], vy = at[i + 1][1] - at[0][1], vn = at[i + 1][2] - at[0][2];
    const double det = ux * vy - vx * uy;
    if (std::abs(det) <= largest) continue;
    largest = std::abs(det);
    slope_x = (un * vy - vn * uy) / det;
    slope_y = (ux * vn - vx * un) / det;
  }
  const std::uint32_t plain = packed(colour), edge = packed(mix(colour, {22, 26, 32}, edge_strength));
  const bool has_edges = edge_strength > 0.02 && sides != 0;
  const int first_row = std::max(0, static_cast<int>(std::ceil(top))),
            last_row = std::min(height_ - 1, static_cast<int>(std::floor(bottom)));
  for (int row = first_row; row <= last_row; ++row) {
    double left = 0, right = width_ - 1;
    for (std::size_t i = 0; i < size; ++i) {
      const double rest = lines[i].dy * row + lines[i].c;
      if (lines[i].dx > 0)
        left = std::max(left, -rest / lines[i].dx);
      else if (lines[i].dx < 0)
        right = std::min(right, -rest / lines[i].dx);
      else if (rest < 0)
        right = -1;
    }
    const int first = static_cast<int>(std::ceil(left)), last = static_cast<int>(std::floor(right));
    const std::size_t line = static_cast<std::size_t>(row) * static_cast<std::size_t>(width_);
    for (int x = first; x <= last; ++x) {
      const auto nearness = static_cast<float>(at[0][2] + slope_x * (x - at[0][0]) + slope_y * (row - at[0][1]));
      const std::size_t sample = line + static_cast<std::size_t>(x);
      if (!(nearness > nearness_[sample])) continue;
      nearness_[sample] = nearness;
      bool on_edge = false;
      for (std::size_t i = 0; has_edges && i < size; ++i)
        on_edge = on_edge || ((sides >> i & 1U) != 0 && lines[i].dx * x + lines[i].dy * row + lines[i].c < edge_half_width);
      colours_[sample] = on_edge ? edge : plain;
    }
  }
}

std::vector<std::uint8_t> Canvas::pixels(const Background& background) const {
  const int width = width_ / 2, height = height_ / 2;
  const std::size_t channels = background.transparent ? 4 : 3;
  std::vector<std::uint8_t> out(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * channels);
  std::uint8_t* to = out.data();
  for (int y = 0; y < height; ++y) {
    const Rgb behind = mix(background.top, background.bottom, height > 1 ? y / (height - 1.0) : 0.0);
    for (int x = 0; x < width; ++x) {
      std::uint32_t r = 0, g = 0, b = 0, count = 0;
      for (int k = 0; k < 4; ++k) {
        const auto sample = static_cast<std::size_t>(2 * y + k / 2) * static_cast<std::size_t>(width_) +
                            static_cast<std::size_t>(2 * x + k % 2);
        const std::uint32_t c = colours_[sample];
        if (c == 0 && background.transparent) continue;
        ++count;
        r += c == 0 ? behind.r : c >> 16 & 0xff;
        g += c == 0 ? behind.g : c >> 8 & 0xff;
        b += c == 0 ? behind.b : c & 0xff;
      }
      const std::uint32_t half = count / 2, by = std::max(1U, count);
      *to++ = static_cast<std::uint8_t>((r + half) / by);
      *to++ = static_cast<std::uint8_t>((g + half) / by);
      *to++ = static_cast<std::uint8_t>((b + half) / by);
      if (background.transparent) *to++ = static_cast<std::uint8_t>(count * 255 / 4);
    }
  }
  return out;
}

}  // namespace pcbmesh::view
