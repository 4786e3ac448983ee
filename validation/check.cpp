// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/checks/checks.hpp"

namespace pcbmesh::validation {
namespace {

std::vector<std::int64_t> cells_per_tag(const checks::Context& context) {
  std::vector<std::int64_t> counts(static_cast<std::size_t>(context.cell_tags.size()), 0);
  for (const mesh::CellBlock& block : context.mesh.cells) {
    for (const std::int32_t tag : block.tags) ++counts[static_cast<std::size_t>(context.cell_tags.slot(tag))];
  }
  return counts;
}

}  // namespace

Report check(const mesh::MeshData& mesh, const Expectation* expectation, const CheckOptions& options) {
  const checks::Context context(mesh, expectation, options);
  Report report;
  report.num_nodes = context.num_nodes();
  report.num_cells = context.num_cells();
  report.num_faces = context.num_faces();

  // Each check relies on what the ones before it made sure of; what can't be relied on is skipped, never guessed.
  const checks::ArrayState arrays = checks::check_arrays(context, report);
  if (!arrays.sizes_ok) return report;
  if (!arrays.ids_ok) {
    checks::check_tags(context, cells_per_tag(context), report);
    return report;
  }
  checks::check_nodes(context, report);
  checks::VolumeSums sums;
  if (context.has_geometry) {
    sums = checks::check_cells(context, report);
  } else {
    sums.cells_of_tag = cells_per_tag(context);
    sums.of_tag.assign(sums.cells_of_tag.size(), 0);
  }
  checks::NetContacts nets(context);
  const checks::FaceMatch match = checks::check_faces(context, nets.is_needed() ? &nets : nullptr, report);
  checks::check_boundary_edges(context, match, report);
  if (context.has_geometry) checks::check_boundary_overlaps(context, match, report);
  checks::check_volumes(context, match, sums, report);
  checks::check_tags(context, sums.cells_of_tag, report);
  if (context.has_geometry) checks::check_face_groups(context, report);
  checks::check_nets(context, nets, options.netlist, report);
  return report;
}

}  // namespace pcbmesh::validation
