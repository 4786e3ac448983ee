// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/view/render.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pcbmesh/base/error.hpp"
#include "src/view/canvas.hpp"
#include "src/view/png.hpp"
#include "src/view/stage.hpp"
#include "src/view/svg.hpp"

namespace pcbmesh::view {
namespace {

constexpr int least_pixels = 16, most_pixels = 16384;
constexpr double strongest_edge = 0.5;
/// On-screen size of a cell, pixels: below the first its edges are not drawn, above the second in full.
constexpr double fades_below = 3, full_above = 14;
/// Sub-layers of a wall are told apart where they are at least so many pixels high.
constexpr double least_sublayer_pixels = 3;
constexpr unsigned all_sides = ~0U;

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

/// Draws one face after another.
class Drawing {
 public:
  Drawing(const mesh::PrismMesh& mesh, const PictureOptions& options)
      : mesh_(mesh),
        options_(options),
        stage_(mesh, options),
        paint_(mesh, options.colour),
        canvas_(options.width, options.height) {}

  void draw(const SkinFace& face) {
    const SkinPolygon polygon = polygon_of(mesh_, options_.visibility, face);
    if (polygon.size == 0) return;
    const Rgb colour = mix({0, 0, 0}, paint_.of(face), light_on(normal_of(polygon)));
    std::array<Canvas::Corner, 6> corners;
    for (int i = 0; i < polygon.size; ++i)
      corners[index(i)] = stage_.project(stage_.place(polygon.corners[index(i)], face.slab));
    const auto shown = std::span(corners).first(index(polygon.size));
    const std::int32_t cuts = mesh_.plan().first_sublayer(face.slab + 1) - mesh_.plan().first_sublayer(face.slab);
    const bool is_standing = face.kind == SkinFaceKind::wall && polygon.size == 4;
    if (is_standing && cuts > 1 && options_.edges != Edges::off) {
      const double height = std::abs(corners[3][1] - corners[0][1]);
      if (height / cuts >= least_sublayer_pixels) return draw_cuts(face, polygon, cuts, colour);
    }
    canvas_.fill(shown, colour, edge_strength(options_.edges, area_of(shown) / (is_standing ? cuts : 1)), all_sides);
  }

  [[nodiscard]] std::string png() const {
    return encode_png(options_.width, options_.height, options_.background.transparent ? 4 : 3,
                      canvas_.pixels(options_.background));
  }
  [[nodiscard]] bool is_empty() const { return stage_.is_empty(); }

 private:
  void draw_cuts(const SkinFace& face, const SkinPolygon& whole, std::int32_t cuts, Rgb colour) {
    const auto between = [&](std::size_t low, std::size_t high, double s) {
      Vec3 p{};
      for (std::size_t k = 0; k < 3; ++k) p[k] = whole.corners[low][k] + s * (whole.corners[high][k] - whole.corners[low][k]);
      return stage_.project(stage_.place(p, face.slab));
    };
    for (std::int32_t i = 0; i < cuts; ++i) {
      const double low = static_cast<double>(i) / cuts, high = static_cast<double>(i + 1) / cuts;
      const std::array<Canvas::Corner, 4> c{between(0, 3, low), between(1, 2, low), between(1, 2, high), between(0, 3, high)};
      canvas_.fill(c, colour, edge_strength(options_.edges, area_of(c)), all_sides);
    }
  }

  const mesh::PrismMesh& mesh_;
  const PictureOptions& options_;
  Stage stage_;
  Paint paint_;
  Canvas canvas_;
};

}  // namespace

std::string render_png(const mesh::PrismMesh& mesh, const PictureOptions& options) {
  for (const int side : {options.width, options.height})
    if (side < least_pixels || side > most_pixels)
      throw Error(ErrorCode::usage, fmt::format("a picture of {} x {} pixels: each side must be {} to {}", options.width,
                                                options.height, least_pixels, most_pixels));
  Drawing drawing(mesh, options);
  if (drawing.is_empty())
    throw Error(ErrorCode::region_empty, "nothing is left to draw; hide fewer layers or nets, or move the section plane");
  visit_skin(mesh, options.visibility, [&](std::span<const SkinFace> faces) {
    for (const SkinFace& face : faces) drawing.draw(face);
  });
  return drawing.png();
}

std::string render_picture_svg(const mesh::PrismMesh& mesh, const PictureOptions& options, std::string_view title) {
  PictureOptions clear = options;
  clear.background.transparent = true;
  const Paint paint(mesh, options.colour);
  const Legend legend = legend_of(paint, options.visibility.hidden_groups);
  const int panel = legend_width(legend), top = title.empty() ? 0 : svg_title_height;
  SvgPage page(options.width + panel, options.height + top, options.background);
  page.title(title);
  page.put(fmt::format("<image x=\"0\" y=\"{}\" width=\"{}\" height=\"{}\" href=\"data:image/png;base64,{}\"/>\n", top,
                       options.width, options.height, base64(render_png(mesh, clear))));
  page.legend(legend, options.width, top);
  return page.finish();
}

}  // namespace pcbmesh::view
