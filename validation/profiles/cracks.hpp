// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "validation/checks/context.hpp"

namespace pcbmesh::validation::profiles {

/// Edges inside a sheet of tagged faces whose two ends both stay whole when the mesh is cut along the sheet: the nodes on
/// its rim, where the cells round the node still hang together. Both sides of the cut then share the edge.
/// @param sheets  tagged faces between two cells. @return first tagged face of each such edge.
[[nodiscard]] checks::Tally find_chords(const checks::Context& context, std::span<const std::int64_t> sheets);

}  // namespace pcbmesh::validation::profiles
