// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/formats/registry.hpp"
#include "pcbmesh/pipeline/write_outputs.hpp"
#include "pcbmesh/validation/certificate.hpp"
#include "pcbmesh/validation/codes.hpp"
#include "pcbmesh/validation/outputs.hpp"
#include "pcbmesh/validation/profiles.hpp"
#include "pcbmesh/validation/report.hpp"
#include "src/cli/commands.hpp"
#include "src/cli/mesh_input.hpp"
#include "src/cli/terminal.hpp"

namespace pcbmesh::cli {
namespace {

struct Options {
  std::string mesh, tags, format, explain, junit, sarif, html, offenders, limits, profile, certificate, netlist, board;
  std::string fail_on = "error";
  bool no_tags = false, json = false, quiet = false, list = false;
  int threads = 2;
};

/// The tags.json of a mesh, if there is one.
std::string find_tags(const std::string& mesh) {
  const std::filesystem::path file = tags_beside(mesh);
  return std::filesystem::exists(file) ? file.string() : std::string();
}

void write_reports(const Options& options, const validation::Report& report, const mesh::MeshData& mesh,
                   validation::FindingSeverity threshold) {
  if (!options.junit.empty()) pipeline::write_binary_file(options.junit, validation::to_junit(report, options.mesh, threshold));
  if (!options.sarif.empty()) pipeline::write_binary_file(options.sarif, validation::to_sarif(report, options.mesh));
  if (!options.html.empty()) pipeline::write_binary_file(options.html, validation::to_html(report, options.mesh));
  if (!options.offenders.empty()) pipeline::write_binary_file(options.offenders, validation::to_offenders_vtu(report, mesh));
}

int explain(const std::string& code) {
  const validation::CheckCode* entry = validation::find_check_code(code);
  if (!entry) throw Error(ErrorCode::usage, fmt::format("--explain: no check has the code \"{}\"; --list shows all", code));
  fmt::print("{}", validation::explain_check_code(*entry));
  return 0;
}

const validation::Profile* profile_named(const std::string& name) {
  if (const validation::Profile* profile = validation::find_profile(name)) return profile;
  std::string all;
  for (const validation::Profile* profile : validation::all_profiles()) {
    all += fmt::format("{}{} ({})", all.empty() ? "" : "; ", profile->name, profile->title);
  }
  throw Error(ErrorCode::usage, fmt::format("--profile: there is no profile \"{}\". There are: {}", name, all));
}

/// A report must not land on what it reports on, nor two reports in one file.
void require_distinct_files(const Options& options, const std::string& tags) {
  std::vector<std::filesystem::path> taken;
  for (const std::string& file : {options.mesh, tags, options.limits, options.certificate, options.junit, options.sarif,
                                  options.html, options.offenders}) {
    if (file.empty()) continue;
    const std::filesystem::path full = std::filesystem::weakly_canonical(file);
    if (std::ranges::find(taken, full) != taken.end()) {
      throw Error(ErrorCode::usage, fmt::format("{} is named twice; every report needs a file of its own", file));
    }
    taken.push_back(full);
  }
}

int run(const Options& options) {
  if (options.list) {
    fmt::print("{}", validation::list_check_codes());
    return 0;
  }
  if (!options.explain.empty()) return explain(options.explain);
  if (options.mesh.empty()) throw Error(ErrorCode::usage, "check needs a mesh file, --list or --explain CODE");
  if (options.no_tags && !options.tags.empty()) throw Error(ErrorCode::usage, "--tags and --no-tags exclude each other");
  const std::string tags = options.no_tags ? "" : !options.tags.empty() ? options.tags : find_tags(options.mesh);
  require_distinct_files(options, tags);
  const auto threshold =
      options.fail_on == "warning" ? validation::FindingSeverity::warning : validation::FindingSeverity::error;
  if (!options.certificate.empty() && tags.empty())
    throw Error(ErrorCode::usage,
                "--certificate compares every check of the run, so it needs the tags.json of the mesh: give --tags");
  validation::CheckOptions check{.num_threads = options.threads};
  if (!options.limits.empty()) check.limits = validation::read_limits(options.limits);
  if (!options.profile.empty()) check.profile = profile_named(options.profile);
  std::optional<validation::Certificate> certificate;
  if (!options.certificate.empty()) certificate = validation::read_certificate(options.certificate);
  validation::Expectation expectation;
  if (!tags.empty()) expectation = validation::read_expectation(tags);
  const Progress progress = terminal_progress(options.quiet);
  progress.at("read", 0);
  const mesh::MeshData mesh = formats::read_mesh(options.mesh, options.format, progress);
  progress.at("check", 0.5);
  validation::Expectation netlist;
  if (!options.netlist.empty()) {
    if (tags.empty())
      throw Error(ErrorCode::usage, "--netlist compares nets, so it needs the tags.json of the mesh: give --tags");
    netlist = validation::read_expectation(options.netlist);
    check.netlist = &netlist;
  }
  validation::Report report = validation::check(mesh, tags.empty() ? nullptr : &expectation, check);
  if (!options.board.empty()) {
    progress.at("board", 0.9);
    pipeline::name_features(formats::read_board(options.board, "", progress).board, tags.empty() ? 1.0 : expectation.unit_m,
                            report);
  }
  if (certificate) validation::check_certificate(*certificate, options.mesh, tags, expectation.unit_m, report);
  clear_progress();
  write_reports(options, report, mesh, threshold);
  if (options.json) {
    fmt::print("{}\n", validation::to_json(report));
  } else {
    fmt::print("{}{}\n{}", options.mesh,
               tags.empty() ? " (no tags.json: checked for what the mesh itself promises)" : " against " + tags,
               validation::to_text(report));
  }
  return validation::fails_at(report, threshold) ? 1 : 0;
}

}  // namespace

Command add_check_command(CLI::App& program) {
  CLI::App* command =
      program.add_subcommand("check", "Judge a mesh: conformity, volumes, tags, nets; exit code 1 with findings");
  auto options = std::make_shared<Options>();
  command->add_option("mesh", options->mesh, "Mesh file (.msh, .mesh; .gz and .xz are unpacked)");
  command->add_option("--tags", options->tags, "tags.json to check against (default: the one beside the mesh)");
  command->add_option("--netlist", options->netlist, "Judge nets by the tags.json of another mesh of the same layout")
      ->check(CLI::ExistingFile);
  command->add_option("--board", options->board, "Board file: findings about nets name its nearest features")
      ->check(CLI::ExistingFile);
  command->add_flag("--no-tags", options->no_tags, "Check only what the mesh itself promises");
  command->add_option("--format", options->format, "Format of the mesh (default: by content and name)");
  command->add_flag("--json", options->json, "Print the report as JSON");
  command->add_option("--fail-on", options->fail_on, "Exit code 1 from this severity on: error (default) or warning")
      ->check(CLI::IsMember({"warning", "error"}));
  command->add_option("--profile", options->profile, "Rules of one solver too: palace, mfem, getdp, elmer, dolfinx");
  command->add_option("--limits", options->limits, "Bounds on the shape of cells (docs/schema/check-limits.schema.json)");
  command->add_option("--certificate", options->certificate, "Compare with the certificate written beside a mesh");
  command->add_option("--junit", options->junit, "Write a JUnit XML report for CI systems");
  command->add_option("--sarif", options->sarif, "Write a SARIF 2.1.0 report");
  command->add_option("--html", options->html, "Write a one-page HTML summary");
  command->add_option("--offenders", options->offenders,
                      "Write all offending cells, faces and nodes as VTU (at most 100,000 per finding)");
  command->add_flag("--list", options->list, "List every check code and end");
  command->add_option("--explain", options->explain, "Explain one check code and end");
  command->add_flag("--quiet", options->quiet, "No progress line");
  command->add_option("--threads", options->threads, "Threads (default 2)")->check(CLI::Range(1, 256));
  command->footer(
      "Examples:\n  pcbmesh check board.msh\n  pcbmesh check board.msh --json | jq .findings\n"
      "  pcbmesh check board.msh --fail-on warning --junit report.xml\n"
      "  pcbmesh check mesh.msh --profile palace --junit report.xml\n"
      "  pcbmesh check board.msh --certificate board.certificate.json\n"
      "  pcbmesh check --explain node.hanging");
  return {command, [options] { return run(*options); }};
}

}  // namespace pcbmesh::cli
