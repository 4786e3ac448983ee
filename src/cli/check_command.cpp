// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/formats/registry.hpp"
#include "pcbmesh/validation/report.hpp"
#include "src/cli/commands.hpp"
#include "src/cli/terminal.hpp"

namespace pcbmesh::cli {
namespace {

struct Options {
  std::string mesh, tags, format;
  bool no_tags = false, json = false, quiet = false;
  int threads = 2;
};

/// "board.msh" -> "board.tags.json", if that file is there.
std::string tags_beside(const std::string& mesh) {
  std::filesystem::path file(mesh);
  if (file.extension() == ".gz") file.replace_extension();
  file.replace_extension(".tags.json");
  return std::filesystem::exists(file) ? file.string() : std::string();
}

int run(const Options& options) {
  if (options.no_tags && !options.tags.empty()) throw Error(ErrorCode::usage, "--tags and --no-tags exclude each other");
  const std::string tags = options.no_tags ? "" : !options.tags.empty() ? options.tags : tags_beside(options.mesh);
  validation::Expectation expectation;
  if (!tags.empty()) expectation = validation::read_expectation(tags);
  const Progress progress = terminal_progress(options.quiet);
  progress.at("read", 0);
  const mesh::MeshData mesh = formats::read_mesh(options.mesh, options.format, progress);
  progress.at("check", 0.5);
  const validation::Report report = validation::check(mesh, tags.empty() ? nullptr : &expectation, {options.threads});
  clear_progress();
  if (options.json) {
    fmt::print("{}\n", validation::to_json(report));
  } else {
    fmt::print("{}{}\n{}", options.mesh,
               tags.empty() ? " (no tags.json: checked for what the mesh itself promises)" : " against " + tags,
               validation::to_text(report));
  }
  return report.passed() ? 0 : 1;
}

}  // namespace

Command add_check_command(CLI::App& program) {
  CLI::App* command =
      program.add_subcommand("check", "Judge a mesh: conformity, volumes, tags, nets; exit code 1 with findings");
  auto options = std::make_shared<Options>();
  command->add_option("mesh", options->mesh, "Mesh file (.msh)")->required();
  command->add_option("--tags", options->tags, "tags.json to check against (default: the one beside the mesh)");
  command->add_flag("--no-tags", options->no_tags, "Check only what the mesh itself promises");
  command->add_option("--format", options->format, "Format of the mesh (default: by content and name)");
  command->add_flag("--json", options->json, "Print the report as JSON");
  command->add_flag("--quiet", options->quiet, "No progress line");
  command->add_option("--threads", options->threads, "Threads (default 2)")->check(CLI::Range(1, 256));
  command->footer("Examples:\n  pcbmesh check board.msh\n  pcbmesh check board.msh --json | jq .findings");
  return {command, [options] { return run(*options); }};
}

}  // namespace pcbmesh::cli
