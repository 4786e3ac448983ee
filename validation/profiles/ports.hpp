// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "validation/profiles/rules.hpp"

namespace pcbmesh::validation::profiles {

struct PortShape {
  bool is_planar = false;
  bool is_rectangle = false;  ///< fills its smallest enclosing rectangle; false if not planar
  double off_plane = 0;       ///< largest distance of a corner from the plane of the largest face
};

/// @param faces  tagged faces, at least one. Relative tolerance 1e-6 of the port's size.
[[nodiscard]] PortShape shape_of_port(const checks::Context& context, std::span<const std::int64_t> faces);

/// Conductors (face groups, and volume groups that tags.json calls conductors) that share an edge with the rim of `port`.
[[nodiscard]] std::vector<std::string> conductors_at(const checks::Context& context, const FaceGroup& port,
                                                     std::span<const FaceGroup> groups);

}  // namespace pcbmesh::validation::profiles
