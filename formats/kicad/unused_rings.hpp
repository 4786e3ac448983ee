// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "formats/kicad/reading.hpp"

namespace pcbmesh::formats::kicad {

/// Adds those of reading.optional_rings that copper of their net touches on their layer; call when all other copper is in.
/// Two optional rings that touch each other hold each other, as in KiCad (20_vme_wren has 12 such power vias).
/// Fills count only where the file leaves it open (no zone_layer_connections).
/// @cost O(rings log shapes + touching pairs); one sorted index of edges per fill that is asked.
void add_used_rings(Reading& reading);

}  // namespace pcbmesh::formats::kicad
