// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "formats/kicad/reading.hpp"

namespace pcbmesh::formats::kicad {

/// Chains the pieces on Edge.Cuts into closed loops and sorts them into boards and cut-outs by nesting depth.
///
/// Ends are joined nearest first, up to 10 um apart (what KiCad itself takes; a shipped board needs 9.1 um); joints wider than
/// 1 um are noted (kicad.outline_gap_closed). The later piece's end moves onto the earlier one's. Pieces drawn twice count
/// once. Chains that stay open are reported (kicad.outline_open, with both ends and the gap) and left out. No closed loop at
/// all leaves outlines empty (kicad.no_outline). Loops that cross themselves are kept and reported
/// (kicad.outline_crosses_itself).
void read_outlines(Reading& reading);

}  // namespace pcbmesh::formats::kicad
