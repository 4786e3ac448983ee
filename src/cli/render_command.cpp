// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/formats/registry.hpp"
#include "pcbmesh/pipeline/mesh_board.hpp"
#include "pcbmesh/pipeline/write_outputs.hpp"
#include "pcbmesh/view/cell_render.hpp"
#include "pcbmesh/view/render.hpp"
#include "src/cli/commands.hpp"
#include "src/cli/mesh_input.hpp"
#include "src/cli/mesh_or_draw.hpp"
#include "src/cli/picture_options.hpp"
#include "src/cli/study_options.hpp"
#include "src/cli/terminal.hpp"

namespace pcbmesh::cli {
namespace {

struct Options {
  std::string board, from, output, title, input_unit;
  bool quiet = false, json = false;
  std::shared_ptr<StudyOptions> study;
  std::shared_ptr<PictureFlags> picture;
};

/// A picture and what is in it.
struct Drawn {
  std::string picture;
  std::int64_t num_cells = 0;
  view::SkinCount visible;  ///< worked out for --json alone
};

Drawn draw(const Options& options, const mesh::PrismMesh& mesh, bool is_png) {
  const view::PictureOptions picture = picture_options(*options.picture, shown_names(mesh));
  Drawn out{{}, mesh.num_prisms(), {}};
  if (options.json) out.visible = view::count_skin(mesh, picture.visibility);
  const bool is_plan = options.picture->view == "top" && !picture.visibility.section;
  if (is_png) {
    out.picture = view::render_png(mesh, picture);
  } else if (!is_plan) {
    out.picture = view::render_picture_svg(mesh, picture, options.title);
  } else {
    view::PlanOptions plan;
    plan.width = picture.width;
    plan.visibility = picture.visibility;
    plan.colour = picture.colour;
    plan.edges = options.picture->edges == "on";
    plan.background = picture.background;
    out.picture = view::render_plan_svg(mesh, plan, options.title);
  }
  return out;
}

Drawn draw(const Options& options, const MeshInput& input, bool is_png) {
  const view::CellMesh mesh(input.cells, input.unit_m, input.tags ? &*input.tags : nullptr, show_box(*options.picture));
  view::PictureOptions picture = picture_options(*options.picture, shown_names(mesh));
  if (options.picture->colour.empty()) picture.colour = view::colour_modes_of(mesh).front();
  Drawn out{{}, mesh.num_cells(), {}};
  if (options.json) out.visible = view::count_cell_skin(mesh, picture.visibility);
  out.picture = is_png ? view::render_png(mesh, picture) : view::render_picture_svg(mesh, picture, options.title);
  return out;
}

int run(const Options& options) {
  const std::string ending = std::filesystem::path(options.output).extension().string();
  if (ending != ".png" && ending != ".svg")
    throw Error(ErrorCode::usage, fmt::format("-o '{}': a picture ends in .png or .svg", options.output));
  static_cast<void>(view::parse_camera(options.picture->view));
  if (!options.picture->colour.empty()) static_cast<void>(view::parse_colour_mode(options.picture->colour));
  const study::Study study = study_from(*options.study);
  const Progress progress = terminal_progress(options.quiet);
  progress.at("read", 0);
  std::optional<MeshInput> input = read_if_mesh(options.board, options.input_unit, progress);
  if (!input) {
    const formats::ReadBoardResult read = formats::read_board(options.board, options.from, progress);
    input = MeshInput{.prisms = mesh_or_draw(read.board, study, options.output, progress).mesh};
  }
  progress.at("draw", 0);
  const bool is_png = ending == ".png";
  const Drawn drawn = input->prisms ? draw(options, *input->prisms, is_png) : draw(options, *input, is_png);
  clear_progress();
  pipeline::write_binary_file(options.output, drawn.picture);
  if (options.json) {
    fmt::print("{}\n", nlohmann::ordered_json{{"picture", options.output},
                                              {"bytes", drawn.picture.size()},
                                              {input->prisms ? "prisms" : "cells", drawn.num_cells},
                                              {"visible_triangles", drawn.visible.num_triangles},
                                              {"visible_quads", drawn.visible.num_quads}}
                           .dump(2));
  } else if (!options.quiet)
    fmt::print("{}: {} {}, {} bytes\n", options.output, grouped(drawn.num_cells), input->prisms ? "prisms" : "cells",
               grouped(static_cast<std::int64_t>(drawn.picture.size())));
  return 0;
}

}  // namespace

Command add_render_command(CLI::App& program) {
  CLI::App* command =
      program.add_subcommand("render", "Draw a board's mesh or any mesh file: PNG, or SVG (--view top: true vectors)");
  auto options = std::make_shared<Options>();
  command->add_option("board", options->board, "Board file, as for mesh; or a mesh file of any format that check reads")
      ->required();
  command->add_option("-o,--output", options->output, "Picture: .png or .svg")->required();
  command->add_option("--title", options->title, "Title of an SVG");
  command->add_option("--from", options->from, "Format of the board (default: by content and name)");
  command->add_option("--input-unit", options->input_unit,
                      "Unit of a mesh file: m, mm, um (default: from the tags.json beside it, else m)");
  command->add_flag("--json", options->json, "Print as JSON: counts of prisms and visible faces, bytes");
  command->add_flag("--quiet", options->quiet, "Print errors alone");
  options->picture = add_picture_flags(*command);
  options->study = add_study_options(*command);
  command->footer(
      "Examples:\n"
      "  pcbmesh render board.kicad_pcb -o board.png\n"
      "  pcbmesh render board.kicad_pcb -o top.svg --view top --layers F.Cu --colour net\n"
      "  pcbmesh render board.kicad_pcb -o layers.png --explode 1 --background dark\n"
      "  pcbmesh render board.kicad_pcb -o cut.png --section y=12mm --thickness 4 --colour q_p\n"
      "  pcbmesh render tetrahedra.msh -o cells.png --input-unit mm --section x=3mm");
  return {command, [options] { return run(*options); }};
}

}  // namespace pcbmesh::cli
