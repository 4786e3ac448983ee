// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pcbmesh/mesh/prism_mesh.hpp"
#include "pcbmesh/view/skin.hpp"

namespace pcbmesh::view {

struct Rgb {
  std::uint8_t r = 0, g = 0, b = 0;
  bool operator==(const Rgb&) const = default;
};
/// "#c8803c".
[[nodiscard]] std::string hex(Rgb colour);
/// `share` of `other` mixed into `colour`; 0 = colour, 1 = other.
[[nodiscard]] Rgb mix(Rgb colour, Rgb other, double share);

enum class ColourMode { material, net, layer, group, face_tag, prism_quality, triangle_quality, size };
[[nodiscard]] std::string_view name_of(ColourMode mode);
/// Inverse of name_of. @throws Error usage (101) listing the names.
[[nodiscard]] ColourMode parse_colour_mode(std::string_view text);
/// "q_p", "longest edge, mm"...: what the colours stand for.
[[nodiscard]] std::string_view title_of(ColourMode mode);
[[nodiscard]] bool is_continuous(ColourMode mode);

/// Colours of the continuous ramp from low to high, evenly spaced; readable for the colour-blind and in grey.
/// @source nine samples of viridis (van der Walt and Smith, CC0).
[[nodiscard]] const std::array<Rgb, 9>& ramp();
/// Colour at x in [0, 1], clamped.
[[nodiscard]] Rgb ramp_at(double x);

struct LegendEntry {
  std::string name;
  Rgb colour;
};

/// Index into face_tags of boundary faces. Memory O(boundary faces).
class BoundaryTags {
 public:
  explicit BoundaryTags(const mesh::PrismMesh& mesh);
  /// -1 where the face has no tag. @cost O(log boundary faces).
  [[nodiscard]] std::int32_t of(const SkinFace& face) const;

 private:
  struct Entry {
    std::array<std::int32_t, 3> key{};
    std::int32_t tag = 0;
  };
  const mesh::PrismMesh* mesh_;
  std::vector<Entry> caps_, walls_;
};

/// Colour of every visible face, by one mode. Keeps the mesh it was made for.
class Paint {
 public:
  Paint(const mesh::PrismMesh& mesh, ColourMode mode);
  [[nodiscard]] ColourMode mode() const { return mode_; }
  /// Before any light falls on it. @cost O(1); face_tag O(log boundary faces).
  /// @param sublayer  of the cell, which prism quality alone asks for; empty = the one at a cap, the lowest of a wall
  [[nodiscard]] Rgb of(const SkinFace& face, std::optional<std::int32_t> sublayer = {}) const;
  /// Colour of an inner tagged face: copper or its net's colour for sheets, a colour of their own for ports; none for what the
  /// mode does not bring out.
  [[nodiscard]] std::optional<Rgb> of_tag(std::int32_t face_tag) const;
  /// Colour of a volume group (continuous modes and face_tag: its material's).
  [[nodiscard]] Rgb of_group(std::int32_t group) const;
  /// Categorical modes: one entry per thing that is not hidden and has cells.
  [[nodiscard]] std::vector<LegendEntry> legend(const std::vector<char>& hidden_groups) const;
  /// Continuous modes: values at the ends of the ramp; size is in millimetres, on a logarithmic scale.
  [[nodiscard]] std::array<double, 2> range() const { return range_; }

 private:
  [[nodiscard]] double value_of(const SkinFace& face, std::int32_t sublayer) const;
  mesh::PrismMesh mesh_;
  ColourMode mode_;
  std::vector<Rgb> groups_;
  std::vector<char> is_mask_, is_conductor_;
  std::vector<BoundaryTags> boundary_;  ///< one, in face_tag mode
  std::array<double, 2> range_{0, 1};
};

/// Metals, and lacquers that one sees through.
[[nodiscard]] bool is_conductor(const board::Material& material);
[[nodiscard]] bool is_mask(const board::Material& material);

/// Colours of things by their place in the mesh's tables.
[[nodiscard]] Rgb material_colour(std::span<const board::Material> materials, std::int32_t material);
[[nodiscard]] Rgb net_colour(std::int32_t net);
[[nodiscard]] Rgb layer_colour(std::int32_t layer, std::size_t num_layers);
[[nodiscard]] Rgb group_colour(std::int32_t group);
/// What belongs to no net stays in the background.
[[nodiscard]] Rgb quiet(Rgb colour);
/// How much of a conductor's colour shines through a film on it.
[[nodiscard]] double film_share(ColourMode mode);
inline constexpr Rgb no_value{150, 156, 163}, port_colour{224, 36, 130}, sheet_colour{205, 127, 60};

/// Light on a face with unit normal n: the same in pictures and on the page. In [0.55, 1].
[[nodiscard]] double light_on(const std::array<double, 3>& normal);

}  // namespace pcbmesh::view
