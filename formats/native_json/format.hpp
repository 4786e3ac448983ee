// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

#include "pcbmesh/formats/registry.hpp"

namespace pcbmesh::formats::native_json {

/// pcbmesh's own board format, made for writing by hand: docs/native-board.md, docs/schema/board.schema.json.
extern const BoardFormat board_format;

/// Format version in the field "pcbmesh_board".
inline constexpr int format_version = 1;

/// Reads a board from text. Coordinates to integer nanometres, y up.
/// @throws Error file_syntax (202) for JSON syntax and wrong fields, input_number (203), board_invalid (301) for unknown names,
///               outline_invalid (302), stackup_invalid (303): with line and JSON pointer.
[[nodiscard]] ReadBoardResult parse_board(std::string_view text, std::string_view file_name,
                                          const Progress& progress = Progress{});

}  // namespace pcbmesh::formats::native_json
