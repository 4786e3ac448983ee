// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

#include "formats/deck/field_problem.hpp"

namespace pcbmesh::formats::deck {

/// What a deck can say of the things on which solvers differ.
struct Limits {
  std::string_view solver;   ///< as people write it
  bool solid_copper = true;  ///< drops unknowns by volume; the others set conditions on tagged faces, and solid copper has none
  bool wave_ports = false;   ///< in driven problems
  bool coaxial_ports = false;     ///< in driven problems
  bool lossy_resonances = false;  ///< boundaries that make the eigenvalue problem non-linear
  bool periodic_sides = false;    ///< in full wave: edges of the partner side are linked
};

/// state(), held against what the solver can do. @throws as state(); Error format_limit (703) with the nearest it can do.
[[nodiscard]] FieldProblem state_within(const Limits& limits, const mesh::PrismMesh& mesh, const DeckOptions& options,
                                        std::int32_t first_face_id, Diagnostics& diagnostics);

}  // namespace pcbmesh::formats::deck
