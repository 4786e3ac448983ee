// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "pcbmesh/formats/registry.hpp"

namespace pcbmesh::formats::vtu {

/// Folder "board_pvtu" beside "board.pvtu" for the files it lists. @throws Error usage (101) for a name without ending.
[[nodiscard]] std::filesystem::path folder_of(const std::filesystem::path& file);
/// Parts of equal numbers of elements, in a folder named like the file without its ending, then the .pvtu itself.
void write_parallel(mesh::MeshSource& source, const std::filesystem::path& file, const WriteMeshOptions& options,
                    const Progress& progress);
/// One file for each group that has elements, volumes first, then the .vtm itself.
void write_multiblock(mesh::MeshSource& source, const std::filesystem::path& file, const WriteMeshOptions& options,
                      const Progress& progress);

}  // namespace pcbmesh::formats::vtu
