// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/view/easel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "pcbmesh/base/error.hpp"
#include "src/view/png.hpp"

namespace pcbmesh::view {
namespace {

constexpr int least_pixels = 16, most_pixels = 16384;
constexpr double strongest_edge = 0.5;
/// On-screen size of a cell, pixels: below the first its edges are not drawn, above the second in full.
constexpr double fades_below = 3, full_above = 14;
constexpr unsigned all_sides = ~0U;
constexpr double before_hull = 2e-5;

std::size_t index(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

std::array<double, 3> normal_of(const SkinPolygon& polygon) {
  const auto& p = polygon.corners;
  const std::array<double, 3> u{p[1][0] - p[0][0], p[1][1] - p[0][1], p[1][2] - p[0][2]},
      v{p[2][0] - p[0][0], p[2][1] - p[0][1], p[2][2] - p[0][2]};
  const std::array<double, 3> n{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  const double length = std::hypot(n[0], n[1], n[2]);
  return length > 0 ? std::array{n[0] / length, n[1] / length, n[2] / length} : std::array{0.0, 0.0, 1.0};
}

double edge_strength(Edges edges, double area_pixels) {
  if (edges == Edges::off) return 0;
  if (edges == Edges::on) return strongest_edge;
  const double size = std::sqrt(2 * area_pixels);
  return strongest_edge * std::clamp((size - fades_below) / (full_above - fades_below), 0.0, 1.0);
}

double area_of(std::span<const Canvas::Corner> c) {
  double twice = 0;
  for (std::size_t i = 1; i + 1 < c.size(); ++i)
    twice += (c[i][0] - c[0][0]) * (c[i + 1][1] - c[0][1]) - (c[i + 1][0] - c[0][0]) * (c[i][1] - c[0][1]);
  return std::abs(twice) / 2;
}

/// Checked before the canvas takes its memory.
int checked(int pixels, const PictureOptions& options) {
  if (pixels < least_pixels || pixels > most_pixels)
    throw Error(ErrorCode::usage, fmt::format("a picture of {} x {} pixels: each side must be {} to {}", options.width,
                                              options.height, least_pixels, most_pixels));
  return pixels;
}

}  // namespace

Rgb lit(Rgb colour, const SkinPolygon& polygon) {
  return mix({0, 0, 0}, colour, light_on(normal_of(polygon)));
}

Easel::Easel(const Shown& shown, const PictureOptions& options)
    : options_(options), stage_(shown, options), canvas_(checked(options.width, options), checked(options.height, options)) {
  if (stage_.is_empty())
    throw Error(ErrorCode::region_empty, "nothing is left to draw; hide fewer layers or nets, or move the section plane");
}

void Easel::fill(const SkinPolygon& polygon, std::int32_t storey, Rgb colour, int parts) {
  std::array<Canvas::Corner, 6> corners{};
  for (int i = 0; i < polygon.size; ++i) corners[index(i)] = project(polygon.corners[index(i)], storey);
  const auto shown = std::span(corners).first(index(polygon.size));
  canvas_.fill(shown, colour, edge_strength(options_.edges, area_of(shown) / parts), all_sides);
}

void Easel::fill_both_sides(const SkinPolygon& polygon, std::int32_t storey, Rgb colour) {
  if (polygon.size == 0) return;
  std::array<Canvas::Corner, 6> corners{};
  for (int i = 0; i < polygon.size; ++i) corners[index(i)] = project(polygon.corners[index(i)], storey);
  const auto shown = std::span(corners).first(index(polygon.size));
  const Rgb from_above = mix({0, 0, 0}, colour, light_on({0, 0, 1}));
  for (int side = 0; side < 2; ++side) {
    canvas_.fill(shown, from_above, edge_strength(options_.edges, area_of(shown)), all_sides, before_hull);
    std::reverse(shown.begin(), shown.end());
  }
}

std::string Easel::png() const {
  return encode_png(options_.width, options_.height, options_.background.transparent ? 4 : 3,
                    canvas_.pixels(options_.background));
}

std::string picture_svg(std::string_view png, const Legend& legend, const PictureOptions& options, std::string_view title) {
  const int panel = legend_width(legend), top = title.empty() ? 0 : svg_title_height;
  SvgPage page(options.width + panel, options.height + top, options.background);
  page.title(title);
  page.put(fmt::format("<image x=\"0\" y=\"{}\" width=\"{}\" height=\"{}\" href=\"data:image/png;base64,{}\"/>\n", top,
                       options.width, options.height, base64(png)));
  page.legend(legend, options.width, top);
  return page.finish();
}

}  // namespace pcbmesh::view
