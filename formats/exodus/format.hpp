// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pcbmesh/formats/registry.hpp"

namespace pcbmesh::formats::exodus {

/// Exodus II: element blocks and side sets with names, in netCDF classic format (64-bit offsets).
extern const MeshFormat mesh_format;

}  // namespace pcbmesh::formats::exodus
