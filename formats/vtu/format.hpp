// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pcbmesh/formats/registry.hpp"

namespace pcbmesh::formats::vtu {

/// VTK unstructured grid for ParaView: cells in file order with cell arrays volume_tag, layer, material, net (indices into the
/// tables of tags.json, -1 = none), region and quality; with `faces` also the tagged faces, in front, with face_tag. Appended
/// raw bytes, base64 or text; packed with zlib or LZ4 on request. Node numbers have 32 bits where these suffice.
/// Reads every encoding VTK and meshio write.
extern const MeshFormat mesh_format;

/// The same cut into parts of equal numbers of cells, each a .vtu in a folder named like the file, and the .pvtu that lists
/// them. Points on the cuts are repeated in each part.
extern const MeshFormat parallel_format;

/// One .vtu for each group, in a folder named like the file, and the .vtm that lists them as named blocks.
extern const MeshFormat multiblock_format;

}  // namespace pcbmesh::formats::vtu
