// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pcbmesh/formats/deck.hpp"

/// MFEM: the problem as lines of text that name the attribute sets of the mesh (format 1.3), and a short driver in C++ that
/// reads them (examples/mfem/solve.cpp). Written: x.problem.txt, x.solve.cpp, x.run.sh, which compiles and runs it.
namespace pcbmesh::formats::mfem_deck {

extern const DeckFormat deck_format;

}  // namespace pcbmesh::formats::mfem_deck
