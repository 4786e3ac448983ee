// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "formats/kicad/reading.hpp"

namespace pcbmesh::formats::kicad {

/// Fills materials and stackup from (setup (stackup ...)).
///
/// Plies of one dielectric (addsublayer) are joined: thicknesses add, permittivities in series.
/// Without a stackup section: copper 35 um, equal dielectrics that fill (general (thickness)) (1.6 mm if absent),
/// er 4.5, tan d 0.02. Absent or impossible values inside the section: dielectric er 4.5 and tan d 0.02, mask er 3.3 and
/// tan d 0, copper 35 um; a dielectric or mask of thickness 0 is left out. Every default taken is a diagnostic.
/// @throws Error stackup_invalid (303) if two copper layers would touch.
void read_stackup(Reading& reading, syntax::Sexpr root);

}  // namespace pcbmesh::formats::kicad
