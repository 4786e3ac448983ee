// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "pcbmesh/base/diagnostics.hpp"
#include "pcbmesh/formats/deck.hpp"
#include "pcbmesh/pipeline/mesh_board.hpp"
#include "pcbmesh/pipeline/write_outputs.hpp"
#include "pcbmesh/study/study.hpp"

namespace pcbmesh::cli {

/// Whether the study names a solver whose deck is written; for the others there is the mesh alone.
[[nodiscard]] bool writes_deck(const study::Study& study);

/// Turns the outputs of a run for a solver into what its deck wants: a folder gets a mesh file named after the board, format,
/// version and numbering are the solver's. A folder that is named but absent will be made. Does nothing without a solver.
/// @throws Error usage (101) when the user asks for another format or version than the solver reads.
void prepare_for_solver(const study::Study& study, const std::string& board, pipeline::OutputOptions& output);

/// Refuses a deck that can't be, before the mesh is written. @throws as formats::require_deck.
void require_solver_deck(const pipeline::MeshBoardResult& result, const std::filesystem::path& mesh_file);

/// Writes the deck beside the first mesh file. @throws as formats::write_deck.
[[nodiscard]] formats::Deck write_solver_deck(const pipeline::MeshBoardResult& result, const std::filesystem::path& mesh_file,
                                              Diagnostics& diagnostics);

/// "Run it:" and the one command, quoted for a shell; it names this program if that is not on the path.
[[nodiscard]] std::string run_text(const formats::Deck& deck);

}  // namespace pcbmesh::cli
