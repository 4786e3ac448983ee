// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/msh/format.hpp"

#include <fmt/format.h>

#include <array>

#include "formats/msh/read_msh.hpp"
#include "formats/msh/write_msh.hpp"
#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats::msh {
namespace {

constexpr std::array<std::string_view, 1> extensions{".msh"};

void write(mesh::MeshSource& source, const std::filesystem::path& file, const WriteMeshOptions& options,
           const Progress& progress) {
  const bool is_41 = options.version.empty() || options.version == "4.1" || options.version == "4";
  if (!is_41 && options.version != "2.2" && options.version != "2")
    throw Error(ErrorCode::usage, fmt::format("there is no MSH version '{}'; use 4.1 or 2.2", options.version),
                {.file = file.string()});
  if (!is_41) require_fits_22(source, file);
  FileSink sink(file, (is_41 ? expected_bytes_41 : expected_bytes_22)(source, options.binary));
  (is_41 ? write_41 : write_22)({source, sink, options.binary, source.unit_m() / metres_per(options.unit), progress});
  progress.check();
  sink.commit();
}

}  // namespace

constinit const MeshFormat mesh_format{
    "msh",      "Gmsh mesh, versions 4.1 and 2.2",
    extensions, write,
    read_msh,   {.written = all_kinds, .readable = all_kinds, .has_tags = true, .has_names = true}};

}  // namespace pcbmesh::formats::msh
