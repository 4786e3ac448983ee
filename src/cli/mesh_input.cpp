// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/cli/mesh_input.hpp"

#include "pcbmesh/base/units.hpp"
#include "pcbmesh/formats/native_mesh.hpp"
#include "pcbmesh/formats/registry.hpp"

namespace pcbmesh::cli {

std::filesystem::path tags_beside(std::filesystem::path mesh) {
  if (mesh.extension() == ".gz" || mesh.extension() == ".xz") mesh.replace_extension();
  return mesh.replace_extension(".tags.json");
}

std::optional<MeshInput> read_if_mesh(const std::filesystem::path& file, const std::string& input_unit,
                                      const Progress& progress) {
  const formats::MeshFormat* format = formats::find_mesh_format(file);
  if (format == nullptr) return std::nullopt;
  MeshInput out;
  if (format->name == "native") {
    out.prisms = formats::read_prism_mesh(file, progress);
    return out;
  }
  out.cells = std::make_shared<mesh::MeshData>(formats::read_mesh(file, {}, progress));
  const std::filesystem::path tags = tags_beside(file);
  if (std::filesystem::exists(tags)) out.tags = validation::read_expectation(tags.string());
  if (!input_unit.empty()) {
    out.unit_m = metres_per(parse_length_unit(input_unit));
    out.unit_source = input_unit + ", as told";
  } else if (out.tags) {
    out.unit_m = out.tags->unit_m;
    out.unit_source = "from " + tags.filename().string();
  } else {
    out.unit_source = "m, assumed; --input-unit says otherwise";
  }
  return out;
}

}  // namespace pcbmesh::cli
