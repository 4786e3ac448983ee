// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pcbmesh/base/progress.hpp"
#include "pcbmesh/extrude/second_order_source.hpp"
#include "pcbmesh/formats/registry.hpp"
#include "pcbmesh/pipeline/mesh_board.hpp"
#include "pcbmesh/validation/report.hpp"

namespace pcbmesh::pipeline {

struct OutputOptions {
  std::vector<std::filesystem::path> meshes;  ///< mesh files; the first one names the files beside it
  std::string format;                         ///< mesh format; empty = by ending
  formats::WriteMeshOptions write;
  bool check = true;  ///< judge the mesh
  int num_threads = 1;
  std::filesystem::path board{};  ///< for the certificate; empty = not certified
  bool makes_folder = false;      ///< folder of the first mesh: made, where absent, before anything is written
};

struct OutputResult {
  std::vector<std::string> files;            ///< written, in order
  std::optional<validation::Report> report;  ///< empty if not asked for
  std::optional<extrude::SecondOrderStatistics> second_order{};
};

/// "out/board.msh" and ".tags.json" give "out/board.tags.json".
[[nodiscard]] std::filesystem::path file_beside(const std::filesystem::path& mesh, std::string_view ending);

/// Looks at every output before the work starts: folder there, format known, not the input itself.
/// @throws Error usage (101), write_failed (701).
void require_writable(const OutputOptions& options, const std::filesystem::path& input);

/// Writes the meshes, then x.tags.json (what each tag means) and x.resolved.json (the resolved study), then judges.
/// The verdict is on the first mesh file that can be read back, else on the mesh expanded in memory; with it comes
/// x.certificate.json (hashes of all files, counts of all checks, volumes beside their analytic values).
/// Every file appears whole or not at all. @throws Error write_failed (701), format_limit (703), cancelled (103).
[[nodiscard]] OutputResult write_outputs(const MeshBoardResult& result, const OutputOptions& options,
                                         const Progress& progress = Progress{});

/// Writes a small text file, whole or not at all. @throws Error write_failed (701).
void write_text_file(const std::filesystem::path& file, std::string_view text);
/// The same, byte for byte: write_text_file ends a last line that has no end.
void write_binary_file(const std::filesystem::path& file, std::string_view bytes);

/// The prisms and tagged faces written out: O(prisms) memory. For judging and converting, not for writing.
[[nodiscard]] mesh::MeshData expand(const mesh::PrismMesh& mesh);

/// Adds to findings about nets which feature of the board file lies nearest to the fault, for each net concerned.
/// @param unit_m  metres per unit of the places in the report.
void name_features(const board::Board& board, double unit_m, validation::Report& report);

}  // namespace pcbmesh::pipeline
