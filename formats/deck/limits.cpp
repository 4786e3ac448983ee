// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/deck/limits.hpp"

#include <fmt/format.h>

namespace pcbmesh::formats::deck {
namespace {

using mesh::BoundaryCondition;

void require_volumes(const Limits& limits, const FieldProblem& problem) {
  for (const Volume& volume : problem.volumes)
    if (volume.is_conductor && !limits.solid_copper)
      refuse(limits.solver,
             fmt::format("solid copper, '{}': it has no boundary of its own and no mesh resolves its skin", volume.name),
             "hollow or sheet conductors (--conductors hollow): their skins become conductivity or PEC boundaries");
}

void require_ports(const Limits& limits, const FieldProblem& problem) {
  if (problem.options.problem != Problem::driven) return;
  for (const FieldPort& port : problem.ports) {
    if (port.port.kind == mesh::PortKind::coaxial && !limits.coaxial_ports)
      refuse(limits.solver, fmt::format("coaxial port '{}' in this deck", port.port.name),
             "a lumped port on the track beside the via; GetDP and Palace have coaxial ports");
    if (port.port.kind == mesh::PortKind::wave && !limits.wave_ports)
      refuse(limits.solver, fmt::format("wave port '{}' in this deck", port.port.name),
             "a lumped port across the gap between trace and reference; GetDP has wave ports of TEM and quasi-TEM lines, "
             "Palace of any");
  }
}

void require_faces(const Limits& limits, const FieldProblem& problem) {
  for (const Face& face : problem.faces) {
    const bool links_sides = limits.periodic_sides && problem.options.problem != Problem::electrostatic;
    if (face.condition == BoundaryCondition::periodic && !links_sides)
      refuse(limits.solver, fmt::format("the periodic side '{}' in a {} problem", face.name, name_of(problem.options.problem)),
             "pec or pmc on both sides, which are planes of symmetry");
    const bool is_lossy = face.condition == BoundaryCondition::absorbing || face.condition == BoundaryCondition::impedance ||
                          face.condition == BoundaryCondition::port;
    if (problem.options.problem == Problem::eigenmode && is_lossy && !limits.lossy_resonances)
      refuse(limits.solver,
             fmt::format("resonances with the {} boundary '{}', which makes the eigenvalue problem non-linear",
                         mesh::name_of(face.condition), face.name),
             "pec or pmc there, or a driven sweep");
    // No solver here lets a surface float: its condition would be none, which is no copper at all.
    const bool is_copper = face.kind == mesh::FaceTagKind::conductor || face.kind == mesh::FaceTagKind::sheet;
    if (problem.options.problem == Problem::electrostatic && is_copper && face.net < 0)
      refuse(limits.solver,
             fmt::format("{} copper without a net, '{}', which floats",
                         face.kind == mesh::FaceTagKind::sheet ? "sheet" : "hollow", face.name),
             "solid copper there, which floats as a body of very high permittivity, in GetDP or dolfinx");
  }
}

}  // namespace

FieldProblem state_within(const Limits& limits, const mesh::PrismMesh& mesh, const DeckOptions& options,
                          std::int32_t first_face_id, Diagnostics& diagnostics) {
  FieldProblem problem = state(mesh, options, first_face_id, diagnostics);
  require_volumes(limits, problem);
  require_ports(limits, problem);
  require_faces(limits, problem);
  return problem;
}

}  // namespace pcbmesh::formats::deck
