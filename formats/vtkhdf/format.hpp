// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pcbmesh/formats/registry.hpp"

namespace pcbmesh::formats::vtkhdf {

/// VTKHDF unstructured grid, version 1.0, as VTK 9.1 and later read it; with /mesh beside it, the heavy data of an XDMF file.
/// Contiguous, or chunks shuffled and deflated on request. Names of groups, layers, materials and nets stand in FieldData.
/// Reads its own files and other VTKHDF grids.
extern const MeshFormat mesh_format;

}  // namespace pcbmesh::formats::vtkhdf
