// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "pcbmesh/base/progress.hpp"
#include "pcbmesh/mesh/mesh_data.hpp"
#include "pcbmesh/mesh/prism_mesh.hpp"
#include "pcbmesh/validation/report.hpp"

namespace pcbmesh::cli {

/// A mesh file that was read to be looked at: layers if the file knows them, else cells.
struct MeshInput {
  std::optional<mesh::PrismMesh> prisms{};
  std::shared_ptr<const mesh::MeshData> cells{};  ///< null if there are prisms
  std::optional<validation::Expectation> tags{};  ///< of the cells: from tags.json, if one lies beside them
  double unit_m = 1;                              ///< of the cells
  std::string unit_source{};                      ///< of the cells: where the unit comes from
};

/// "board.msh" or "board.msh.gz" -> "board.tags.json", whether it is there or not.
[[nodiscard]] std::filesystem::path tags_beside(std::filesystem::path mesh);

/// The mesh in a file; nothing if the file is no mesh, and so a board.
/// @param input_unit  "mm"...; empty = from the tags.json beside it, else metres
/// @throws Error usage (101) for a unit that is none; and those of reading.
[[nodiscard]] std::optional<MeshInput> read_if_mesh(const std::filesystem::path& file, const std::string& input_unit,
                                                    const Progress& progress);

}  // namespace pcbmesh::cli
