// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

namespace pcbmesh::validation {

enum class FindingSeverity { warning, error };

/// A bound, and how bad it is to miss it.
struct Limit {
  double value = 0;
  FindingSeverity severity = FindingSeverity::error;
};

/// Bounds on the shape of cells: what one user's solver bears is no matter of right or wrong, so none is set by default.
struct Limits {
  std::optional<Limit> min_face_angle_deg;  ///< needles: smallest angle in any face of a cell
  std::optional<Limit> min_dihedral_deg;    ///< slivers: smallest angle between two faces of a cell
  std::optional<Limit> max_dihedral_deg;    ///< caps: largest angle between two faces of a cell
  std::optional<Limit> max_aspect_ratio;    ///< longest over shortest edge of a cell
  std::optional<Limit> max_height_growth;   ///< of prisms and hexahedra that share a face: larger over smaller height over it
  std::optional<Limit> min_edge_m;          ///< shortest edge
  std::optional<Limit> max_warp;            ///< distance of a quadrangle's diagonals over the longer of them; 1e-3 if not given
  std::optional<Limit> min_scaled_jacobian;  ///< smallest over the corners, 1 = right angles or regular
  std::optional<Limit> min_prism_quality;    ///< q_p of wedges, 1 = regular prism (docs/quality.md)
  std::optional<double> unit_m;              ///< metres per unit of the mesh where no tags.json says it; 1 if not given
};

/// Reads a limits file (docs/schema/check-limits.schema.json).
/// @throws Error file_unreadable (201), file_syntax (202) for unknown names too.
[[nodiscard]] Limits read_limits(const std::string& file);

}  // namespace pcbmesh::validation
