// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/formats/registry.hpp"
#include "pcbmesh/pipeline/mesh_board.hpp"
#include "pcbmesh/pipeline/write_outputs.hpp"
#include "pcbmesh/view/report.hpp"
#include "src/cli/commands.hpp"
#include "src/cli/mesh_input.hpp"
#include "src/cli/mesh_or_draw.hpp"
#include "src/cli/page_contents.hpp"
#include "src/cli/study_options.hpp"
#include "src/cli/terminal.hpp"

namespace pcbmesh::cli {
namespace {

struct Options {
  std::string board, from, output, input_unit;
  bool no_check = false, quiet = false;
  int threads = 2;
  std::shared_ptr<StudyOptions> study;
};

/// @param mesh  prisms or cells
template <class Mesh>
void write_page(const Options& options, const Mesh& mesh, const view::PageContents& contents, std::int64_t num_cells,
                std::string_view word, const Progress& progress) {
  progress.at("view", 0);
  const std::string page = view::report_html(mesh, contents);
  clear_progress();
  pipeline::write_binary_file(options.output, page);
  if (!options.quiet)
    fmt::print("{}: {} {}, {} bytes; open it in a browser\n", options.output, grouped(num_cells), word,
               grouped(static_cast<std::int64_t>(page.size())));
}

/// The page of a mesh file: what the mesh itself tells, and its check.
int run_mesh(const Options& options, const mesh::PrismMesh& mesh, const Progress& progress) {
  view::PageContents contents{.title = std::filesystem::path(options.board).stem().string(), .source = options.board};
  contents.quality = layering::quality_report(mesh);
  contents.facts = {{"prisms", grouped(mesh.num_prisms())}, {"nodes", grouped(mesh.num_nodes())}};
  if (!options.no_check) {
    progress.at("check", 0);
    const validation::Report report = validation::check(pipeline::expand(mesh), nullptr, {options.threads});
    contents.passed = report.passed();
    contents.places = view::places_of(report, 1.0);
  }
  for (view::PagePlace& place : view::places_of(contents.quality)) contents.places.push_back(std::move(place));
  write_page(options, mesh, contents, mesh.num_prisms(), "prisms", progress);
  return contents.passed.value_or(true) ? 0 : 1;
}

/// The page of a file of cells, checked against the tags.json beside it, if there is one.
int run_mesh(const Options& options, const MeshInput& input, const Progress& progress) {
  const view::CellMesh mesh(input.cells, input.unit_m, input.tags ? &*input.tags : nullptr);
  const view::CellQuality quality = mesh.quality();
  view::PageContents contents{.title = std::filesystem::path(options.board).filename().string(), .source = options.board};
  contents.facts = {{"Cells", grouped(mesh.num_cells())},
                    {"Nodes", grouped(static_cast<std::int64_t>(input.cells->nodes.size()))},
                    {"Unit", input.unit_source},
                    {"Format", fmt::format("{} {}", input.cells->format.name, input.cells->format.version)}};
  if (quality.num_measured > 0) {
    contents.facts.emplace_back("Mean quality", fmt::format("{:.4f} of {} cells", quality.mean, grouped(quality.num_measured)));
    contents.quality.histograms.push_back(quality.histogram);
  }
  if (!options.no_check) {
    progress.at("check", 0);
    const validation::Report report = validation::check(*input.cells, input.tags ? &*input.tags : nullptr, {options.threads});
    contents.passed = report.passed();
    contents.places = view::places_of(report, input.unit_m);
    contents.facts.emplace_back("Checked against", input.tags ? "tags.json" : "what the mesh itself promises");
  }
  for (view::PagePlace& place : view::places_of(mesh, quality)) contents.places.push_back(std::move(place));
  write_page(options, mesh, contents, mesh.num_cells(), "cells", progress);
  return contents.passed.value_or(true) ? 0 : 1;
}

int run(const Options& options) {
  const std::string ending = std::filesystem::path(options.output).extension().string();
  if (ending != ".html" && ending != ".htm")
    throw Error(ErrorCode::usage, fmt::format("-o '{}': a report ends in .html", options.output));
  const study::Study study = study_from(*options.study);
  const Progress progress = terminal_progress(options.quiet);
  progress.at("read", 0);
  if (const auto mesh = read_if_mesh(options.board, options.input_unit, progress))
    return mesh->prisms ? run_mesh(options, *mesh->prisms, progress) : run_mesh(options, *mesh, progress);
  const formats::ReadBoardResult read = formats::read_board(options.board, options.from, progress);
  pipeline::MeshBoardResult result = mesh_or_draw(read.board, study, options.output, progress);
  Diagnostics all = read.diagnostics;
  all.merge(result.diagnostics);
  result.diagnostics = std::move(all);
  MeshRun mesh_run{read.board, result, layering::quality_report(result.mesh), {}, nullptr, {}};
  validation::Report report;
  if (!options.no_check) {
    progress.at("check", 0);
    report = validation::check(pipeline::expand(result.mesh), nullptr, {options.threads});
    mesh_run.check = &report;
  }
  write_page(options, result.mesh, page_contents(mesh_run, 1.0), result.mesh.num_prisms(), "prisms", progress);
  return mesh_run.check != nullptr && !report.passed() ? 1 : 0;
}

}  // namespace

Command add_view_command(CLI::App& program) {
  CLI::App* command =
      program.add_subcommand("view", "Mesh a board, or read a mesh file, into one HTML page: 3D view, findings, quality");
  auto options = std::make_shared<Options>();
  command->add_option("board", options->board, "Board file, as for mesh; or a mesh file of any format that check reads")
      ->required();
  command->add_option("-o,--output", options->output, "The page, .html: one file, no network")->required();
  command->add_option("--from", options->from, "Format of the board (default: by content and name)");
  command->add_option("--input-unit", options->input_unit,
                      "Unit of a mesh file: m, mm, um (default: from the tags.json beside it, else m)");
  command->add_flag("--no-check", options->no_check, "Do not judge the mesh");
  command->add_flag("--quiet", options->quiet, "Print errors alone");
  command->add_option("--threads", options->threads, "Threads of the check (default 2)")->check(CLI::Range(1, 256));
  options->study = add_study_options(*command);
  command->footer(
      "'pcbmesh mesh ... --html report.html' writes the same page beside a mesh.\n\n"
      "Examples:\n"
      "  pcbmesh view board.kicad_pcb -o board.html\n"
      "  pcbmesh view board.kicad_pcb --nets /USB_P,/USB_N --frequency 10GHz -o usb.html\n"
      "  pcbmesh view tetrahedra.msh --input-unit mm -o cells.html");
  return {command, [options] { return run(*options); }};
}

}  // namespace pcbmesh::cli
