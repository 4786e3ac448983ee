// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/formats/registry.hpp"
#include "pcbmesh/pipeline/mesh_board.hpp"
#include "pcbmesh/pipeline/write_outputs.hpp"
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
  std::string board, from, output, title;
  bool quiet = false, json = false;
  std::shared_ptr<StudyOptions> study;
  std::shared_ptr<PictureFlags> picture;
};

std::string draw(const Options& options, const mesh::PrismMesh& mesh, const std::string& ending) {
  const view::PictureOptions picture = picture_options(*options.picture, mesh);
  if (ending == ".png") return view::render_png(mesh, picture);
  const bool is_plan = options.picture->view == "top" && !picture.visibility.section;
  if (!is_plan) return view::render_picture_svg(mesh, picture, options.title);
  view::PlanOptions plan;
  plan.width = picture.width;
  plan.visibility = picture.visibility;
  plan.colour = picture.colour;
  plan.edges = options.picture->edges == "on";
  plan.background = picture.background;
  return view::render_plan_svg(mesh, plan, options.title);
}

int run(const Options& options) {
  const std::string ending = std::filesystem::path(options.output).extension().string();
  if (ending != ".png" && ending != ".svg")
    throw Error(ErrorCode::usage, fmt::format("-o '{}': a picture ends in .png or .svg", options.output));
  static_cast<void>(view::parse_camera(options.picture->view));
  static_cast<void>(view::parse_colour_mode(options.picture->colour));
  const study::Study study = unchecked_study_from(*options.study);
  const Progress progress = terminal_progress(options.quiet);
  progress.at("read", 0);
  std::optional<mesh::PrismMesh> mesh = read_if_mesh(options.board, progress);
  if (!mesh) {
    const formats::ReadBoardResult read = formats::read_board(options.board, options.from, progress);
    mesh = mesh_or_draw(read.board, study, options.study->file, options.output, progress).mesh;
  }
  progress.at("draw", 0);
  const std::string picture = draw(options, *mesh, ending);
  clear_progress();
  pipeline::write_binary_file(options.output, picture);
  if (options.json) {
    const view::SkinCount faces = view::count_skin(*mesh, picture_options(*options.picture, *mesh).visibility);
    fmt::print("{}\n", nlohmann::ordered_json{{"picture", options.output},
                                              {"bytes", picture.size()},
                                              {"prisms", mesh->num_prisms()},
                                              {"visible_triangles", faces.num_triangles},
                                              {"visible_quads", faces.num_quads}}
                           .dump(2));
  } else if (!options.quiet)
    fmt::print("{}: {} prisms, {} bytes\n", options.output, grouped(mesh->num_prisms()),
               grouped(static_cast<std::int64_t>(picture.size())));
  return 0;
}

}  // namespace

Command add_render_command(CLI::App& program) {
  CLI::App* command = program.add_subcommand("render", "Draw a board's mesh: PNG, or SVG (--view top: true vectors)");
  auto options = std::make_shared<Options>();
  command->add_option("board", options->board, "Board file, as for mesh; or a .pcbmesh file")->required();
  command->add_option("-o,--output", options->output, "Picture: .png or .svg")->required();
  command->add_option("--title", options->title, "Title of an SVG");
  command->add_option("--from", options->from, "Format of the board (default: by content and name)");
  command->add_flag("--json", options->json, "Print as JSON: counts of prisms and visible faces, bytes");
  command->add_flag("--quiet", options->quiet, "Print errors alone");
  options->picture = add_picture_flags(*command);
  options->study = add_study_options(*command);
  command->footer(
      "Examples:\n"
      "  pcbmesh render board.kicad_pcb -o board.png\n"
      "  pcbmesh render board.kicad_pcb -o top.svg --view top --layers F.Cu --colour net\n"
      "  pcbmesh render board.kicad_pcb -o layers.png --explode 1 --background dark\n"
      "  pcbmesh render board.kicad_pcb -o cut.png --section y=12mm --thickness 4 --colour q_p");
  return {command, [options] { return run(*options); }};
}

}  // namespace pcbmesh::cli
