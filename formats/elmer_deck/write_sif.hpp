// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "formats/deck/field_problem.hpp"

namespace pcbmesh::formats::elmer_deck {

/// @param excited  index into problem.ports of the port that is fed; driven only.
[[nodiscard]] std::string sif(const deck::FieldProblem& problem, std::size_t excited);

}  // namespace pcbmesh::formats::elmer_deck
