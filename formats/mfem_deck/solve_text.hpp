// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

namespace pcbmesh::formats::mfem_deck {

/// The driver: examples/mfem/solve.cpp.
extern const std::string_view solve_text;

}  // namespace pcbmesh::formats::mfem_deck
