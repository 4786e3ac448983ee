// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/view/cell_render.hpp"

#include <algorithm>

#include "src/view/easel.hpp"

namespace pcbmesh::view {
namespace {

std::size_t index(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

Shown shown_of(const CellMesh& mesh, const Visibility& visibility) {
  Shown shown(index(mesh.num_bands()));
  visit_cell_skin(mesh, visibility, [&](const CellSkinFace& face) {
    for (int i = 0; i < face.polygon.size; ++i) shown.add(face.polygon.corners[index(i)]);
    const std::int32_t band = mesh.groups()[index(face.group)].band;
    shown.layers[index(band)] = band;
  });
  return shown;
}

}  // namespace

std::string render_png(const CellMesh& mesh, const PictureOptions& options) {
  Easel easel(shown_of(mesh, options.visibility), options);
  const CellPaint paint(mesh, options.colour);
  const auto band_of = [&](const CellSkinFace& face) { return mesh.groups()[index(face.group)].band; };
  visit_cell_skin(mesh, options.visibility, [&](const CellSkinFace& face) {
    easel.fill(face.polygon, band_of(face), lit(paint.of(face), face.polygon), 1);
  });
  visit_inner_cell_faces(mesh, options.visibility, [&](const CellSkinFace& face) {
    if (const std::optional<Rgb> colour = paint.of_tag(face.tag)) easel.fill_both_sides(face.polygon, band_of(face), *colour);
  });
  return easel.png();
}

std::string render_picture_svg(const CellMesh& mesh, const PictureOptions& options, std::string_view title) {
  PictureOptions clear = options;
  clear.background.transparent = true;
  const CellPaint paint(mesh, options.colour);
  return picture_svg(render_png(mesh, clear),
                     shortened({title_of(mesh, options.colour), paint.legend(options.visibility.hidden_groups),
                                paint.range()[0], paint.range()[1], 0}),
                     options, title);
}

}  // namespace pcbmesh::view
