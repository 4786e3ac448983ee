// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pcbmesh/mesh/prism_mesh.hpp"
#include "src/extrude/columns.hpp"

namespace pcbmesh::extrude {

/// Fills face_tags, caps and walls of the parts, whose planar mesh, plan and nets are set.
void add_boundary(mesh::PrismMeshParts& parts, const Columns& columns);

}  // namespace pcbmesh::extrude
