// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/validation/profiles.hpp"
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

/// Whether the file is of a kind that is often written with cells alone: then a missing face is no lost face.
bool holds_cells_alone(const mesh::MeshData& mesh) {
  return mesh.faces.empty() && (mesh.format.name == "vtu" || mesh.format.name == "xdmf");
}

}  // namespace

Report check(const mesh::MeshData& mesh, const Expectation* expectation, const CheckOptions& options) {
  Expectation of_cells;
  if (expectation != nullptr && holds_cells_alone(mesh)) {
    of_cells = *expectation;
    of_cells.faces.clear();
    expectation = &of_cells;
  }
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
  checks::HeightGrowth growth(context);
  const checks::FaceMatch match =
      checks::check_faces(context, nets.is_needed() ? &nets : nullptr, growth.is_needed() ? &growth : nullptr, report);
  checks::check_boundary_edges(context, match, report);
  if (context.has_geometry) checks::check_boundary_overlaps(context, match, report);
  if (context.has_geometry) checks::check_interiors(context, match, sums, report);
  checks::check_volumes(context, match, sums, report);
  checks::check_tags(context, sums.cells_of_tag, report);
  if (context.has_geometry) checks::check_face_groups(context, report);
  checks::check_nets(context, nets, options.netlist, report);
  if (context.has_geometry) {
    checks::check_layers(context, report);
    checks::check_periodic(context, report);
    checks::check_limits(context, growth, report);
  }
  if (options.profile != nullptr) options.profile->judge(context, match, report);
  return report;
}

}  // namespace pcbmesh::validation
