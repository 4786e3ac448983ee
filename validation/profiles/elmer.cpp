// SPDX-License-Identifier: GPL-3.0-or-later
// Elmer through ElmerGrid: reads text only.
#include <fmt/format.h>

#include "validation/checks/checks.hpp"
#include "validation/profiles/rules.hpp"
#include "validation/profiles/solvers.hpp"

namespace pcbmesh::validation::profiles {
namespace {

void judge(const checks::Context& context, const checks::FaceMatch&, Report& report) {
  checks::CheckLog log(report, context, "profile elmer");
  log.examined(context.num_cells() + context.num_faces());
  const mesh::FileFormat& format = context.mesh.format;
  if (format.name == "msh" && format.is_binary) {
    log.found("profile.elmer.format", fmt::format("the file is binary MSH {}; ElmerGrid reads text only", format.version));
  }
  // Elmer's own files hold prisms of 15 nodes; it is ElmerGrid that loses their upper faces.
  const std::int64_t of_15 = format.name == "elmer" ? 0 : num_prisms_of_order_2(context, 9),
                     of_18 = num_prisms_of_order_2(context, 12);
  if (of_15 + of_18 == 0) return;
  log.found("profile.elmer.second_order_prisms", fmt::format("{} prisms have 15 nodes and {} have 18", of_15, of_18),
            of_15 + of_18);
}

}  // namespace

constinit const Profile elmer{"elmer", "ElmerGrid and Elmer 9", judge};

}  // namespace pcbmesh::validation::profiles
