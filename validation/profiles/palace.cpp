// SPDX-License-Identifier: GPL-3.0-or-later
// Palace (MFEM 4.9): reads MSH 2.2, cuts the mesh along boundary attributes that lie inside, takes lumped ports as
// rectangles and wave ports as flat pieces of the hull.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "validation/checks/checks.hpp"
#include "validation/profiles/cracks.hpp"
#include "validation/profiles/ports.hpp"
#include "validation/profiles/rules.hpp"
#include "validation/profiles/solvers.hpp"

namespace pcbmesh::validation::profiles {
namespace {

Finding::Place place_of(const checks::Context& context, const FaceGroup& group) {
  return context.place_of_face(group.faces.front());
}

void judge_file(const checks::Context& context, checks::CheckLog& log) {
  if (is_msh4(context)) {
    log.found(
        "profile.palace.format",
        fmt::format("the file is MSH {}, and the reader of Palace knows 2.2 only: it misreads later versions without a word",
                    context.mesh.format.version));
  }
  report_untagged(context, "profile.palace.untagged_elements", log);
  report_incomplete(context, "profile.palace.incomplete_elements", log);
  report_mixed_orders(context, "profile.palace.mixed_orders", log);
  report_sparse(context, "profile.palace.sparse_attributes", log);
  if (const std::int64_t pyramids = num_cells(context, mesh::CellKind::pyramid); pyramids > 0) {
    log.found("profile.palace.pyramids", fmt::format("{} cells are pyramids", pyramids), pyramids);
  }
  if (context.num_faces() == 0) {
    log.found("profile.palace.no_boundary", "the mesh has no boundary elements: no port, no conductor, no absorbing side");
  }
}

void judge_sheets(const checks::Context& context, const checks::FaceMatch& match, const std::vector<FaceGroup>& groups,
                  checks::CheckLog& log) {
  // Tetrahedra are divided where it is needed; only other cells are all lost.
  if (num_cells(context, mesh::CellKind::tetrahedron) == context.num_cells()) return;
  std::vector<std::int64_t> sheets;
  for (std::size_t slot = 0; slot < groups.size(); ++slot) {
    const FaceGroup& group = groups[slot];
    if (match.inner_of_tag[slot] == 0 || match.outer_of_tag[slot] > 0) continue;
    if (group.role == FaceRole::port || group.role == FaceRole::interface) continue;
    sheets.insert(sheets.end(), group.faces.begin(), group.faces.end());
  }
  const checks::Tally chords = find_chords(context, sheets);
  log.found("profile.palace.chord",
            fmt::format("{} edges inside sheets join two points of the rim: Palace divides all {} cells into tetrahedra "
                        "before it cuts the mesh there",
                        chords.count(), context.num_cells()),
            chords, checks::PlaceKind::face);
}

void judge_port(const checks::Context& context, const FaceGroup& port, const std::vector<FaceGroup>& groups,
                checks::CheckLog& log) {
  const PortShape shape = shape_of_port(context, port.faces);
  if (!shape.is_planar) {
    log.found(
        "profile.palace.port_not_planar",
        fmt::format("port {} '{}' is not flat: corners lie up to {:.3g} off its plane", port.tag, port.name, shape.off_plane),
        1, {place_of(context, port)});
  } else if (!shape.is_rectangle && !port.is_coaxial) {
    log.found("profile.palace.port_not_rectangular",
              fmt::format("port {} '{}' does not fill a rectangle; only coaxial ports (direction R) may do without", port.tag,
                          port.name),
              1, {place_of(context, port)});
  }
  const auto is_conductor = [](const FaceGroup& group) { return group.is_conductor(); };
  const bool knows_conductors =
      std::ranges::any_of(groups, is_conductor) ||
      (context.expectation != nullptr && std::ranges::any_of(context.expectation->volumes, &Expectation::Volume::conductor));
  if (!knows_conductors) return;
  const std::vector<std::string> conductors = conductors_at(context, port, groups);
  if (conductors.size() >= 2) return;
  log.found("profile.palace.port_conductors",
            fmt::format("port {} '{}' touches {}; a port lies between two conductors under attributes of their own", port.tag,
                        port.name, conductors.empty() ? "no conductor" : fmt::format("{} alone", fmt::join(conductors, ", "))),
            1, {place_of(context, port)});
}

void judge_wave_port(const checks::Context& context, const FaceGroup& port, std::int64_t num_inside, checks::CheckLog& log) {
  if (num_inside > 0) {
    log.found("profile.palace.wave_port_inside",
              fmt::format("{} faces of wave port {} '{}' lie between two cells", num_inside, port.tag, port.name), num_inside,
              {place_of(context, port)});
  }
  const PortShape shape = shape_of_port(context, port.faces);
  if (shape.is_planar) return;
  log.found("profile.palace.wave_port_not_planar",
            fmt::format("wave port {} '{}' is not flat: corners lie up to {:.3g} off its plane", port.tag, port.name,
                        shape.off_plane),
            1, {place_of(context, port)});
}

void judge(const checks::Context& context, const checks::FaceMatch& match, Report& report) {
  checks::CheckLog log(report, context, "profile palace");
  log.examined(context.num_cells() + context.num_faces());
  judge_file(context, log);
  const std::vector<FaceGroup> groups = face_groups(context);
  judge_sheets(context, match, groups, log);
  if (!context.has_geometry) return;
  for (std::size_t slot = 0; slot < groups.size(); ++slot) {
    if (groups[slot].role == FaceRole::port) judge_port(context, groups[slot], groups, log);
    if (groups[slot].role == FaceRole::wave_port) judge_wave_port(context, groups[slot], match.inner_of_tag[slot], log);
  }
}

}  // namespace

constinit const Profile palace{"palace", "Palace 0.13 and later (MFEM 4.9)", judge};

}  // namespace pcbmesh::validation::profiles
