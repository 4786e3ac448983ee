// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pcbmesh/formats/registry.hpp"

namespace pcbmesh::formats::abaqus {

/// Abaqus and CalculiX input: nodes, elements, element sets, node sets, surfaces. Coordinates have at most 20 characters,
/// because CalculiX reads no more.
extern const MeshFormat mesh_format;

}  // namespace pcbmesh::formats::abaqus
