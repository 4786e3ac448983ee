// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pcbmesh/view/cell_mesh.hpp"
#include "pcbmesh/view/paint.hpp"
#include "pcbmesh/view/render.hpp"

namespace pcbmesh::view {

/// The colour modes a cell mesh has an answer for: groups, tags, quality and size always (face tags if there are any),
/// material, net and layer if the groups' names tell them. Triangle quality belongs to columns, which cells do not have.
[[nodiscard]] std::vector<ColourMode> colour_modes_of(const CellMesh& mesh);
/// "Quality: q_p of prisms, mean ratio of tetrahedra"...
[[nodiscard]] std::string title_of(const CellMesh& mesh, ColourMode mode);

/// Where a cell of a see-through film lies on a conductor.
class Films {
 public:
  explicit Films(const CellMesh& mesh);
  /// Volume group of the conductor that shines through, -1 = none. @cost O(log cells on films).
  [[nodiscard]] std::int32_t behind(std::int64_t cell) const;

 private:
  std::vector<std::pair<std::int64_t, std::int32_t>> behind_;
};

/// Colours of a cell mesh, as Paint has them for prism meshes. Refers to the mesh.
class CellPaint {
 public:
  /// @throws Error usage (101) for a mode that is not among colour_modes_of().
  CellPaint(const CellMesh& mesh, ColourMode mode);
  [[nodiscard]] ColourMode mode() const { return mode_; }
  /// Before any light falls on it.
  [[nodiscard]] Rgb of(const CellSkinFace& face) const;
  /// Of sheets and ports between cells; none for what the mode does not bring out.
  [[nodiscard]] std::optional<Rgb> of_tag(std::int32_t face_tag) const;
  [[nodiscard]] Rgb of_group(std::int32_t group) const { return groups_[static_cast<std::size_t>(group)]; }
  [[nodiscard]] std::vector<LegendEntry> legend(const std::vector<char>& hidden_groups) const;
  /// Continuous modes: values at the ends of the ramp; size: longest edge of the face in millimetres, logarithmic.
  [[nodiscard]] std::array<double, 2> range() const { return range_; }

 private:
  const CellMesh& mesh_;
  ColourMode mode_;
  std::vector<Rgb> groups_;
  Films films_;
  std::array<double, 2> range_{0, 1};
};

/// render_png() and render_picture_svg() of a cell mesh. Hidden groups are indices into CellMesh::groups(); the box of the
/// visibility is not used: a CellMesh has its own. Layers set apart are its bands.
/// @cost O(faces of the mesh + pixels), with a section O(cells).
[[nodiscard]] std::string render_png(const CellMesh& mesh, const PictureOptions& options);
[[nodiscard]] std::string render_picture_svg(const CellMesh& mesh, const PictureOptions& options, std::string_view title);

}  // namespace pcbmesh::view
