// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pcbmesh/formats/deck.hpp"

/// dolfinx (.py): the study as JSON and one solver for all (solve.py). Nedelec elements on the tetrahedral twin for full wave,
/// nodal elements on prisms for electrostatics. Reads VTKHDF. Written: x.py, x.run.sh.
namespace pcbmesh::formats::dolfinx {

extern const DeckFormat deck_format;

}  // namespace pcbmesh::formats::dolfinx
