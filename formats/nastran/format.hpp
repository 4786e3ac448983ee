// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pcbmesh/formats/registry.hpp"

namespace pcbmesh::formats::nastran {

/// Nastran bulk data: GRID*, elements with the tag as property. Coordinates have at most 16 characters, the width of a large
/// field.
extern const MeshFormat mesh_format;

}  // namespace pcbmesh::formats::nastran
