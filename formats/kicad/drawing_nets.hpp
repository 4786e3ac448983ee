// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "formats/kicad/reading.hpp"

namespace pcbmesh::formats::kicad {

/// Gives drawings on copper that state no net (reading.loose_drawings) the net of the copper they touch on their layer, through
/// any number of other such drawings, as KiCad does when it loads a board. Drawings that touch several nets keep none and are
/// counted (kicad.drawing_joins_nets). Drawings of footprints stay without a net: that is how net ties are made.
/// After half a million pairs the search is given up with a warning (kicad.drawings_too_many).
void adopt_nets(Reading& reading);

}  // namespace pcbmesh::formats::kicad
