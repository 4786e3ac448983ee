// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pcbmesh/formats/registry.hpp"

namespace pcbmesh::formats::native_mesh {

/// pcbmesh's own mesh file: the plane, the levels and the table of labels, from which prisms are arithmetic. One to two bytes
/// per prism, HDF5 inside; docs/native-mesh.md says how to expand it. Coordinates are metres, whatever the options say.
/// Holds the prisms of an extruded mesh, nothing else.
extern const MeshFormat mesh_format;

}  // namespace pcbmesh::formats::native_mesh
