// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pcbmesh/mesh/prism_mesh.hpp"
#include "src/extrude/columns.hpp"

namespace pcbmesh::extrude {

/// Fills face_tags, caps, walls and ports of the parts, whose planar mesh, plan, nets and materials are set.
/// @throws Error port_invalid (306) naming every port whose faces are not the rectangle that was asked for.
void add_boundary(mesh::PrismMeshParts& parts, const Columns& columns, const model::Model& model);

}  // namespace pcbmesh::extrude
