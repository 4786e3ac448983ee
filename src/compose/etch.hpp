// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <vector>

#include "pcbmesh/model/model.hpp"

namespace pcbmesh::compose {

/// Copper of one layer by net, every edge of the layer's copper pulled in by `inset`. Edges where two nets touch are no
/// edges of the copper, so net ties hold. inset 0 gives the shapes back as they are.
[[nodiscard]] std::map<std::int32_t, std::vector<model::BodyShape>> etched(
    const std::map<std::int32_t, std::vector<model::BodyShape>>& by_net, Nm inset);

}  // namespace pcbmesh::compose
