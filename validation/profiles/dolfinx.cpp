// SPDX-License-Identifier: GPL-3.0-or-later
// dolfinx, every version to August 2026: no edge elements on prisms, no face tags on them, one kind of cell per mesh.
#include <fmt/format.h>

#include "validation/checks/checks.hpp"
#include "validation/profiles/rules.hpp"
#include "validation/profiles/solvers.hpp"

namespace pcbmesh::validation::profiles {
namespace {

void judge(const checks::Context& context, const checks::FaceMatch&, Report& report) {
  checks::CheckLog log(report, context, "profile dolfinx");
  log.examined(context.num_cells() + context.num_faces());
  int num_kinds = 0;
  for (const mesh::CellKind kind :
       {mesh::CellKind::tetrahedron, mesh::CellKind::pyramid, mesh::CellKind::wedge, mesh::CellKind::hexahedron}) {
    num_kinds += has_cells(context, kind) ? 1 : 0;
  }
  if (num_kinds > 1) {
    log.found("profile.dolfinx.mixed_cells", fmt::format("the mesh mixes {} kinds of cells", num_kinds));
  }
  const std::int64_t prisms = num_cells(context, mesh::CellKind::wedge);
  if (prisms == 0) return;
  log.found("profile.dolfinx.prisms", fmt::format("{} cells are prisms, on which there are no edge elements", prisms), prisms);
  if (context.num_faces() > 0) {
    log.found("profile.dolfinx.face_tags", fmt::format("{} tagged faces lie on a mesh with prisms", context.num_faces()),
              context.num_faces());
  }
}

}  // namespace

constinit const Profile dolfinx{"dolfinx", "dolfinx, every version to August 2026", judge};

}  // namespace pcbmesh::validation::profiles
