// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/board/board.hpp"

namespace pcbmesh::view {

/// Where it went wrong: the board around the place that an error names, its layer and net brought out, beside the whole board
/// with the place marked. SVG, lengths in millimetres, y up.
/// REQUIRES error.spot().at_mm. @cost O(shapes).
[[nodiscard]] std::string refusal_svg(const board::Board& board, const Error& error);

}  // namespace pcbmesh::view
