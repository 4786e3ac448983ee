// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pcbmesh/formats/registry.hpp"

namespace pcbmesh::formats::xdmf {

/// XDMF 3 over one HDF5 file. "board.xdmf" writes
///   board.vtkhdf          all numbers; VTK reads it on its own as VTKHDF
///   board.xdmf            one grid with the cells (dolfinx and meshio read no more than one)
///   board_faces.xdmf      one grid with the tagged faces
///   board_paraview.xdmf   both as named grids, for ParaView
/// Wedges in Gmsh's order, as dolfinx and meshio take them. Reads one or several grids over HDF5 or text.
extern const MeshFormat mesh_format;

}  // namespace pcbmesh::formats::xdmf
