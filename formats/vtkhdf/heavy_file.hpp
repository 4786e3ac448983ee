// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "formats/vtk/piece.hpp"
#include "pcbmesh/formats/registry.hpp"
#include "pcbmesh/mesh/mesh_source.hpp"

namespace pcbmesh::formats::vtkhdf {

/// What /mesh of a heavy file holds, for those who point into it.
struct HeavyGrid {
  std::string topology;  ///< XDMF's name of the cell kind, or "Mixed"
  std::string path;      ///< of the connectivity
  std::int64_t num_elements = 0;
  std::int64_t num_columns = 0;        ///< nodes per element; 0 for Mixed
  std::int64_t num_numbers = 0;        ///< of the connectivity
  std::vector<vtk::CellArray> arrays;  ///< at path + "_" + name
  std::string vtk_path{};              ///< the same connectivity as one row of numbers in VTK's order; empty = there is none
};
struct HeavyFile {
  std::int64_t num_nodes = 0;
  std::size_t index_bytes = 4;
  std::vector<HeavyGrid> cells;  ///< one per kind
  std::vector<HeavyGrid> faces;  ///< one, or none
};

/// Writes one HDF5 file that VTK reads as VTKHDF (cells in file order) and XDMF files point into (/mesh: one data set for
/// each cell kind, all tagged faces in one). Points are stored once and linked; so are the cell arrays where all cells are of
/// one kind. Wedges: the chosen order in /VTKHDF, always Gmsh's in /mesh.
/// @param before_it_appears  sees what the file holds when it is whole on the disk and not yet under its name: files that point
/// into it are made here, so that all appear at one stroke.
using HeavyVisit = std::function<void(const HeavyFile&)>;
void write_heavy(mesh::MeshSource& source, const std::filesystem::path& file, const WriteMeshOptions& options,
                 const Progress& progress, const HeavyVisit& before_it_appears = {});

}  // namespace pcbmesh::formats::vtkhdf
