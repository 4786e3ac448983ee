// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

/// One command of the program per file. Each adds itself to the parser; the returned function runs it and gives the exit code.
namespace pcbmesh::cli {

/// A sub-command and what to do when it was chosen.
struct Command {
  CLI::App* parser = nullptr;
  std::function<int()> run;
};

[[nodiscard]] Command add_mesh_command(CLI::App& program);
[[nodiscard]] Command add_init_command(CLI::App& program);
[[nodiscard]] Command add_ports_command(CLI::App& program);
[[nodiscard]] Command add_inspect_command(CLI::App& program);
[[nodiscard]] Command add_render_command(CLI::App& program);
[[nodiscard]] Command add_view_command(CLI::App& program);
[[nodiscard]] Command add_check_command(CLI::App& program);
[[nodiscard]] Command add_convert_command(CLI::App& program);
[[nodiscard]] Command add_formats_command(CLI::App& program);
[[nodiscard]] Command add_touchstone_command(CLI::App& program);

}  // namespace pcbmesh::cli
