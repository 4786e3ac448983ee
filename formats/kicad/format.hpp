// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pcbmesh/formats/registry.hpp"

namespace pcbmesh::formats::kicad {

/// KiCad .kicad_pcb, file formats 4 and v5 to v10 with their development versions.
extern const BoardFormat board_format;

}  // namespace pcbmesh::formats::kicad
