// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "pcbmesh/geometry/point.hpp"
#include "pcbmesh/model/model.hpp"

namespace pcbmesh::overlay {

/// Where sides are periodic, what crosses both at places nearer than the tolerance crosses them at one: vertices of xmax and
/// ymax move along their side. Vertices and edges are a tolerance apart, so nothing meets that was apart.
void match_sides(std::vector<geometry::Point>& vertices, const model::Model& model, Nm tolerance_nm);

}  // namespace pcbmesh::overlay
