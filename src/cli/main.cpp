// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/base/version.hpp"
#include "src/cli/commands.hpp"
#include "src/cli/terminal.hpp"

namespace {

constexpr const char* about =
    "pcbmesh turns a board layout into a conformal, tagged prism mesh for field solvers.\n\n"
    "Examples:\n"
    "  pcbmesh inspect board.kicad_pcb                     layers, nets, sizes\n"
    "  pcbmesh init board.kicad_pcb --nets /USB_P,/USB_N -o usb.study.json\n"
    "  pcbmesh mesh board.kicad_pcb --study usb.study.json -o usb.msh\n"
    "  pcbmesh mesh board.kicad_pcb -o board.msh           the whole board\n"
    "  pcbmesh mesh board.kicad_pcb --nets /USB_P,/USB_N --margin 2mm --frequency 10GHz -o usb.msh\n"
    "  pcbmesh view board.kicad_pcb -o board.html          the mesh to look at, in any browser\n"
    "  pcbmesh render board.kicad_pcb -o board.png         a picture\n"
    "  pcbmesh check board.msh                             judge any mesh\n"
    "  pcbmesh convert board.msh board.exo                 any mesh into another format\n\n"
    "Exit codes: 0 fine, 1 findings, 2 usage, 3 input, 4 cannot mesh, 5 output, 70 bug, 130 cancelled.";

int run(int argc, char** argv) {
  CLI::App program{about, "pcbmesh"};
  program.set_version_flag("--version", std::string("pcbmesh ") + std::string(pcbmesh::version()));
  program.require_subcommand(1);
  program.get_formatter()->column_width(34);
  const std::array commands{pcbmesh::cli::add_mesh_command(program),       pcbmesh::cli::add_init_command(program),
                            pcbmesh::cli::add_ports_command(program),      pcbmesh::cli::add_inspect_command(program),
                            pcbmesh::cli::add_view_command(program),       pcbmesh::cli::add_render_command(program),
                            pcbmesh::cli::add_check_command(program),      pcbmesh::cli::add_formats_command(program),
                            pcbmesh::cli::add_touchstone_command(program), pcbmesh::cli::add_convert_command(program)};
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return program.exit(error) == 0 ? 0 : 2;
  }
  pcbmesh::cli::catch_signals();
  for (const pcbmesh::cli::Command& command : commands)
    if (command.parser->parsed()) return command.run();
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const pcbmesh::Error& error) {
    pcbmesh::cli::clear_progress();
    fmt::print(stderr, "pcbmesh: {}\n", error.what());
    return pcbmesh::exit_code(error.code());
  } catch (const std::bad_alloc&) {
    pcbmesh::cli::clear_progress();
    fmt::print(stderr, "pcbmesh: out of memory; mesh a region (--nets, --region) or take a longer edge\n");
    return 4;
  } catch (const std::exception& error) {
    pcbmesh::cli::clear_progress();
    fmt::print(stderr, "pcbmesh: {}; this is a bug, please report it with the input\n", error.what());
    return 70;
  }
}
