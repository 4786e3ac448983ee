// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/view/stage.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "pcbmesh/base/error.hpp"

namespace pcbmesh::view {
namespace {

constexpr double radians = std::numbers::pi / 180;
constexpr double flattest = 20;        ///< board side over stack height that still looks like a stack
constexpr double margin = 0.05;        ///< of the picture, left free on every side
constexpr double half_field_deg = 14;  ///< a long lens: little distortion

std::size_t index(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

double stretch_for(const Shown& shown, const PictureOptions& options) {
  if (options.thickness_scale) return *options.thickness_scale;
  const double side = std::max(shown.max[0] - shown.min[0], shown.max[1] - shown.min[1]);
  const double height = shown.max[2] - shown.min[2];
  return height > 0 ? std::max(1.0, side / flattest / height) : 1.0;
}

std::int32_t layer_of_slab(const mesh::PrismMesh& mesh, std::int32_t slab) {
  for (std::int32_t t = 0; t < mesh.planar().num_triangles(); ++t)
    if (const std::int32_t group = mesh.tag_of(slab, t); group >= 0) return mesh.volume_tags()[index(group)].layer;
  return -1;
}

}  // namespace

Camera parse_camera(std::string_view name) {
  static constexpr std::array<std::pair<std::string_view, std::array<double, 2>>, 7> views{{{"iso", {-35, 38}},
                                                                                            {"top", {0, 90}},
                                                                                            {"bottom", {0, -90}},
                                                                                            {"front", {0, 0}},
                                                                                            {"back", {180, 0}},
                                                                                            {"left", {-90, 0}},
                                                                                            {"right", {90, 0}}}};
  std::vector<std::string_view> names;
  for (const auto& [view, angles] : views) {
    if (view == name) return {angles[0], angles[1], 1, {}, view == "iso"};
    names.push_back(view);
  }
  throw Error(ErrorCode::usage, fmt::format("'{}' is no view; take one of {}", name, fmt::join(names, ", ")));
}

std::array<double, 3> direction_of(const Camera& camera) {
  const double azimuth = camera.azimuth_deg * radians, elevation = camera.elevation_deg * radians;
  return {std::sin(azimuth) * std::cos(elevation), -std::cos(azimuth) * std::cos(elevation), std::sin(elevation)};
}

double thickness_scale_of(const mesh::PrismMesh& mesh, const PictureOptions& options) {
  return stretch_for(shown_of(mesh, options.visibility), options);
}

Shown shown_of(const mesh::PrismMesh& mesh, const Visibility& visibility) {
  Shown shown(index(mesh.plan().num_slabs()));
  visit_skin(mesh, visibility, [&](std::span<const SkinFace> faces) {
    for (const SkinFace& face : faces) {
      const SkinPolygon polygon = polygon_of(mesh, visibility, face);
      for (int i = 0; i < polygon.size; ++i) shown.add(polygon.corners[index(i)]);
      if (polygon.size > 0) shown.layers[index(face.slab)] = 0;
    }
  });
  for (std::int32_t s = 0; s < mesh.plan().num_slabs(); ++s)
    if (shown.layers[index(s)] == 0) shown.layers[index(s)] = layer_of_slab(mesh, s);
  return shown;
}

Stage::Stage(const Shown& shown, const PictureOptions& options) {
  is_empty_ = shown.is_empty();
  lift_.assign(shown.layers.size(), 0.0);
  if (is_empty_) return;
  stretch_ = stretch_for(shown, options);
  const double side = std::max(shown.max[0] - shown.min[0], shown.max[1] - shown.min[1]);
  double lift = 0;
  std::int32_t last_layer = -1;
  for (std::size_t s = 0; s < lift_.size(); ++s) {
    if (shown.layers[s] >= 0) {
      if (last_layer >= 0 && shown.layers[s] != last_layer) lift += options.explode * side / 10;
      last_layer = shown.layers[s];
    }
    lift_[s] = lift;
  }
  const double low = shown.min[2] * stretch_, high = shown.max[2] * stretch_ + lift;
  std::array<Vec3, 8> corners;
  for (std::size_t i = 0; i < 8; ++i)
    corners[i] = {(i & 1) != 0 ? shown.max[0] : shown.min[0], (i & 2) != 0 ? shown.max[1] : shown.min[1],
                  (i & 4) != 0 ? high : low};
  look(options, corners);
}

void Stage::look(const PictureOptions& options, const std::array<Vec3, 8>& corners) {
  const Camera& camera = options.camera;
  const double azimuth = camera.azimuth_deg * radians, elevation = camera.elevation_deg * radians;
  const double ca = std::cos(azimuth), sa = std::sin(azimuth), ce = std::cos(elevation), se = std::sin(elevation);
  right_ = {ca, sa, 0};
  up_ = {-sa * se, ca * se, ce};
  towards_ = direction_of(camera);
  perspective_ = camera.perspective;
  const auto dot = [](const Vec3& p, const Vec3& q) { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; };
  Vec3 middle{};
  for (const Vec3& c : corners)
    for (std::size_t k = 0; k < 3; ++k) middle[k] += c[k] / 8;
  if (camera.target_m) std::tie(middle[0], middle[1]) = std::tie((*camera.target_m)[0], (*camera.target_m)[1]);
  eye_ = {dot(right_, middle), dot(up_, middle), dot(towards_, middle)};
  // Distance from which the sphere around the corners fills the lens; then the picture is scaled to what it really fills.
  double radius = 0;
  for (const Vec3& c : corners) radius = std::max(radius, std::hypot(c[0] - middle[0], c[1] - middle[1], c[2] - middle[2]));
  if (perspective_) eye_[2] += radius / std::sin(half_field_deg * radians);
  scale_ = 1;
  centre_ = {0, 0};
  double left = std::numeric_limits<double>::max(), right = -left, top = left, bottom = -left;
  for (const Vec3& c : corners) {
    const Vec3 at = project(c);
    left = std::min(left, at[0]);
    right = std::max(right, at[0]);
    top = std::min(top, at[1]);
    bottom = std::max(bottom, at[1]);
  }
  const double width = std::max(right - left, 1e-12), height = std::max(bottom - top, 1e-12);
  scale_ = camera.zoom * std::min(options.width * (1 - 2 * margin) / width, options.height * (1 - 2 * margin) / height);
  centre_ = {0.5 * options.width, 0.5 * options.height};
  if (!camera.target_m) {
    centre_[0] -= scale_ * 0.5 * (left + right);
    centre_[1] -= scale_ * 0.5 * (top + bottom);
  }
}

}  // namespace pcbmesh::view
