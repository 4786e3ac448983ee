// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pcbmesh/formats/registry.hpp"

namespace pcbmesh::formats::unv {

/// Universal file of I-DEAS: data sets 164, 2411, 2412 and 2467, first order.
extern const MeshFormat mesh_format;

}  // namespace pcbmesh::formats::unv
