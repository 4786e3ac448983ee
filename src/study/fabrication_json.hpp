// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "formats/syntax/json_tree.hpp"
#include "pcbmesh/study/fabrication.hpp"

namespace pcbmesh::study {

/// Fields "vias", "backdrill", "merge_vias", "etch", "solder_mask", "fill", "materials" and "limits"/"max_unknowns".
/// @param folder  relative names of material files start here.
void read_fabrication(const formats::syntax::JsonValue& root, const std::filesystem::path& folder, Fabrication& into);
void write_fabrication(const Fabrication& fabrication, nlohmann::ordered_json& root);

/// One material as an object of a material file.
[[nodiscard]] LibraryMaterial read_material(const formats::syntax::JsonValue& object);
[[nodiscard]] nlohmann::ordered_json material_json(const LibraryMaterial& material);

}  // namespace pcbmesh::study
