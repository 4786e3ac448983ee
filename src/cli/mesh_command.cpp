// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/formats/registry.hpp"
#include "pcbmesh/pipeline/mesh_board.hpp"
#include "pcbmesh/pipeline/write_outputs.hpp"
#include "src/cli/commands.hpp"
#include "src/cli/explain_text.hpp"
#include "src/cli/mesh_report.hpp"
#include "src/cli/quality_text.hpp"
#include "src/cli/study_options.hpp"
#include "src/cli/terminal.hpp"

namespace pcbmesh::cli {
namespace {

struct Options {
  std::string board, from, to, msh_version, mfem_version;
  std::vector<std::string> outputs;
  bool ascii = false, no_check = false, json = false, dry_run = false, quality = false, explain = false, quiet = false,
       warnings_as_errors = false;
  int threads = 2;
  std::shared_ptr<StudyOptions> study;
};

void require_no_warnings(const Options& options, const Diagnostics& diagnostics) {
  if (options.warnings_as_errors && diagnostics.num_warnings() > 0)
    throw Error(ErrorCode::board_invalid,
                fmt::format("{} warnings, and --warnings-as-errors is on", diagnostics.num_warnings()));
}

pipeline::OutputOptions output_options(const Options& options, LengthUnit unit) {
  if (options.outputs.empty() && !options.dry_run)
    throw Error(ErrorCode::usage, "no output: give -o board.msh, or --dry-run for the counts alone");
  return {{options.outputs.begin(), options.outputs.end()},
          options.to,
          {!options.ascii, unit, options.msh_version, options.mfem_version},
          !options.no_check,
          options.threads};
}

int run(const Options& options) {
  const study::Study study = study_from(*options.study);
  const pipeline::OutputOptions output = output_options(options, study.unit);
  pipeline::require_writable(output, options.board);
  const Progress progress = terminal_progress(options.quiet);
  progress.at("read", 0);
  const formats::ReadBoardResult read = formats::read_board(options.board, options.from, progress);
  pipeline::MeshBoardResult result = pipeline::mesh_board(read.board, study, progress);
  Diagnostics all = read.diagnostics;
  all.merge(result.diagnostics);
  result.diagnostics = std::move(all);
  clear_progress();
  if (!options.quiet) print_diagnostics(result.diagnostics);
  require_no_warnings(options, result.diagnostics);

  MeshRun mesh_run{read.board, result, {}, {}, nullptr, {}};
  // For a mesh that is thrown away the tables are made only where somebody will see them.
  const bool is_kept = !options.dry_run || options.json;
  if (is_kept || options.quality) mesh_run.quality = layering::quality_report(result.mesh);
  if (is_kept || options.explain) mesh_run.layers = layering::explain_layers(result.mesh, result.layers);
  pipeline::OutputResult written;
  if (!options.dry_run) {
    written = pipeline::write_outputs(result, output, progress);
    if (written.report) mesh_run.check = &*written.report;
    mesh_run.second_order = written.second_order;
    const std::filesystem::path summary = pipeline::file_beside(output.meshes.front(), ".report.json");
    mesh_run.files = written.files;
    mesh_run.files.push_back(summary.string());
    pipeline::write_text_file(summary, report_json(mesh_run));
  }
  clear_progress();
  if (options.json)
    fmt::print("{}\n", report_json(mesh_run));
  else if (!options.quiet)
    fmt::print("{}{}{}", report_text(mesh_run), options.explain ? explain_text(result, mesh_run.layers) : "",
               options.quality ? quality_text(mesh_run.quality) : "");
  return written.report && !written.report->passed() ? 1 : 0;
}

}  // namespace

Command add_mesh_command(CLI::App& program) {
  CLI::App* command = program.add_subcommand("mesh", "Mesh a board, or a region of it, into tagged prisms");
  auto options = std::make_shared<Options>();
  command->add_option("board", options->board, "Board file: KiCad .kicad_pcb or native .json; .gz and .xz are unpacked")
      ->required();
  command->add_option("-o,--output", options->outputs, "Mesh file; its ending picks the format, see 'pcbmesh formats'; repeatable")
      ->allow_extra_args(false);
  constexpr const char* output = "Output";
  command->add_flag("--ascii", options->ascii, "Text instead of binary, where the format has both")->group(output);
  command->add_option("--msh-version", options->msh_version, "Gmsh format: 4.1 (default) or 2.2 (GetDP, Palace, Elmer)")
      ->check(CLI::IsMember({"4.1", "2.2"}))
      ->group(output);
  command->add_option("--mfem-version", options->mfem_version, "MFEM format: 1.3 (default, named sets) or 1.0")
      ->check(CLI::IsMember({"1.3", "1.0"}))
      ->group(output);
  command->add_option("--from", options->from, "Format of the board (default: by content and name)")->group(output);
  command->add_option("--to", options->to, "Format of the mesh (default: by ending)")->group(output);
  command->add_flag("--no-check", options->no_check, "Do not read the written mesh back and judge it")->group(output);
  command->add_flag("--dry-run", options->dry_run, "Do everything but write: exact counts")->group(output);
  command->add_flag("--json", options->json, "Print the report as JSON")->group(output);
  command->add_flag("--quality", options->quality, "Print quality by layer, material and net, histograms and the worst prisms")
      ->group(output);
  command
      ->add_flag("--explain", options->explain,
                 "Print per layer the heights, who forced them, prisms and quality before and after, and the choice of matched")
      ->group(output);
  command->add_flag("--quiet", options->quiet, "Print errors alone")->group(output);
  command->add_flag("--warnings-as-errors", options->warnings_as_errors, "Stop if anything was skipped or assumed")
      ->group(output);
  command->add_option("--threads", options->threads, "Threads (default 2); the result is the same for any number")
      ->check(CLI::Range(1, 256))
      ->group(output);
  options->study = add_study_options(*command);
  command->footer(
      "Beside board.msh appear board.tags.json (what each tag means), board.resolved.json (every choice, filled in) and\n"
      "board.report.json (counts, quality, times, moves, verdict).\n\n"
      "Examples:\n"
      "  pcbmesh mesh board.kicad_pcb -o board.msh\n"
      "  pcbmesh mesh board.kicad_pcb --nets /USB_P,/USB_N --frequency 10GHz -o usb.msh -o usb.vtu\n"
      "  pcbmesh mesh board.kicad_pcb --region 10mm,-30mm,25mm,-18mm --hollow GND -o part.msh\n"
      "  pcbmesh mesh examples/serpentine.json --air 0 --policy minimum --sublayers floor -o serpentine.msh");
  return {command, [options] { return run(*options); }};
}

}  // namespace pcbmesh::cli
