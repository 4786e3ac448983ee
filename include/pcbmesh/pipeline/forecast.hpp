// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pcbmesh/mesh/planar_mesh.hpp"
#include "pcbmesh/mesh/unknowns.hpp"
#include "pcbmesh/model/model.hpp"
#include "pcbmesh/study/study.hpp"

namespace pcbmesh::pipeline {

inline constexpr int highest_order = 3;

/// Memory that a solver may want for the matrix of one frequency. A band: solvers, options and machines differ.
struct SolverMemory {
  std::string solver;  ///< "palace, mfem (iterative)" ...
  double low_mib = 0, high_mib = 0;
};

/// How large a mesh is, or will be, and what a solver of edge elements makes of it.
struct Forecast {
  bool is_exact = false;
  std::int64_t triangles = 0;  ///< of the plane
  std::int64_t sublayers = 0;
  mesh::EntityCounts counts;
  std::array<mesh::Unknowns, highest_order> on_prisms{};      ///< by order, from 1
  std::array<mesh::Unknowns, highest_order> on_tetrahedra{};  ///< of the mesh with every prism cut into three
  std::vector<SolverMemory> memory;                           ///< at order 1 on prisms, the least there is
};

/// Before the last triangulation: what the study's height policy will make of the mesh that the outlines alone give. Triangles
/// larger than the bound that the policy feeds back will be divided, each by its own area; heights follow.
///
/// @param outlines    the planar mesh as it is.
/// @param fed_back_m  longest edge of the second triangulation; empty = there is none.
/// @param height_m    common height of the policy; empty = none.
/// @param counts      sub-layers per slab where they are chosen already; empty = they follow from the heights to come.
/// @cost O(triangles + regions x slabs).
[[nodiscard]] Forecast forecast(const mesh::PlanarMesh& outlines, std::optional<double> fed_back_m,
                                std::optional<double> height_m, std::span<const int> counts, const model::Model& model,
                                const study::Study& study);

/// Exact counts of a mesh. @cost O(planar edges x slabs).
[[nodiscard]] Forecast measured(const mesh::PrismMesh& mesh);

/// @param what  whose forecast it is, for the message.
/// @throws Error prism_limit (601) if prisms or first-order unknowns exceed the study's limits.
void require_within_limits(const Forecast& forecast, const study::Study& study, std::string_view what);

}  // namespace pcbmesh::pipeline
