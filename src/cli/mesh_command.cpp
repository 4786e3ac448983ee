// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/formats/registry.hpp"
#include "pcbmesh/pipeline/mesh_board.hpp"
#include "pcbmesh/pipeline/write_outputs.hpp"
#include "pcbmesh/view/report.hpp"
#include "src/cli/begin_study.hpp"
#include "src/cli/commands.hpp"
#include "src/cli/explain_text.hpp"
#include "src/cli/mesh_or_draw.hpp"
#include "src/cli/mesh_report.hpp"
#include "src/cli/page_contents.hpp"
#include "src/cli/quality_text.hpp"
#include "src/cli/solver_output.hpp"
#include "src/cli/study_options.hpp"
#include "src/cli/terminal.hpp"

namespace pcbmesh::cli {
namespace {

struct Options {
  std::string board, from, to, msh_version, mfem_version, html, compression = "none", vtk_wedge = "legacy";
  std::vector<std::string> outputs;
  bool ascii = false, base64 = false, faces = false, no_check = false, json = false, dry_run = false, forecast = false,
       quality = false, explain = false, quiet = false, warnings_as_errors = false;
  int threads = 2, num_parts = 2, index_bits = 0;
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
  formats::WriteMeshOptions write{.binary = !options.ascii, .unit = unit, .version = options.msh_version};
  write.compression = options.compression == "zlib"  ? formats::Compression::zlib
                      : options.compression == "lz4" ? formats::Compression::lz4
                                                     : formats::Compression::none;
  write.mfem_version = options.mfem_version;
  write.base64 = options.base64;
  write.vtk_wedge = options.vtk_wedge == "parametric" ? formats::VtkWedge::parametric : formats::VtkWedge::legacy;
  write.faces = options.faces;
  write.num_parts = options.num_parts;
  write.index_bits = options.index_bits;
  write.num_threads = options.threads;
  return {
      {options.outputs.begin(), options.outputs.end()}, options.to, write, !options.no_check, options.threads, options.board};
}

/// A study begun from nets and a solver alone gets its ports; where they are is said.
study::Study with_ports(const board::Board& board, const Options& options, BegunStudy begun) {
  const std::string nets = fmt::format("{}", fmt::join(begun.study.nets, ", "));
  const std::size_t points = begun.study.sweep->frequencies_hz().size();
  pipeline::StartedStudy started = settle_study(board, *options.study, std::move(begun));
  if (options.quiet) return started.study;
  print_diagnostics(started.diagnostics);
  for (const std::string& text : started.left_out) fmt::print(stderr, "no port at {}\n", text);
  for (std::size_t i = 0; i < started.study.ports.size(); ++i)
    fmt::print(stderr, "port {} on net {} against {}: {}\n", started.study.ports[i].name, started.study.ports[i].net,
               started.study.ports[i].reference, started.port_notes[i]);
  fmt::print(stderr, "Begun for nets {}: {} frequencies; `pcbmesh init` writes such a study down for you to edit.\n", nets,
             points);
  return started.study;
}

int run(const Options& options) {
  BegunStudy begun = begin_study(*options.study);
  const bool is_begun_here = wants_ports(begun);
  if (is_begun_here) take_first_answers(*options.study, begun.study);
  study::Study study = is_begun_here ? begun.study : study_from(*options.study);
  study.solver = begun.solver;
  pipeline::OutputOptions output = output_options(options, study.unit);
  prepare_for_solver(study, options.board, output);
  pipeline::require_writable(output, options.board);
  const Progress progress = terminal_progress(options.quiet);
  progress.at("read", 0);
  const formats::ReadBoardResult read = formats::read_board(options.board, options.from, progress);
  if (is_begun_here) study = with_ports(read.board, options, std::move(begun));
  pipeline::MeshBoardResult result = mesh_or_draw(
      read.board, study, options.outputs.empty() ? std::filesystem::path() : std::filesystem::path(options.outputs.front()),
      progress);
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
  if (is_kept || options.forecast) mesh_run.measured = pipeline::measured(result.mesh);
  pipeline::OutputResult written;
  std::optional<formats::Deck> deck;
  if (!options.dry_run) {
    require_solver_deck(result, output.meshes.front());
    written = pipeline::write_outputs(result, output, progress);
    mesh_run.second_order = written.second_order;
    if (written.report) {
      const bool is_file = std::ranges::any_of(
          output.meshes, [&](const auto& file) { return formats::find_mesh_format(file, output.format)->read != nullptr; });
      pipeline::name_features(read.board, is_file ? metres_per(study.unit) : 1.0, *written.report);
      mesh_run.check = &*written.report;
    }
    const std::filesystem::path summary = pipeline::file_beside(output.meshes.front(), ".report.json");
    mesh_run.files = written.files;
    if (writes_deck(result.resolved)) {
      Diagnostics assumed;
      deck = write_solver_deck(result, output.meshes.front(), assumed);
      if (!options.quiet) print_diagnostics(assumed);
      result.diagnostics.merge(assumed);
      for (const std::filesystem::path& file : deck->files) mesh_run.files.push_back(file.string());
    }
    mesh_run.files.push_back(summary.string());
    if (!options.html.empty()) {
      progress.at("view", 0);
      mesh_run.files.push_back(options.html);
      pipeline::write_binary_file(options.html,
                                  view::report_html(result.mesh, page_contents(mesh_run, metres_per(study.unit))));
    }
    pipeline::write_text_file(summary, report_json(mesh_run));
  }
  clear_progress();
  if (options.json)
    fmt::print("{}\n", report_json(mesh_run));
  else if (!options.quiet)
    fmt::print("{}{}{}{}{}", report_text(mesh_run), options.forecast ? forecast_text(mesh_run) : "",
               options.explain ? explain_text(result, mesh_run.layers) : "",
               options.quality ? quality_text(mesh_run.quality) : "", deck ? run_text(*deck) : "");
  return written.report && !written.report->passed() ? 1 : 0;
}

}  // namespace

Command add_mesh_command(CLI::App& program) {
  CLI::App* command = program.add_subcommand("mesh", "Mesh a board, or a region of it, into tagged prisms");
  auto options = std::make_shared<Options>();
  command->add_option("board", options->board, "Board file: KiCad .kicad_pcb or native .json; .gz and .xz are unpacked")
      ->required();
  command
      ->add_option(
          "-o,--output", options->outputs,
          "Mesh file; its ending picks the format (.msh, .vtu, .xdmf ...; see 'pcbmesh formats'); repeatable. With --for: a "
          "folder for mesh and deck")
      ->allow_extra_args(false);
  constexpr const char* output = "Output";
  command->add_flag("--ascii", options->ascii, "Text instead of binary, where the format has both")->group(output);
  command->add_option("--msh-version", options->msh_version, "Gmsh format: 4.1 (default) or 2.2 (GetDP, Palace, Elmer)")
      ->check(CLI::IsMember({"4.1", "2.2"}))
      ->group(output);
  command->add_option("--mfem-version", options->mfem_version, "MFEM format: 1.3 (default, named sets) or 1.0")
      ->check(CLI::IsMember({"1.3", "1.0"}))
      ->group(output);
  command->add_option("--compress", options->compression, "VTK and HDF5 files: none (default), zlib or, for VTU, lz4")
      ->check(CLI::IsMember({"none", "zlib", "lz4"}))
      ->group(output);
  command->add_flag("--base64", options->base64, "VTU: arrays as base64 text, which makes it valid XML")->group(output);
  command
      ->add_option(
          "--vtk-wedge", options->vtk_wedge,
          "Corners of wedges in VTU and VTKHDF: legacy (default; VTK to 9.6, meshio, Gmsh) or parametric (VTK from 9.7)")
      ->check(CLI::IsMember({"legacy", "parametric"}))
      ->group(output);
  command->add_flag("--faces", options->faces, "VTU and PVTU: tagged faces as cells too")->group(output);
  command->add_option("--parts", options->num_parts, "PVTU: number of parts (default 2)")
      ->check(CLI::Range(1, 1000000))
      ->group(output);
  command->add_option("--index-bits", options->index_bits, "VTK and HDF5 files: 32 or 64 (default: 32 where they suffice)")
      ->check(CLI::IsMember({0, 32, 64}))
      ->group(output);
  command->add_option("--from", options->from, "Format of the board (default: by content and name)")->group(output);
  command->add_option("--to", options->to, "Format of the mesh (default: by ending)")->group(output);
  command->add_option("--html", options->html, "Also write a page to look at: 3D view, findings, quality; one file, no network")
      ->group(output);
  command->add_flag("--no-check", options->no_check, "Do not read the written mesh back and judge it")->group(output);
  command->add_flag("--dry-run", options->dry_run, "Do everything but write: exact counts")->group(output);
  command->add_flag("--forecast", options->forecast, "Print what was forecast, the exact counts, unknowns and solver memory")
      ->group(output);
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
      "Beside board.msh appear board.tags.json (what each tag means), board.resolved.json (every choice, filled in),\n"
      "board.report.json (counts, quality, times, moves, verdict) and board.certificate.json (hashes, checks, volumes;\n"
      "'pcbmesh check --certificate' compares).\n\n"
      "Examples:\n"
      "  pcbmesh mesh board.kicad_pcb -o board.msh\n"
      "  pcbmesh mesh board.kicad_pcb --nets /USB_P,/USB_N --frequency 10GHz -o usb.msh -o usb.vtu\n"
      "  pcbmesh mesh board.kicad_pcb --region 10mm,-30mm,25mm,-18mm --hollow GND -o part.msh\n"
      "  pcbmesh mesh board.kicad_pcb --nets /USB_P,/USB_N --for getdp -o out/\n"
      "  pcbmesh mesh examples/serpentine.json --air 0 --policy minimum --sublayers floor -o serpentine.msh");
  return {command, [options] { return run(*options); }};
}

}  // namespace pcbmesh::cli
