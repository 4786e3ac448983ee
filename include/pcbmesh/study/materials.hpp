// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pcbmesh/base/dispersion.hpp"

namespace pcbmesh::study {

/// One entry of a material library (docs/schema/materials.schema.json).
struct LibraryMaterial {
  std::string name;                    ///< unique in its library
  std::vector<std::string> aliases{};  ///< other names it goes by on boards
  double eps_r = 1;                    ///< at `at_hz`
  double tan_delta = 0;                ///< at `at_hz`
  std::optional<double> at_hz{};       ///< frequency the values were stated for; empty = any
  double mu_r = 1;
  double sigma_s_per_m = 0;
  Dispersion dispersion{};
  Roughness roughness{};
  std::string source{};  ///< where the numbers come from
  bool operator==(const LibraryMaterial&) const = default;
};

/// Reads a material file. A material of model djordjevic_sarkar without parameters gets the curve through its stated values.
/// @throws Error study_invalid (102) with line and field, file_unreadable (201), file_syntax (202).
[[nodiscard]] std::vector<LibraryMaterial> read_materials(const std::filesystem::path& file);
[[nodiscard]] std::vector<LibraryMaterial> parse_materials(std::string_view json, std::string_view file_name);

/// The library that comes with the program (src/study/materials.json).
[[nodiscard]] std::vector<LibraryMaterial> builtin_materials();

/// The entry that bears the name or alias; letters, digits and their order count, case, blanks and punctuation do not.
/// Null if there is none. Later entries win, so that a user's library goes behind the program's.
[[nodiscard]] const LibraryMaterial* find_material(const std::vector<LibraryMaterial>& library, std::string_view name);

}  // namespace pcbmesh::study
