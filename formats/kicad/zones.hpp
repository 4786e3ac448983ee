// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "formats/kicad/reading.hpp"

namespace pcbmesh::formats::kicad {

/// (zone ...): the stored fills are the copper. Before 20220211 fills are also drawn round with the zone's smallest width,
/// unless (filled_areas_thickness no). Zones without a fill are counted as kicad.unfilled_zone with layer, net and place.
void read_zone(Reading& reading, syntax::Sexpr zone);

}  // namespace pcbmesh::formats::kicad
