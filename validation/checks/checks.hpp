// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "pcbmesh/validation/report.hpp"
#include "validation/checks/context.hpp"
#include "validation/checks/face_matching.hpp"
#include "validation/checks/net_contacts.hpp"

namespace pcbmesh::validation::checks {

/// Whether later checks can rely on the arrays.
struct ArrayState {
  bool sizes_ok = false;  ///< block sizes and kinds agree: corners may be indexed
  bool ids_ok = false;    ///< every corner of every cell and face is a node
};

/// Volume per group as the sum of its cells, and of all cells.
struct VolumeSums {
  std::vector<double> of_tag;  ///< by slot of Context::cell_tags
  std::vector<std::int64_t> cells_of_tag;
  double total = 0;
};

[[nodiscard]] ArrayState check_arrays(const Context& context, Report& report);
void check_nodes(const Context& context, Report& report);
[[nodiscard]] VolumeSums check_cells(const Context& context, Report& report);
/// Matches all faces; boundary faces are left in the result. `nets` may be null.
[[nodiscard]] FaceMatch check_faces(const Context& context, NetContacts* nets, Report& report);
void check_boundary_edges(const Context& context, const FaceMatch& match, Report& report);
void check_boundary_overlaps(const Context& context, const FaceMatch& match, Report& report);
void check_volumes(const Context& context, const FaceMatch& match, const VolumeSums& sums, Report& report);
void check_tags(const Context& context, const std::vector<std::int64_t>& cells_of_tag, Report& report);
void check_face_groups(const Context& context, Report& report);
/// Mesh against layout: pieces, shorts, and what each net is (Report::nets). `netlist` null: the expectation's own.
void check_nets(const Context& context, NetContacts& nets, const Expectation* netlist, Report& report);

}  // namespace pcbmesh::validation::checks
