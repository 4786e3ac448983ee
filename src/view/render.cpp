// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/view/render.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "src/view/easel.hpp"
#include "src/view/svg.hpp"

namespace pcbmesh::view {
namespace {

/// Sub-layers of a wall are told apart where they are at least so many pixels high.
constexpr double least_sublayer_pixels = 3;

/// Draws one face after another.
class Drawing {
 public:
  Drawing(const mesh::PrismMesh& mesh, const PictureOptions& options)
      : mesh_(mesh), options_(options), easel_(shown_of(mesh, options.visibility), options), paint_(mesh, options.colour) {}

  void draw(const SkinFace& face) {
    const SkinPolygon polygon = polygon_of(mesh_, options_.visibility, face);
    if (polygon.size == 0) return;
    const std::int32_t cuts = mesh_.plan().first_sublayer(face.slab + 1) - mesh_.plan().first_sublayer(face.slab);
    const bool is_upright = face.kind == SkinFaceKind::wall || (face.kind == SkinFaceKind::section && section_axis() != 2);
    if (is_upright && cuts > 1 && polygon.size == 4 && shows_cuts(face, polygon, cuts)) return draw_cuts(face, polygon);
    const std::optional<std::int32_t> sublayer =
        face.kind == SkinFaceKind::section && !is_upright ? std::optional(sublayer_of_section(face.slab)) : std::nullopt;
    easel_.fill(polygon, face.slab, lit(paint_.of(face, sublayer), polygon), is_upright ? cuts : 1);
  }

  /// Tagged faces inside, seen from both sides, before a hull that lies in the same place.
  void draw(const TaggedFace& tagged) {
    const std::optional<Rgb> colour = paint_.of_tag(tagged.tag);
    if (!colour) return;
    easel_.fill_both_sides(polygon_of(mesh_, options_.visibility, tagged.face), tagged.face.slab, *colour);
  }

  [[nodiscard]] std::string png() const { return easel_.png(); }

 private:
  [[nodiscard]] int section_axis() const { return options_.visibility.section ? options_.visibility.section->axis : -1; }
  [[nodiscard]] std::int32_t sublayer_of_section(std::int32_t slab) const {
    const mesh::LayerPlan& plan = mesh_.plan();
    std::int32_t k = plan.first_sublayer(slab);
    while (k + 1 < plan.first_sublayer(slab + 1) &&
           plan.z_m()[static_cast<std::size_t>(k) + 1] < options_.visibility.section->at_m)
      ++k;
    return k;
  }
  /// Sub-layers are told apart where they can be, and where each has a colour of its own.
  [[nodiscard]] bool shows_cuts(const SkinFace& face, const SkinPolygon& polygon, std::int32_t cuts) const {
    if (paint_.mode() == ColourMode::prism_quality) return true;
    if (options_.edges == Edges::off) return false;
    const double height =
        std::abs(easel_.project(polygon.corners[3], face.slab)[1] - easel_.project(polygon.corners[0], face.slab)[1]);
    return height / cuts >= least_sublayer_pixels;
  }
  void draw_cuts(const SkinFace& face, SkinPolygon whole) {
    // A plane across z may have left the corners in another order: lower two first.
    const double middle = (whole.corners[0][2] + whole.corners[1][2] + whole.corners[2][2] + whole.corners[3][2]) / 4;
    for (int turn = 0; turn < 3 && (whole.corners[0][2] > middle || whole.corners[1][2] > middle); ++turn)
      std::rotate(whole.corners.begin(), whole.corners.begin() + 1, whole.corners.begin() + 4);
    const mesh::LayerPlan& plan = mesh_.plan();
    for (std::int32_t k = plan.first_sublayer(face.slab); k < plan.first_sublayer(face.slab + 1); ++k) {
      SkinPolygon part = whole;
      part.corners[0][2] = part.corners[1][2] = plan.z_m()[static_cast<std::size_t>(k)];
      part.corners[2][2] = part.corners[3][2] = plan.z_m()[static_cast<std::size_t>(k) + 1];
      // What a plane across z has left of the wall.
      for (std::array<double, 3>& corner : part.corners)
        corner[2] = std::clamp(corner[2], whole.corners[0][2], whole.corners[2][2]);
      if (part.corners[0][2] < part.corners[2][2]) easel_.fill(part, face.slab, lit(paint_.of(face, k), part), 1);
    }
  }

  const mesh::PrismMesh& mesh_;
  const PictureOptions& options_;
  Easel easel_;
  Paint paint_;
};

}  // namespace

std::string render_png(const mesh::PrismMesh& mesh, const PictureOptions& options) {
  Drawing drawing(mesh, options);
  visit_skin(mesh, options.visibility, [&](std::span<const SkinFace> faces) {
    for (const SkinFace& face : faces) drawing.draw(face);
  });
  visit_inner_faces(mesh, options.visibility, [&](const TaggedFace& face) { drawing.draw(face); });
  return drawing.png();
}

std::string render_picture_svg(const mesh::PrismMesh& mesh, const PictureOptions& options, std::string_view title) {
  PictureOptions clear = options;
  clear.background.transparent = true;
  return picture_svg(render_png(mesh, clear), legend_of(Paint(mesh, options.colour), options.visibility.hidden_groups), options,
                     title);
}

}  // namespace pcbmesh::view
