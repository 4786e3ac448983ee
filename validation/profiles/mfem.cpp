// SPDX-License-Identifier: GPL-3.0-or-later
// MFEM 4.9 and before: reads MSH 2.2; 4.1 only since.
#include <fmt/format.h>

#include "validation/checks/checks.hpp"
#include "validation/profiles/rules.hpp"
#include "validation/profiles/solvers.hpp"

namespace pcbmesh::validation::profiles {
namespace {

void judge(const checks::Context& context, const checks::FaceMatch&, Report& report) {
  checks::CheckLog log(report, context, "profile mfem");
  log.examined(context.num_cells() + context.num_faces());
  if (is_msh4(context)) {
    log.found("profile.mfem.format",
              fmt::format("the file is MSH {}: MFEM up to 4.9 reads 2.2 only, and misreads later versions "
                          "without a word",
                          context.mesh.format.version));
  }
  report_untagged(context, "profile.mfem.untagged_elements", log);
  report_incomplete(context, "profile.mfem.incomplete_elements", log);
  report_mixed_orders(context, "profile.mfem.mixed_orders", log);
  report_sparse(context, "profile.mfem.sparse_attributes", log);
}

}  // namespace

constinit const Profile mfem{"mfem", "MFEM 4.9", judge};

}  // namespace pcbmesh::validation::profiles
