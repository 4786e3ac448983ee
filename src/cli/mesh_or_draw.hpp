// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "pcbmesh/pipeline/mesh_board.hpp"

namespace pcbmesh::cli {

/// pipeline::mesh_board. Where it refuses and names a place on the board, that place is drawn into x.refusal.svg beside the
/// output, and the error goes on its way; an empty output draws nothing.
[[nodiscard]] pipeline::MeshBoardResult mesh_or_draw(const board::Board& board, const study::Study& study,
                                                     const std::filesystem::path& study_file,
                                                     const std::filesystem::path& output, const Progress& progress);

}  // namespace pcbmesh::cli
