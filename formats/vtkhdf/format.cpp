// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/vtkhdf/format.hpp"

#include <array>

#include "formats/vtkhdf/heavy_file.hpp"
#include "formats/vtkhdf/read_vtkhdf.hpp"

namespace pcbmesh::formats::vtkhdf {
namespace {

constexpr std::array<std::string_view, 3> extensions{".vtkhdf", ".hdf", ".h5"};

void write(mesh::MeshSource& source, const std::filesystem::path& file, const WriteMeshOptions& options,
           const Progress& progress) {
  static_cast<void>(write_heavy(source, file, options, progress));
}

}  // namespace

constinit const MeshFormat mesh_format{
    "vtkhdf",    "VTKHDF unstructured grid, also heavy data of XDMF",
    extensions,  write,
    read_vtkhdf, {.written = all_kinds, .readable = all_kinds, .has_tags = true, .has_names = true}};

}  // namespace pcbmesh::formats::vtkhdf
