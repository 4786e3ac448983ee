// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/cli/mesh_or_draw.hpp"

#include <fmt/format.h>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/pipeline/write_outputs.hpp"
#include "pcbmesh/view/refusal.hpp"
#include "src/cli/terminal.hpp"

namespace pcbmesh::cli {

pipeline::MeshBoardResult mesh_or_draw(const board::Board& board, const study::Study& study,
                                       const std::filesystem::path& study_file, const std::filesystem::path& output,
                                       const Progress& progress) {
  try {
    return pipeline::mesh_board(board, study, progress);
  } catch (const Error& told) {
    const Error error =
        study_file.empty() ? told : Error(told.code(), study::with_lines(told.text(), study_file), told.spot(), told.ids());
    if (!error.spot().at_mm || output.empty()) throw error;
    const std::filesystem::path picture = pipeline::file_beside(output, ".refusal.svg");
    try {
      pipeline::write_text_file(picture, view::refusal_svg(board, error));
    } catch (const Error&) {
      throw error;  // the reason counts more than its picture
    }
    clear_progress();
    fmt::print(stderr, "pcbmesh: the place is drawn in {}\n", picture.string());
    throw error;
  }
}

}  // namespace pcbmesh::cli
