// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "pcbmesh/model/model.hpp"
#include "pcbmesh/study/study.hpp"

namespace pcbmesh::compose {

/// What bars the ports of a model, before anything is meshed: cut-outs, holes, conductors or the end of the domain in their
/// faces, or under an edge that should lie on its conductor. Each port at fault is told once, with the place and a way out.
/// @cost O(shapes) per port, and O(corners^2) of those few that meet its box.
[[nodiscard]] std::vector<study::Fault> port_faults(const model::Model& model);

}  // namespace pcbmesh::compose
