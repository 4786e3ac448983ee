// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "validation/checks/context.hpp"

namespace pcbmesh::validation::profiles {

/// What a face group stands for: by tags.json if it says so, else by the first part of its name ("port|P1").
enum class FaceRole { unknown, outer, conductor, sheet, port, wave_port, interface };

struct FaceGroup {
  std::int32_t tag = 0;
  std::string name;
  FaceRole role = FaceRole::unknown;
  bool is_coaxial = false;          ///< of a coaxial port, by tags.json
  std::vector<std::int64_t> faces;  ///< tagged faces, ascending
  [[nodiscard]] bool is_conductor() const { return role == FaceRole::conductor || role == FaceRole::sheet; }
};

/// All face groups by slot of Context::face_tags.
[[nodiscard]] std::vector<FaceGroup> face_groups(const checks::Context& context);

[[nodiscard]] bool has_cells(const checks::Context& context, mesh::CellKind kind);
[[nodiscard]] std::int64_t num_cells(const checks::Context& context, mesh::CellKind kind);

/// The mesh is from an MSH file of version 4.
[[nodiscard]] bool is_msh4(const checks::Context& context);

/// Prisms with this many nodes of second order: 9 of 15 nodes, 12 of 18.
[[nodiscard]] std::int64_t num_prisms_of_order_2(const checks::Context& context, int num_mid);
/// MSH alone: elements whose faces or inside lack nodes (quadrangles of 8, prisms of 15), which MFEM's reader does not know.
void report_incomplete(const checks::Context& context, std::string_view code, checks::CheckLog& log);
/// MSH alone: elements of first and of second order in one file, which MFEM's reader refuses.
void report_mixed_orders(const checks::Context& context, std::string_view code, checks::CheckLog& log);

/// Some elements of the file have a group and others none: MFEM's reader gives up.
void report_untagged(const checks::Context& context, std::string_view code, checks::CheckLog& log);
/// Attributes are not 1, 2, ..., n: tables by attribute get holes.
void report_sparse(const checks::Context& context, std::string_view code, checks::CheckLog& log);

}  // namespace pcbmesh::validation::profiles
