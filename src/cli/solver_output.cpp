// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/cli/solver_output.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <system_error>

#include "formats/deck/field_problem.hpp"
#include "pcbmesh/base/error.hpp"
#include "pcbmesh/formats/registry.hpp"

namespace pcbmesh::cli {
namespace {

/// "boards/usb.kicad_pcb.xz" gives "usb".
std::string board_stem(const std::string& board) {
  std::filesystem::path name = std::filesystem::path(board).filename();
  if (name.extension() == ".gz" || name.extension() == ".xz") name.replace_extension();
  return name.stem().string();
}

bool means_folder(const std::filesystem::path& output) {
  return output.filename().empty() || std::filesystem::is_directory(output) || !output.has_extension();
}

bool is_on_path(const std::string& program) {
  const char* path = std::getenv("PATH");  // NOLINT: one thread
  std::string rest = path == nullptr ? "" : path;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(':'), rest.size());
    if (::access((std::filesystem::path(rest.substr(0, end)) / program).c_str(), X_OK) == 0) return true;
    rest.erase(0, end + 1);
  }
  return false;
}

}  // namespace

bool writes_deck(const study::Study& study) {
  return study.solver != study::Solver::none && formats::has_deck(study::name_of(study.solver));
}

void prepare_for_solver(const study::Study& study, const std::string& board, pipeline::OutputOptions& output) {
  if (!writes_deck(study) || output.meshes.empty()) return;
  const formats::DeckFormat& solver = formats::find_deck_format(study::name_of(study.solver));
  std::string& version = solver.mesh.format == "mfem" ? output.write.mfem_version : output.write.version;
  if (!version.empty() && version != solver.mesh.version)
    throw Error(ErrorCode::usage, fmt::format("{} reads version {} of its mesh, not {}; leave --{}-version out", solver.name,
                                              solver.mesh.version, version, solver.mesh.format));
  if (!output.format.empty() && output.format != solver.mesh.format)
    throw Error(ErrorCode::usage,
                fmt::format("{} reads {}, not {}; leave --to out", solver.name, solver.mesh.format, output.format));
  std::filesystem::path& mesh = output.meshes.front();
  if (means_folder(mesh)) {
    output.makes_folder = true;
    mesh /= board_stem(board) + std::string(solver.mesh.ending);
  }
  const formats::MeshFormat* format = formats::find_mesh_format(mesh, output.format);
  if (format != nullptr && format->name != solver.mesh.format)
    throw Error(ErrorCode::usage,
                fmt::format("{} reads {}, not {}; name a file with the ending {}, or a folder", solver.name, solver.mesh.format,
                            format->name, solver.mesh.ending),
                {.file = mesh.string()});
  version = solver.mesh.version;
  output.write.binary = output.write.binary && solver.mesh.binary;
  output.write.one_number_space = solver.mesh.one_number_space;
}

void require_solver_deck(const pipeline::MeshBoardResult& result, const std::filesystem::path& mesh_file) {
  if (!writes_deck(result.resolved)) return;
  formats::require_deck(result.mesh, study::name_of(result.resolved.solver),
                        formats::deck_options(result.resolved, mesh_file.filename().string()));
}

formats::Deck write_solver_deck(const pipeline::MeshBoardResult& result, const std::filesystem::path& mesh_file,
                                Diagnostics& diagnostics) {
  const formats::DeckOptions options = formats::deck_options(result.resolved, mesh_file.filename().string());
  return formats::write_deck(result.mesh, study::name_of(result.resolved.solver), options, mesh_file.parent_path(),
                             diagnostics);
}

std::string run_text(const formats::Deck& deck) {
  std::string command;
  if (deck.calls_pcbmesh && !is_on_path("pcbmesh")) {
    std::error_code ignored;
    const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", ignored);
    if (!self.empty()) command = fmt::format("PCBMESH={} ", formats::deck::shell_word(self.string()));
  }
  for (std::size_t i = 0; i < deck.command.size(); ++i)
    command += (i > 0 ? " " : "") + formats::deck::shell_word(deck.command[i]);
  return fmt::format("Run it (ends in {}):\n  {}\n", deck.result, command);
}

}  // namespace pcbmesh::cli
