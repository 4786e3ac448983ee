// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

#include "src/view/canvas.hpp"
#include "src/view/stage.hpp"
#include "src/view/svg.hpp"

namespace pcbmesh::view {

/// A colour with the light that falls on a polygon.
[[nodiscard]] Rgb lit(Rgb colour, const SkinPolygon& polygon);

/// Stage and canvas: polygons of the mesh become pixels.
class Easel {
 public:
  /// @throws Error usage (101) for a size out of range; region_empty (305) if nothing shows.
  Easel(const Shown& shown, const PictureOptions& options);
  [[nodiscard]] Vec3 project(const Vec3& p, std::int32_t storey) const { return stage_.project(stage_.place(p, storey)); }
  /// Seen from outside alone. Its mesh edges are as strong as those of a polygon `parts` times as small.
  void fill(const SkinPolygon& polygon, std::int32_t storey, Rgb colour, int parts);
  /// From either side, before what lies in the same place; empty polygons are left out.
  void fill_both_sides(const SkinPolygon& polygon, std::int32_t storey, Rgb colour);
  [[nodiscard]] std::string png() const;

 private:
  const PictureOptions& options_;
  Stage stage_;
  Canvas canvas_;
};

/// A picture inside an SVG with title and legend as text. @param png  of options' size, transparent where nothing shows.
[[nodiscard]] std::string picture_svg(std::string_view png, const Legend& legend, const PictureOptions& options,
                                      std::string_view title);

}  // namespace pcbmesh::view
