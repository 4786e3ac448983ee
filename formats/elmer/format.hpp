// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pcbmesh/formats/registry.hpp"

namespace pcbmesh::formats::elmer {

/// Elmer mesh: a folder of mesh.header, mesh.nodes, mesh.elements, mesh.boundary, mesh.names.
extern const MeshFormat mesh_format;

}  // namespace pcbmesh::formats::elmer
