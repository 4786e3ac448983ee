// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "formats/deck/field_problem.hpp"

namespace pcbmesh::formats::deck {

/// Writes one text file of a deck, whole or not at all, and lists it. @throws Error write_failed (701).
void put_file(const std::filesystem::path& file, std::string_view text, Deck& deck);

/// Writes x.run.sh and makes it the deck's command: goes to its own folder, then does what `body` says.
void put_run_script(const std::filesystem::path& file, std::string_view what, std::string_view body, Deck& deck);

/// Where results go, for solvers whose decks write the tables that pcbmesh reads.
struct ResultFiles {
  std::string written;  ///< by the solver
  std::string final;    ///< what the command ends in: a Touchstone file for a driven problem
  std::string after;    ///< lines of the run script from one to the other
};
/// @param judged_by  options of `pcbmesh touchstone`, with a blank before each
[[nodiscard]] ResultFiles result_files(const FieldProblem& problem, std::string_view judged_by = "");

/// The run script of such a solver: `body` writes the table, what follows makes of it what the command ends in.
/// @param solver  its name, and where it comes from  @param environment  what the variables of the shell mean
void put_run_script(const std::filesystem::path& folder, const FieldProblem& problem, std::string_view solver,
                    std::string_view environment, std::string_view body, Deck& deck);

}  // namespace pcbmesh::formats::deck
