// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "formats/kicad/reading.hpp"

namespace pcbmesh::formats::kicad {

/// (footprint ...) or (module ...): pads, holes, pins, graphics on copper and Edge.Cuts, zones.
void read_footprint(Reading& reading, syntax::Sexpr footprint);

}  // namespace pcbmesh::formats::kicad
