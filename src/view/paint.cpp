// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/view/paint.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/layering/prism_quality.hpp"

namespace pcbmesh::view {
namespace {

constexpr std::array<std::string_view, 8> mode_names{"material", "net", "layer", "group", "tag", "q_p", "q_t", "size"};
constexpr std::array<std::string_view, 8> mode_titles{
    "Material", "Net", "Layer", "Volume group", "Face tag", "Prism quality q_p", "Triangle quality q_t", "Longest edge, mm"};
constexpr double copper_like_s_per_m = 1e5;
constexpr double golden_angle = 0.38196601125;

std::size_t index(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

Rgb from_hsl(double hue, double saturation, double lightness) {
  const double chroma = (1 - std::abs(2 * lightness - 1)) * saturation;
  const auto channel = [&](double shift) {
    const double k = std::fmod(hue * 6 + shift, 6.0);
    const double part = std::clamp(std::min(k, 4 - k), 0.0, 1.0);
    return static_cast<std::uint8_t>(std::lround(255 * (lightness - chroma / 2 + chroma * part)));
  };
  return {channel(2), channel(0), channel(4)};
}

bool contains(std::string_view text, std::string_view part) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  return std::search(text.begin(), text.end(), part.begin(), part.end(), [&](char a, char b) { return lower(a) == b; }) !=
         text.end();
}

double longest_edge_mm(const mesh::PlanarMesh& planar, std::int32_t t) {
  const auto squared = planar.squared_edges_m2(t);
  return 1e3 * std::sqrt(std::max({squared[0], squared[1], squared[2]}));
}

}  // namespace

bool is_conductor(const board::Material& material) {
  return material.sigma_s_per_m > copper_like_s_per_m;
}

bool is_mask(const board::Material& material) {
  return !is_conductor(material) && (contains(material.name, "mask") || contains(material.name, "resist"));
}

std::string hex(Rgb c) {
  return fmt::format("#{:02x}{:02x}{:02x}", c.r, c.g, c.b);
}

Rgb mix(Rgb colour, Rgb other, double share) {
  const auto blend = [&](std::uint8_t a, std::uint8_t b) {
    return static_cast<std::uint8_t>(std::lround(a + share * (b - static_cast<double>(a))));
  };
  return {blend(colour.r, other.r), blend(colour.g, other.g), blend(colour.b, other.b)};
}

std::string_view name_of(ColourMode mode) {
  return mode_names[static_cast<std::size_t>(mode)];
}

std::string_view title_of(ColourMode mode) {
  return mode_titles[static_cast<std::size_t>(mode)];
}

ColourMode parse_colour_mode(std::string_view text) {
  for (std::size_t i = 0; i < mode_names.size(); ++i)
    if (mode_names[i] == text) return static_cast<ColourMode>(i);
  throw Error(ErrorCode::usage, fmt::format("'{}' is no colour mode; take one of {}", text, fmt::join(mode_names, ", ")));
}

bool is_continuous(ColourMode mode) {
  return mode == ColourMode::prism_quality || mode == ColourMode::triangle_quality || mode == ColourMode::size;
}

const std::array<Rgb, 9>& ramp() {
  static constexpr std::array<Rgb, 9> colours{{{68, 1, 84},
                                               {71, 44, 122},
                                               {59, 81, 139},
                                               {44, 113, 142},
                                               {33, 144, 141},
                                               {39, 173, 129},
                                               {92, 200, 99},
                                               {170, 220, 50},
                                               {253, 231, 37}}};
  return colours;
}

Rgb ramp_at(double x) {
  const double at = std::clamp(x, 0.0, 1.0) * static_cast<double>(ramp().size() - 1);
  const auto i = std::min(static_cast<std::size_t>(at), ramp().size() - 2);
  return mix(ramp()[i], ramp()[i + 1], at - static_cast<double>(i));
}

Rgb material_colour(std::span<const board::Material> materials, std::int32_t material) {
  const board::Material& m = materials[index(material)];
  if (is_conductor(m)) return contains(m.name, "gold") ? Rgb{222, 178, 60} : Rgb{205, 127, 60};
  if (is_mask(m)) return {32, 112, 72};
  if (m.eps_r == 1 && m.tan_delta == 0) return {186, 214, 235};
  // Laminates: quiet neighbours of one another, told apart by hue.
  static constexpr std::array<Rgb, 6> laminates{
      {{201, 186, 126}, {158, 172, 140}, {214, 196, 160}, {150, 170, 190}, {190, 160, 180}, {170, 190, 160}}};
  std::size_t rank = 0;
  for (std::int32_t i = 0; i < material; ++i) {
    const board::Material& other = materials[index(i)];
    if (!is_conductor(other) && !is_mask(other) && !(other.eps_r == 1 && other.tan_delta == 0)) ++rank;
  }
  return laminates[rank % laminates.size()];
}

Rgb net_colour(std::int32_t net) {
  if (net < 0) return {176, 170, 160};
  const double turn = std::fmod(0.57 + golden_angle * net, 1.0);
  return from_hsl(turn, 0.52, net % 3 == 0 ? 0.52 : net % 3 == 1 ? 0.62 : 0.44);
}

Rgb layer_colour(std::int32_t layer, std::size_t num_layers) {
  const double turn = num_layers < 2 ? 0.6 : 0.72 * layer / static_cast<double>(num_layers - 1);
  return from_hsl(0.03 + turn, 0.55, layer % 2 == 0 ? 0.52 : 0.62);
}

Rgb group_colour(std::int32_t group) {
  return from_hsl(std::fmod(0.55 + golden_angle * group, 1.0), 0.5, 0.56);
}

Rgb quiet(Rgb colour) {
  return mix(colour, Rgb{205, 208, 212}, 0.7);
}

double film_share(ColourMode mode) {
  return mode == ColourMode::net ? 0.75 : 0.5;
}

double light_on(const std::array<double, 3>& n) {
  // One lamp from above and the side: caps bright, walls told apart by their direction, undersides still readable.
  const double lamp = 0.34 * n[0] - 0.52 * n[1] + 0.78 * n[2];
  return std::clamp(0.74 + 0.30 * lamp, 0.55, 1.0);
}

BoundaryTags::BoundaryTags(const mesh::PrismMesh& mesh) : mesh_(&mesh) {
  for (const mesh::Cap& cap : mesh.caps()) caps_.push_back({{cap.level, cap.triangle, cap.up ? 1 : 0}, cap.tag});
  for (const mesh::Wall& wall : mesh.walls()) walls_.push_back({{wall.slab, wall.a, wall.b}, wall.tag});
  const auto by_key = [](const Entry& p, const Entry& q) { return std::tie(p.key, p.tag) < std::tie(q.key, q.tag); };
  std::sort(caps_.begin(), caps_.end(), by_key);
  std::sort(walls_.begin(), walls_.end(), by_key);
}

std::int32_t BoundaryTags::of(const SkinFace& face) const {
  if (face.kind == SkinFaceKind::section) return -1;
  const bool is_wall = face.kind == SkinFaceKind::wall, is_up = face.kind == SkinFaceKind::up;
  const std::array<std::int32_t, 3> key =
      is_wall ? std::array{face.slab, face.a, face.b}
              : std::array{mesh_->plan().first_sublayer(face.slab + (is_up ? 1 : 0)), face.triangle, is_up ? 1 : 0};
  const std::vector<Entry>& entries = is_wall ? walls_ : caps_;
  const auto found =
      std::lower_bound(entries.begin(), entries.end(), key, [](const Entry& e, const auto& k) { return e.key < k; });
  return found != entries.end() && found->key == key ? found->tag : -1;
}

Paint::Paint(const mesh::PrismMesh& mesh, ColourMode mode) : mesh_(mesh), mode_(mode) {
  for (std::size_t i = 0; i < mesh.volume_tags().size(); ++i) {
    const mesh::VolumeTag& tag = mesh.volume_tags()[i];
    const board::Material& material = mesh.materials()[index(tag.material)];
    is_mask_.push_back(is_mask(material) ? 1 : 0);
    is_conductor_.push_back(is_conductor(material) ? 1 : 0);
    switch (mode) {
      case ColourMode::net:
        groups_.push_back(tag.net >= 0 ? net_colour(tag.net) : quiet(material_colour(mesh.materials(), tag.material)));
        break;
      case ColourMode::layer:
        groups_.push_back(layer_colour(tag.layer, mesh.layers().size()));
        break;
      case ColourMode::group:
        groups_.push_back(group_colour(static_cast<std::int32_t>(i)));
        break;
      default:
        groups_.push_back(material_colour(mesh.materials(), tag.material));
    }
  }
  if (mode == ColourMode::face_tag) boundary_.emplace_back(mesh_);
  if (mode == ColourMode::size) {
    range_ = {std::numeric_limits<double>::max(), 0};
    for (std::int32_t t = 0; t < mesh.planar().num_triangles(); ++t) {
      const double edge = longest_edge_mm(mesh.planar(), t);
      range_ = {std::min(range_[0], edge), std::max(range_[1], edge)};
    }
  }
}

double Paint::value_of(const SkinFace& face, std::int32_t sublayer) const {
  if (mode_ == ColourMode::size) return longest_edge_mm(mesh_.planar(), face.triangle);
  const auto squared = mesh_.planar().squared_edges_m2(face.triangle);
  const double area = mesh_.planar().area_m2(face.triangle), beta = squared[0] + squared[1] + squared[2];
  if (mode_ == ColourMode::triangle_quality) return layering::triangle_quality(area, beta);
  return layering::prism_quality(area, beta, mesh_.plan().height_m(sublayer));
}

Rgb Paint::of(const SkinFace& face, std::optional<std::int32_t> sublayer) const {
  if (is_continuous(mode_)) {
    const mesh::LayerPlan& plan = mesh_.plan();
    const std::int32_t at_face =
        face.kind == SkinFaceKind::up ? plan.first_sublayer(face.slab + 1) - 1 : plan.first_sublayer(face.slab);
    const double value = value_of(face, sublayer.value_or(at_face));
    if (mode_ != ColourMode::size) return ramp_at((value - range_[0]) / (range_[1] - range_[0]));
    return ramp_at(range_[1] > range_[0] ? std::log(value / range_[0]) / std::log(range_[1] / range_[0]) : 0.5);
  }
  if (mode_ == ColourMode::face_tag) {
    const std::int32_t tag = boundary_.front().of(face);
    return tag < 0 ? no_value : group_colour(tag);
  }
  const Rgb own = groups_[index(face.group)];
  if (is_mask_[index(face.group)] == 0) return own;
  // A mask is a film: what lies behind it shines through.
  const std::int32_t behind = face.kind == SkinFaceKind::up     ? face.slab - 1
                              : face.kind == SkinFaceKind::down ? face.slab + 1
                                                                : -1;
  if (behind < 0 || behind >= mesh_.plan().num_slabs()) return own;
  const std::int32_t group = mesh_.tag_of(behind, face.triangle);
  if (group < 0) return own;
  return is_conductor_[index(group)] != 0 ? mix(own, groups_[index(group)], film_share(mode_)) : own;
}

std::optional<Rgb> Paint::of_tag(std::int32_t face_tag) const {
  const mesh::FaceTag& tag = mesh_.face_tags()[index(face_tag)];
  if (mode_ == ColourMode::face_tag) return group_colour(face_tag);
  if (tag.kind == mesh::FaceTagKind::port || tag.kind == mesh::FaceTagKind::wave_port) return port_colour;
  if (tag.kind != mesh::FaceTagKind::sheet || is_continuous(mode_)) return {};
  return mode_ == ColourMode::net ? net_colour(tag.net) : sheet_colour;
}

Rgb Paint::of_group(std::int32_t group) const {
  return groups_[index(group)];
}

std::vector<LegendEntry> Paint::legend(const std::vector<char>& hidden_groups) const {
  std::vector<LegendEntry> out;
  if (is_continuous(mode_)) return out;
  if (mode_ == ColourMode::face_tag) {
    for (std::size_t i = 0; i < mesh_.face_tags().size(); ++i)
      out.push_back({mesh_.face_tags()[i].name, group_colour(static_cast<std::int32_t>(i))});
    out.push_back({"no tag", no_value});
    return out;
  }
  for (std::size_t i = 0; i < mesh_.volume_tags().size(); ++i) {
    if (!hidden_groups.empty() && hidden_groups[i] != 0) continue;
    const mesh::VolumeTag& tag = mesh_.volume_tags()[i];
    std::string name;
    switch (mode_) {
      case ColourMode::net:
        name = tag.net >= 0 ? mesh_.nets()[index(tag.net)] : "no net";
        break;
      case ColourMode::layer:
        name = mesh_.layers()[index(tag.layer)];
        break;
      case ColourMode::group:
        name = tag.name;
        break;
      default:
        name = mesh_.materials()[index(tag.material)].name;
    }
    if (std::none_of(out.begin(), out.end(), [&](const LegendEntry& e) { return e.name == name; }))
      out.push_back({std::move(name), groups_[i]});
  }
  for (std::size_t i = 0; i < mesh_.face_tags().size(); ++i) {
    const mesh::FaceTag& tag = mesh_.face_tags()[i];
    const std::optional<Rgb> colour = of_tag(static_cast<std::int32_t>(i));
    if (tag.is_inner && colour) out.push_back({tag.name, *colour});
  }
  return out;
}

}  // namespace pcbmesh::view
