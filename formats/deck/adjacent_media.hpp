// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "formats/deck/field_problem.hpp"

namespace pcbmesh::formats::deck {

/// Per face tag of an absorbing boundary or a wave port: what it looks into, slab by slab, equal neighbours joined. Conductors
/// don't count: the field has no tangential part there. Empty for every other tag. @cost O(planar mesh + faces).
[[nodiscard]] std::vector<std::vector<Medium>> adjacent_media(const mesh::PrismMesh& mesh);

}  // namespace pcbmesh::formats::deck
