// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/formats/registry.hpp"
#include "pcbmesh/pipeline/start_study.hpp"
#include "pcbmesh/pipeline/write_outputs.hpp"
#include "src/cli/begin_study.hpp"
#include "src/cli/commands.hpp"
#include "src/cli/study_options.hpp"
#include "src/cli/terminal.hpp"

namespace pcbmesh::cli {
namespace {

struct Options {
  std::string board, from, output;
  bool quiet = false, force = false;
  std::shared_ptr<StudyOptions> study;
};

pipeline::StartedStudy started_from(const Options& options, BegunStudy begun, pipeline::PortPlaces places) {
  const Progress progress = terminal_progress(options.quiet);
  const formats::ReadBoardResult read = formats::read_board(options.board, options.from, progress);
  pipeline::StartedStudy started = settle_study(read.board, *options.study, std::move(begun), places);
  clear_progress();
  if (options.quiet) return started;
  print_diagnostics(read.diagnostics);
  print_diagnostics(started.diagnostics);
  for (const std::string& text : started.left_out) fmt::print(stderr, "no port at {}\n", text);
  return started;
}

void print_ports(std::FILE* to, const pipeline::StartedStudy& started) {
  fmt::print(to, "{} ports\n", started.study.ports.size());
  for (std::size_t i = 0; i < started.study.ports.size(); ++i) {
    const study::Port& port = started.study.ports[i];
    fmt::print(to, "  {:<6} net {} against {}: {}\n", port.name, port.net, port.reference, started.port_notes[i]);
  }
}

int run_init(const Options& options) {
  BegunStudy begun = begin_study(*options.study);
  if (begun.study.nets.empty())
    throw Error(ErrorCode::usage, "name the nets of interest, e.g. --nets /USB_P,/USB_N; `pcbmesh inspect` lists all");
  const std::filesystem::path file = options.output;
  const std::filesystem::path schema = file.parent_path() / "study.schema.json";
  if (!options.force && std::filesystem::exists(file))
    throw Error(ErrorCode::write_failed, "the file exists; --force overwrites it", {.file = file.string()});
  take_first_answers(*options.study, begun.study);
  const pipeline::StartedStudy started = started_from(options, std::move(begun), pipeline::PortPlaces::ends);
  const std::string note = fmt::format(
      "Begun for nets {}. Ports were placed where pins and planes allow; every field is explained in study.schema.json. Mesh "
      "it "
      "with: pcbmesh mesh BOARD --study {} -o NAME.msh",
      fmt::join(started.study.nets, ", "), file.filename().string());
  pipeline::write_text_file(file, study::to_json(started.study, {"study.schema.json", note, started.port_notes}));
  pipeline::write_text_file(schema, study::schema_text());
  if (!options.quiet) {
    print_ports(stdout, started);
    fmt::print("wrote {}\nwrote {}\nnext: pcbmesh mesh {} --study {} -o {}\n", file.string(), schema.string(), options.board,
               file.string(), file.stem().stem().string() + ".msh");
  }
  return 0;
}

int run_ports(const Options& options) {
  BegunStudy begun = begin_study(*options.study);
  begun.solver = study::Solver::none;
  if (begun.study.nets.empty())
    throw Error(ErrorCode::usage,
                "name the nets that ports are wanted for, e.g. --nets /USB_P,/USB_N; with --region they are cut "
                "there");
  begun.study.ports.clear();
  const pipeline::StartedStudy started = started_from(options, std::move(begun), pipeline::PortPlaces::ends_and_vias);
  if (!options.quiet) print_ports(stderr, started);
  fmt::print("{}", study::ports_json(started.study, {"", "", started.port_notes}));
  return started.study.ports.empty() ? 1 : 0;
}

std::shared_ptr<Options> add_options(CLI::App& command) {
  auto options = std::make_shared<Options>();
  command.add_option("board", options->board, "Board file")->required();
  command.add_option("--from", options->from, "Format of the board (default: by content and name)");
  command.add_flag("--quiet", options->quiet, "Print errors and the result alone");
  options->study = add_study_options(command);
  return options;
}

}  // namespace

Command add_init_command(CLI::App& program) {
  CLI::App* command = program.add_subcommand("init", "Begin a study of some nets: ports proposed, every choice written down");
  const auto options = add_options(*command);
  command->add_option("-o,--output", options->output, "Study file to write")->required();
  command->add_flag("--force", options->force, "Overwrite the study file");
  command->footer(
      "Beside the study appears study.schema.json, which explains every field in an editor.\n\n"
      "Example:\n  pcbmesh init board.kicad_pcb --nets /USB_P,/USB_N --for palace -o usb.study.json");
  return {command, [options] { return run_init(*options); }};
}

Command add_ports_command(CLI::App& program) {
  CLI::App* command = program.add_subcommand("ports", "Propose ports of some nets, as JSON ready to paste into a study");
  const auto options = add_options(*command);
  command->footer(
      "Ports are proposed at the pins of the nets, and, with --region, where the region cuts them: vertical over a plane, "
      "else\n"
      "across a gap (P1, P2 ...). Coaxial ones (C1, C2 ...) are rings in the antipads that vias of the nets pass: leave out\n"
      "those that are not wanted, or a line gets a port in its middle.\n\n"
      "Examples:\n  pcbmesh ports board.kicad_pcb --nets /USB_P,/USB_N\n"
      "  pcbmesh ports board.kicad_pcb --study s.json --nets /CLK --region 10mm,-30mm,25mm,-18mm");
  return {command, [options] { return run_ports(*options); }};
}

}  // namespace pcbmesh::cli
