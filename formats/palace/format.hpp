// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pcbmesh/formats/deck.hpp"

/// Palace (MFEM): any-order edge elements on prisms. Written: x.palace.json (keys of Palace's configuration schema 1.5: L0,
/// GHz, integer attributes) and x.run.sh. Reads MSH 2.2.
namespace pcbmesh::formats::palace {

extern const DeckFormat deck_format;

}  // namespace pcbmesh::formats::palace
