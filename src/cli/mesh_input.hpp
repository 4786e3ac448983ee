// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>

#include "pcbmesh/base/progress.hpp"
#include "pcbmesh/mesh/prism_mesh.hpp"

namespace pcbmesh::cli {

/// The mesh of a native mesh file; nothing if the file is no mesh, and so a board.
/// @throws Error usage (101) for other mesh files, which do not know their layers; and those of reading.
[[nodiscard]] std::optional<mesh::PrismMesh> read_if_mesh(const std::filesystem::path& file, const Progress& progress);

}  // namespace pcbmesh::cli
