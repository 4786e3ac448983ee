// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

namespace pcbmesh::formats::dolfinx {

/// The part of a deck that is the same for every study: solve.py.
extern const std::string_view solve_text;

}  // namespace pcbmesh::formats::dolfinx
