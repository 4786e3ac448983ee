// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "pcbmesh/base/progress.hpp"
#include "pcbmesh/formats/registry.hpp"

namespace pcbmesh::formats::kicad {

/// Reads a board from the bytes of a .kicad_pcb file.
/// @param file  path as the user gave it, for messages and Board::source
/// @throws Error file_syntax (202), input_number (203), file_truncated (205), stackup_invalid (303), board_invalid (301)
///               with file:line; cancelled (103).
/// @cost about 50 MB/s; memory about three times the text.
[[nodiscard]] ReadBoardResult read_board_text(std::string text, std::string file, std::string name,
                                              const Progress& progress = Progress{});

}  // namespace pcbmesh::formats::kicad
