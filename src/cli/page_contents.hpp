// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pcbmesh/view/report.hpp"
#include "src/cli/mesh_report.hpp"

namespace pcbmesh::cli {

/// What the page of a run tells: figures, findings of the check, warnings with their places, the worst prisms.
[[nodiscard]] view::PageContents page_contents(const MeshRun& run, double unit_m);

}  // namespace pcbmesh::cli
