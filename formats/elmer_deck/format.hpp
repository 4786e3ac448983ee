// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pcbmesh/formats/deck.hpp"

/// Elmer (.sif): VectorHelmholtz with edge elements on prisms, StatElecSolver for capacitances. Written: x.sif (driven: one per
/// excited port, x.port1.sif ...) and x.run.sh, which makes Elmer's own mesh folder with ElmerGrid. Elmer's time factor is
/// exp(-i omega t): loss is a positive imaginary part. Reads MSH 2.2 in text.
namespace pcbmesh::formats::elmer_deck {

extern const DeckFormat deck_format;

}  // namespace pcbmesh::formats::elmer_deck
