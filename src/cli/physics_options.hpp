// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "src/cli/study_options.hpp"

namespace pcbmesh::cli {

/// Splits at commas; a backslash keeps the next character, for names with commas.
[[nodiscard]] std::vector<std::string> split_at_commas(const std::string& text);

/// --problem, --for, --port, --boundary, --sweep.
void add_physics_options(CLI::App& command, StudyOptions& options);
/// @throws Error usage (101).
void take_physics_options(const StudyOptions& options, study::Study& study);

}  // namespace pcbmesh::cli
