// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "formats/kicad/reading.hpp"

namespace pcbmesh::formats::kicad {

/// Warns of closed loops that cross themselves (kicad.outline_crosses_itself) or each other (kicad.outlines_cross), with
/// places.
/// @cost O(n log n) for sane outlines; gives up with a note after a fixed number of comparisons.
void report_crossings(Reading& reading, const std::vector<EdgePiece>& loops);

/// Boards and their cut-outs: a loop inside an even number of others is a board, inside an odd number a cut-out of the
/// smallest board around it. Boards in order of their first piece in the file.
/// @throws Error outline_invalid (302) if hundreds of thousands of loops overlap each other.
[[nodiscard]] std::vector<board::Outline> nest(const Reading& reading, std::vector<EdgePiece> loops);

}  // namespace pcbmesh::formats::kicad
