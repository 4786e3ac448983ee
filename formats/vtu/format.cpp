// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/vtu/format.hpp"

#include <array>

#include "formats/vtk/piece.hpp"
#include "formats/vtu/read_vtu.hpp"
#include "formats/vtu/write_many.hpp"
#include "formats/vtu/write_vtu.hpp"

namespace pcbmesh::formats::vtu {
namespace {

constexpr std::array<std::string_view, 1> extensions{".vtu"}, parallel_extensions{".pvtu"}, multiblock_extensions{".vtm"};

void write(mesh::MeshSource& source, const std::filesystem::path& file, const WriteMeshOptions& options,
           const Progress& progress) {
  const vtk::Piece piece(
      source,
      vtk::runs_of(source,
                   [&](const mesh::ElementBlock& block) { return options.faces || mesh::dimension_of(block.kind) == 3; }),
      true, progress);
  write_vtu(piece, file, options, source.unit_m() / metres_per(options.unit), progress, &source);
}

std::vector<std::filesystem::path> parts(const std::filesystem::path& file) {
  return {folder_of(file)};
}

}  // namespace

constinit const MeshFormat mesh_format{
    "vtu",      "VTK unstructured grid (ParaView)",
    extensions, write,
    read_vtu,   {.written = all_kinds, .readable = all_kinds, .has_tags = true, .has_names = true}};
constinit const MeshFormat parallel_format{"pvtu",
                                           "VTK unstructured grid in parts",
                                           parallel_extensions,
                                           write_parallel,
                                           nullptr,
                                           {.written = all_kinds, .readable = 0, .has_tags = true, .has_names = true},
                                           parts};
constinit const MeshFormat multiblock_format{"vtm",
                                             "VTK multiblock: one named block for each group",
                                             multiblock_extensions,
                                             write_multiblock,
                                             nullptr,
                                             {.written = all_kinds, .readable = 0, .has_tags = true, .has_names = true},
                                             parts};

}  // namespace pcbmesh::formats::vtu
