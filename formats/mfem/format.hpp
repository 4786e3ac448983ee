// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pcbmesh/formats/registry.hpp"

namespace pcbmesh::formats::mfem {

/// MFEM mesh v1.3 (named attribute sets) and v1.0; reads v1.0, v1.2 and v1.3.
extern const MeshFormat mesh_format;

}  // namespace pcbmesh::formats::mfem
