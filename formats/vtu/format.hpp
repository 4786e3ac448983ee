// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pcbmesh/formats/registry.hpp"

namespace pcbmesh::formats::vtu {

/// VTK unstructured grid for ParaView: the prisms as cells in prism-id order, with cell arrays volume_tag, layer_id,
/// material_id and net_id (-1 = no net). Raw appended data, streamed. Wedges in the order VTK up to 9.6 documents
/// (bottom triangle's normal points outwards: 0 2 1 3 5 4 of ours), which gmsh, meshio and MFEM expect too.
/// Writes only. There is one kind of file: `binary` and `version` of the options change nothing.
extern const MeshFormat mesh_format;

}  // namespace pcbmesh::formats::vtu
