// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pcbmesh/formats/deck.hpp"

/// GetDP 3 (.pro): lowest-order edge elements on prisms for full wave, nodal elements for electrostatics. Written: x.pro,
/// x.run.sh. Reads MSH 2.2, where one number must not mean a volume group and a face group: faces are numbered after volumes.
namespace pcbmesh::formats::getdp {

extern const DeckFormat deck_format;

}  // namespace pcbmesh::formats::getdp
