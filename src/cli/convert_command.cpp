// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "formats/tags_json/tags_json.hpp"
#include "pcbmesh/base/error.hpp"
#include "pcbmesh/extrude/tetrahedral_source.hpp"
#include "pcbmesh/formats/registry.hpp"
#include "pcbmesh/mesh/mesh_data_source.hpp"
#include "pcbmesh/validation/report.hpp"
#include "src/cli/commands.hpp"
#include "src/cli/mesh_input.hpp"
#include "src/cli/terminal.hpp"

namespace pcbmesh::cli {
namespace {

struct Options {
  std::string in, out, from, to, msh_version, mfem_version, unit, input_unit, split;
  bool ascii = false, quiet = false;
};

/// A mesh file does not say its unit; the tags.json beside it may.
double input_unit_m(const Options& options) {
  if (!options.input_unit.empty()) return metres_per(parse_length_unit(options.input_unit));
  const std::filesystem::path tags = tags_beside(options.in);
  if (std::filesystem::exists(tags)) return validation::read_expectation(tags.string()).unit_m;
  throw Error(ErrorCode::usage,
              "--unit needs to know the unit of the input, and no tags.json lies beside it; give --input-unit m, mm or um",
              {.file = options.in});
}

/// The tags.json of the input becomes that of the output; its name, empty if there is none to hand on.
std::string carry_tags(const Options& options, const mesh::MeshSource& written) {
  const std::filesystem::path from = tags_beside(options.in), to = tags_beside(options.out);
  if (!std::filesystem::exists(from)) return {};
  const double old_unit_m = validation::read_expectation(from.string()).unit_m;
  const double unit_m = options.unit.empty() ? old_unit_m : metres_per(parse_length_unit(options.unit));
  if (std::filesystem::weakly_canonical(from) == std::filesystem::weakly_canonical(to)) {
    if (unit_m == old_unit_m && options.split.empty()) return to.string();
    fmt::print(
        stderr,
        "note: {} tells of the input, which has another unit or other cells; give the output another name, and it gets a "
        "tags.json of its own\n",
        from.string());
    return {};
  }
  formats::tags_json::carry_tags(from, to, unit_m, written);
  return to.string();
}

/// What goes into no file or only half: an engineer must not find out in the solver.
void say_what_is_lost(const mesh::MeshData& mesh, const mesh::MeshDataSource& read, const mesh::MeshSource& source,
                      const formats::MeshFormat& format) {
  const auto note = [](const std::string& text) { fmt::print(stderr, "note: {}\n", text); };
  static constexpr const char* others[] = {"points", "lines"};
  for (std::size_t i = 0; i < mesh.num_other_elements.size() && i < 2; ++i)
    if (mesh.num_other_elements[i] > 0)
      note(fmt::format("{} {} of the input are left out; meshes here hold faces and cells", mesh.num_other_elements[i],
                       others[i]));
  if (!mesh.periodic.empty())
    note(fmt::format("{} periodic links of the input are left out; no writer here has a word for them", mesh.periodic.size()));
  if (read.num_untagged_cells() > 0)
    note(fmt::format("{} cells have no tag; they are written as the group 'untagged'", read.num_untagged_cells()));
  std::int64_t num_faces = 0;
  for (const mesh::ElementBlock& block : source.blocks())
    if (mesh::dimension_of(block.kind) == 2 && format.scope.written != 0 && !formats::holds(format.scope.written, block.kind))
      num_faces += block.count;
  if (num_faces > 0)
    note(fmt::format("{} tagged faces are left out; {} holds none of their kind here", num_faces, format.name));
  if (format.scope.written != 0 && !format.scope.has_names && !source.groups().empty())
    note(fmt::format("names of groups are not carried by {}; their tags are", format.name));
}

int run(const Options& options) {
  std::error_code ignored;
  if (std::filesystem::equivalent(options.in, options.out, ignored))
    throw Error(ErrorCode::usage, "the output would overwrite the input; give another name", {.file = options.out});
  const formats::MeshFormat* format = formats::find_mesh_format(options.out, options.to);
  if (format == nullptr || format->write == nullptr)
    throw Error(ErrorCode::usage,
                "no mesh format that pcbmesh writes has this ending; 'pcbmesh formats' lists them, --to NAME picks one",
                {.file = options.out});
  const Progress progress = terminal_progress(options.quiet);
  progress.at("read", 0);
  const mesh::MeshData mesh = formats::read_mesh(options.in, options.from, progress);
  // Without a unit the numbers go over as they are.
  const double unit_m = options.unit.empty() ? 1.0 : input_unit_m(options);
  mesh::MeshDataSource read(mesh, unit_m);
  std::optional<extrude::TetrahedralSource> tetrahedra;
  if (options.split == "tets") tetrahedra.emplace(read);
  mesh::MeshSource& source = tetrahedra ? static_cast<mesh::MeshSource&>(*tetrahedra) : read;
  progress.at("write", 0);
  const LengthUnit unit = options.unit.empty() ? LengthUnit::metre : parse_length_unit(options.unit);
  formats::WriteMeshOptions write{.binary = !options.ascii, .unit = unit, .version = options.msh_version};
  write.mfem_version = options.mfem_version;
  write.faces = true;  // all of the input, where the format leaves the choice
  formats::write_mesh(source, options.out, write, options.to, progress);
  clear_progress();
  const std::string tags = carry_tags(options, source);
  if (!options.quiet) {
    say_what_is_lost(mesh, read, source, *format);
    std::map<mesh::ElementKind, std::int64_t> counts;
    for (const mesh::ElementBlock& block : source.blocks()) counts[block.kind] += block.count;
    std::string text;
    for (const auto& [kind, count] : counts) text += fmt::format(", {} {}", count, mesh::name_of(kind));
    fmt::print("{}: {} nodes{}{}{}\n", options.out, source.num_nodes(), text, tags.empty() ? "" : "; ", tags);
  }
  return 0;
}

}  // namespace

Command add_convert_command(CLI::App& program) {
  CLI::App* command = program.add_subcommand("convert", "Convert any mesh that is read into any format that is written");
  auto options = std::make_shared<Options>();
  command->add_option("in", options->in, "Mesh file to be read; .gz and .xz are unpacked")->required();
  command->add_option("out", options->out, "Mesh file to be written; its ending picks the format")->required();
  command->add_option("--from", options->from, "Format of the input (default: by ending)");
  command->add_option("--to", options->to, "Format of the output (default: by ending)");
  command->add_flag("--ascii", options->ascii, "Text instead of binary, where the format has both");
  command->add_option("--msh-version", options->msh_version, "Gmsh format: 4.1 (default) or 2.2")
      ->check(CLI::IsMember({"4.1", "2.2"}));
  command->add_option("--mfem-version", options->mfem_version, "MFEM format: 1.3 (default, named sets) or 1.0")
      ->check(CLI::IsMember({"1.3", "1.0"}));
  command->add_option("--unit", options->unit, "Unit to be written: m, mm, um (default: numbers go over as they are)");
  command->add_option("--input-unit", options->input_unit, "Unit of the input (default: from the tags.json beside it)");
  command->add_option("--split", options->split, "tets: three tetrahedra per prism, same nodes and tags")
      ->check(CLI::IsMember({"none", "tets"}));
  command->add_flag("--quiet", options->quiet, "Print errors alone");
  command->footer(
      "Examples:\n  pcbmesh convert board.msh board.exo\n  pcbmesh convert thermal.mesh thermal.inp --unit mm --input-unit m\n"
      "  pcbmesh convert board.msh.gz tets.msh --split tets --msh-version 2.2\n  pcbmesh convert board.msh board.elmer");
  return {command, [options] { return run(*options); }};
}

}  // namespace pcbmesh::cli
