// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/deck/deck_file.hpp"

#include <fmt/format.h>

#include "formats/sink/file_sink.hpp"

namespace pcbmesh::formats::deck {

void put_file(const std::filesystem::path& file, std::string_view text, Deck& deck) {
  FileSink sink(file);
  sink.put(text);
  sink.commit();
  deck.files.push_back(file);
}

void put_run_script(const std::filesystem::path& file, std::string_view what, std::string_view body, Deck& deck) {
  put_file(file, fmt::format("#!/bin/sh\n# {}\nset -eu\ncd \"$(dirname \"$0\")\"\n{}", what, body), deck);
  deck.command = {"sh", file.string()};
}

ResultFiles result_files(const FieldProblem& problem, std::string_view judged_by) {
  const std::string stem = problem.stem();
  const auto table = [&](const char* ending) {
    const std::string name = plain(stem) + ending;
    return ResultFiles{name, name, "cat " + shell_word(name) + "\n"};
  };
  if (problem.options.problem == Problem::eigenmode) return table(".modes.txt");
  if (problem.options.problem == Problem::electrostatic) return table(".capacitance.txt");
  const std::string rows = plain(stem) + ".ports.txt", network = fmt::format("{}.s{}p", stem, problem.ports.size());
  return {
      rows, network,
      fmt::format("if command -v \"${{PCBMESH:=pcbmesh}}\" > /dev/null; then\n  \"$PCBMESH\" touchstone {0} -o {1}{4}\nelse\n  "
                  "echo \"pcbmesh is not on the path; run: pcbmesh touchstone {2} -o {3}{4}\" >&2\n  exit 1\nfi\n",
                  shell_word(rows), shell_word(network), rows, plain(network), judged_by)};
}

void put_run_script(const std::filesystem::path& folder, const FieldProblem& problem, std::string_view solver,
                    std::string_view environment, std::string_view body, Deck& deck) {
  const ResultFiles results = result_files(problem);
  put_run_script(folder / (problem.stem() + ".run.sh"),
                 fmt::format("Solves {} with {} and ends in {}. {}", plain(problem.options.mesh), solver, plain(results.final),
                             environment),
                 fmt::format("{}\n{}", body, results.after), deck);
  deck.result = results.final;
  deck.calls_pcbmesh = problem.options.problem == Problem::driven;
}

}  // namespace pcbmesh::formats::deck
