// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/cli/mesh_input.hpp"

#include <fmt/format.h>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/formats/native_mesh.hpp"
#include "pcbmesh/formats/registry.hpp"

namespace pcbmesh::cli {

std::optional<mesh::PrismMesh> read_if_mesh(const std::filesystem::path& file, const Progress& progress) {
  const formats::MeshFormat* format = formats::find_mesh_format(file);
  if (format == nullptr) return std::nullopt;
  if (format->name == "native") return formats::read_prism_mesh(file, progress);
  throw Error(
      ErrorCode::usage,
      fmt::format("a {} file holds cells, not layers, and can't be drawn here; draw the board itself, or a .pcbmesh file "
                  "written beside it (mesh ... -o {}.pcbmesh)",
                  format->name, file.stem().string()),
      {.file = file.string()});
}

}  // namespace pcbmesh::cli
