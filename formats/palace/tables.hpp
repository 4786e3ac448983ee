// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "formats/deck/field_problem.hpp"

namespace pcbmesh::formats::palace {

/// Lines of a shell script that turn what Palace leaves in `folder` (decibels and degrees of port-S.csv, terminal-C.csv,
/// eig.csv) into the tables that every other deck ends in: deck::result_files().
[[nodiscard]] std::string table_script(const deck::FieldProblem& problem, const std::string& folder);

}  // namespace pcbmesh::formats::palace
