// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pcbmesh/formats/registry.hpp"

namespace pcbmesh::formats::msh {

/// Gmsh MSH: writes 4.1 (default) and 2.2, text and binary; reads the same, by other code.
extern const MeshFormat mesh_format;

}  // namespace pcbmesh::formats::msh
