// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "validation/checks/checks.hpp"

namespace pcbmesh::validation::checks {
namespace {

void report_owners(const FaceMatch& match, CheckLog& log) {
  log.found("face.many_owners", FindingSeverity::error,
            fmt::format("{} faces belong to three or more cells", match.many_owners.count()), match.many_owners,
            PlaceKind::half_face);
  log.found("face.same_orientation", FindingSeverity::error,
            fmt::format("{} faces are seen from the same side by both their cells: the cells overlap or one is inside out",
                        match.same_orientation.count()),
            match.same_orientation, PlaceKind::half_face);
  log.found("cell.duplicate", FindingSeverity::error,
            fmt::format("{} cells have the same corners as an earlier cell", match.duplicate_cells.count()),
            match.duplicate_cells, PlaceKind::cell);
}

void report_tagged(const Context& context, const FaceMatch& match, CheckLog& log) {
  const bool promises_faces =
      context.num_faces() > 0 || (context.expectation != nullptr && !context.expectation->faces.empty());
  if (promises_faces) {
    log.found(
        "face.untagged", FindingSeverity::error,
        fmt::format("{} of {} boundary faces carry no tagged face: a hole, a crack, a mismatch inside, or a forgotten face",
                    match.untagged.count(), match.boundary.size()),
        match.untagged, PlaceKind::half_face);
  } else if (context.num_cells() > 0) {
    log.found(
        "face.none_tagged", FindingSeverity::warning,
        "the mesh has no tagged faces: whether its boundary is whole can be judged from geometry only, and boundaries and "
        "ports not at all (a VTU file gets its faces with --faces)");
  }
  log.found("face.tagged_twice", FindingSeverity::error,
            fmt::format("{} tagged faces repeat another tagged face", match.tagged_twice.count()), match.tagged_twice,
            PlaceKind::face);
  log.found("face.tagged_no_cell", FindingSeverity::error,
            fmt::format("{} tagged faces are a face of no cell", match.tagged_no_cell.count()), match.tagged_no_cell,
            PlaceKind::face);
  log.found("face.outer_tag_inside", FindingSeverity::error,
            fmt::format("{} tagged faces of outer groups lie between two cells", match.outer_inside.count()),
            match.outer_inside, PlaceKind::face);
  log.found("face.tagged_inward", FindingSeverity::warning,
            fmt::format("{} tagged boundary faces are turned inwards", match.tagged_inward.count()), match.tagged_inward,
            PlaceKind::face);
}

void report_mixed_tags(const Context& context, const FaceMatch& match, CheckLog& log) {
  std::string names;
  std::int64_t count = 0;
  for (int slot = 0; slot < context.face_tags.size(); ++slot) {
    const auto s = static_cast<std::size_t>(slot);
    if (match.outer_of_tag[s] == 0 || match.inner_of_tag[s] == 0) continue;
    ++count;
    if (count > 8) continue;
    const std::int32_t tag = context.face_tags.tag(slot);
    names += fmt::format("{}{} '{}' ({} outer, {} inner faces)", names.empty() ? "" : ", ", tag, context.name_of(2, tag),
                         match.outer_of_tag[s], match.inner_of_tag[s]);
  }
  if (count == 0) return;
  log.found("face.tag_mixes", FindingSeverity::error,
            fmt::format("{} face groups hold both boundary faces and faces between two cells: {}{}", count, names,
                        count > 8 ? ", ..." : ""),
            count);
}

}  // namespace

FaceMatch check_faces(const Context& context, NetContacts* nets, HeightGrowth* growth, Report& report) {
  CheckLog log(report, context, "faces");
  FaceMatch match = match_faces(context, nets, growth);
  log.examined(match.num_inner + static_cast<std::int64_t>(match.boundary.size()) + match.many_owners.count() +
               match.same_orientation.count());
  report_owners(match, log);
  report_tagged(context, match, log);
  report_mixed_tags(context, match, log);
  return match;
}

}  // namespace pcbmesh::validation::checks
