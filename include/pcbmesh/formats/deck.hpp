// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pcbmesh/base/diagnostics.hpp"
#include "pcbmesh/base/units.hpp"
#include "pcbmesh/mesh/prism_mesh.hpp"
#include "pcbmesh/study/study.hpp"

namespace pcbmesh::formats {

using study::Problem;

/// What a deck says beyond the mesh.
struct DeckOptions {
  Problem problem = Problem::driven;
  std::vector<double> frequencies_hz;   ///< driven: ascending, at least one, > 0
  study::Modes modes;                   ///< eigenmode
  std::string mesh;                     ///< name of the mesh file, in the deck's own folder
  LengthUnit unit = LengthUnit::metre;  ///< of the mesh file
};

/// What a study says, for a mesh file of that name.
[[nodiscard]] DeckOptions deck_options(const study::Study& study, std::string mesh);

/// A deck on disk.
struct Deck {
  std::vector<std::filesystem::path> files;  ///< written, in order
  std::vector<std::string> command;          ///< runs it from anywhere: program and arguments
  std::string result;                        ///< file that the command ends in, in the deck's folder
  bool calls_pcbmesh = false;                ///< the command ends in one of pcbmesh itself
};

/// How a solver wants its mesh.
struct DeckMesh {
  std::string_view format, version, ending;
  bool binary = true;
  bool one_number_space = false;  ///< its reader does not tell face tags from volume tags
  bool tetrahedra = false;        ///< full wave wants the tetrahedral twin
};

/// A solver: plain data, listed in deck_formats().
struct DeckFormat {
  std::string_view name;
  std::string_view title;
  DeckMesh mesh;
  void (*require)(const mesh::PrismMesh& mesh, const DeckOptions& options);
  Deck (*write)(const mesh::PrismMesh& mesh, const DeckOptions& options, const std::filesystem::path& folder,
                Diagnostics& diagnostics);
};

[[nodiscard]] std::span<const DeckFormat* const> deck_formats();
/// @throws Error usage (101) listing the solvers.
[[nodiscard]] const DeckFormat& find_deck_format(std::string_view name);

/// Looks before anything is written. @throws Error study_invalid (102), format_limit (703) as write_deck does.
void require_deck(const mesh::PrismMesh& mesh, std::string_view solver, const DeckOptions& options);

/// Writes complete solver input beside a mesh file: every material, boundary, port, frequency. Files appear whole or not at
/// all. What the deck has to take for granted is a diagnostic (deck.*).
/// @throws Error study_invalid (102) when the problem is not well posed (no port, no frequency, one conductor alone);
/// format_limit (703) when the solver can't express it, with the nearest thing it can do; write_failed (701).
[[nodiscard]] Deck write_deck(const mesh::PrismMesh& mesh, std::string_view solver, const DeckOptions& options,
                              const std::filesystem::path& folder, Diagnostics& diagnostics);

}  // namespace pcbmesh::formats
