// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pcbmesh/mesh/prism_mesh.hpp"
#include "pcbmesh/view/paint.hpp"
#include "pcbmesh/view/skin.hpp"

namespace pcbmesh::view {

/// Where one looks from. Everything shown always fits into the picture at zoom 1.
struct Camera {
  double azimuth_deg = -35;   ///< 0 = from the front (-y), 90 = from the right (+x)
  double elevation_deg = 38;  ///< 90 = from above, -90 = from below
  double zoom = 1;
  std::optional<std::array<double, 2>> target_m{};  ///< centre of the picture; empty = the middle
  bool perspective = true;
};
/// "iso", "top", "bottom", "front", "back", "left", "right". @throws Error usage (101) listing the names.
[[nodiscard]] Camera parse_camera(std::string_view name);

/// Unit vector from the board towards the camera.
[[nodiscard]] std::array<double, 3> direction_of(const Camera& camera);

enum class Edges { fading, on, off };  ///< fading: mesh edges vanish where cells are only a few pixels large

struct Background {
  Rgb top{255, 255, 255}, bottom{232, 238, 244};
  bool transparent = false;
};

struct PictureOptions {
  int width = 1600, height = 1000;  ///< pixels, 16 to 16384
  Camera camera;
  Visibility visibility;
  ColourMode colour = ColourMode::material;
  Edges edges = Edges::fading;
  double explode = 0;  ///< gap between layers, in tenths of the board's larger side
  std::optional<double>
      thickness_scale{};  ///< z stretched; empty = so that the stack is at least a 20th as high as the board is wide
  Background background;
};

/// The stretch of z that a picture uses.
[[nodiscard]] double thickness_scale_of(const mesh::PrismMesh& mesh, const PictureOptions& options);

/// PNG of the visible skin: z-buffer, 2 x 2 samples per pixel, on the CPU alone. The same bytes on every machine.
/// @cost O(visible faces + pixels); memory 32 bytes per pixel. @throws Error usage (101) for a size out of range.
[[nodiscard]] std::string render_png(const mesh::PrismMesh& mesh, const PictureOptions& options);
/// The same picture inside an SVG with title and legend as text.
[[nodiscard]] std::string render_picture_svg(const mesh::PrismMesh& mesh, const PictureOptions& options,
                                             std::string_view title);

struct PlanOptions {
  int width = 1600;
  Visibility visibility;  ///< its mode and section are not used
  ColourMode colour = ColourMode::material;
  bool edges = false;                  ///< mesh edges, all of them
  std::optional<std::string> layer{};  ///< one layer; empty = all, seen from above, nearest last
  Background background;
};
/// Top view as a vector drawing: outlines of every volume group as filled paths in millimetres, y up.
/// @cost O(triangles x slabs). @throws Error name_unknown (304) for a layer that is not there, listing them.
[[nodiscard]] std::string render_plan_svg(const mesh::PrismMesh& mesh, const PlanOptions& options, std::string_view title);

}  // namespace pcbmesh::view
