// SPDX-License-Identifier: GPL-3.0-or-later
// GetDP 3.2 as Debian has it, without Gmsh's library: reads MSH 2.2; regions are numbers whatever their dimension.
#include <fmt/format.h>

#include "validation/checks/checks.hpp"
#include "validation/profiles/rules.hpp"
#include "validation/profiles/solvers.hpp"

namespace pcbmesh::validation::profiles {
namespace {

void judge(const checks::Context& context, const checks::FaceMatch&, Report& report) {
  checks::CheckLog log(report, context, "profile getdp");
  log.examined(context.num_cells() + context.num_faces());
  if (is_msh4(context)) {
    log.found("profile.getdp.format",
              fmt::format("the file is MSH {}; GetDP without Gmsh's library reads 2.2 only", context.mesh.format.version));
  }
  if (const std::int64_t prisms = num_prisms_of_order_2(context, 9) + num_prisms_of_order_2(context, 12); prisms > 0) {
    log.found("profile.getdp.second_order_prisms", fmt::format("{} prisms have 15 or 18 nodes", prisms), prisms);
  }
  std::string shared;
  std::int64_t count = 0;
  for (int slot = 0; slot < context.cell_tags.size(); ++slot) {
    const std::int32_t tag = context.cell_tags.tag(slot);
    if (tag <= 0 || context.face_tags.slot(tag) < 0) continue;
    if (++count <= 8) shared += fmt::format("{}{}", shared.empty() ? "" : ", ", tag);
  }
  if (count == 0) return;
  log.found("profile.getdp.shared_region",
            fmt::format("{} numbers name both a volume group and a face group ({}{}): Region[n] takes both", count, shared,
                        count > 8 ? ", ..." : ""),
            count);
}

}  // namespace

constinit const Profile getdp{"getdp", "GetDP 3.2", judge};

}  // namespace pcbmesh::validation::profiles
