// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>

#include "formats/deck/field_problem.hpp"

namespace pcbmesh::formats::getdp {

/// The deck's text for one kind of problem. Every generated name has a prefix: GetDP's own words (Trace, Eig, Vol ...) break
/// decks.
[[nodiscard]] std::string driven_pro(const deck::FieldProblem& problem);
[[nodiscard]] std::string eigenmode_pro(const deck::FieldProblem& problem);
[[nodiscard]] std::string electrostatic_pro(const deck::FieldProblem& problem);

/// "Region[{1, 2}]"
[[nodiscard]] std::string region(std::span<const std::int32_t> ids);
/// Opening comment with the table of groups.
[[nodiscard]] std::string opening(const deck::FieldProblem& problem, std::string_view what);
/// One named group per volume and face group.
[[nodiscard]] std::string named_groups(const deck::FieldProblem& problem);
/// Ids of the volumes that hold a field, and of those that are metal.
[[nodiscard]] std::vector<std::int32_t> field_volumes(const deck::FieldProblem& problem);
[[nodiscard]] std::vector<std::int32_t> metal_volumes(const deck::FieldProblem& problem);
/// Jacobian and Integration, the same in every deck. Exact for products of two lowest-order functions.
[[nodiscard]] std::string_view integration();
/// Edge-element space with no tangential field on conductors.
[[nodiscard]] std::string edge_space(const deck::FieldProblem& problem, std::string_view support);

/// Stretch of the coordinates in perfectly matched layers, as functions s_x[], s_y[], s_z[]; empty without layers.
[[nodiscard]] std::string stretch_functions(const deck::FieldProblem& problem, double unit_m);
/// What a stretch of these axes multiplies permittivity (and, inverted, reluctivity) with; empty for no axis.
[[nodiscard]] std::string stretch_tensor(std::uint8_t axes, bool is_inverse);
/// Numbers that read back to the same value.
[[nodiscard]] std::string number(double value);

}  // namespace pcbmesh::formats::getdp
