// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/formats/registry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "formats/abaqus/format.hpp"
#include "formats/balance/face_balance.hpp"
#include "formats/deck/one_number_space.hpp"
#include "formats/elmer/format.hpp"
#include "formats/exodus/format.hpp"
#include "formats/kicad/format.hpp"
#include "formats/mfem/format.hpp"
#include "formats/msh/format.hpp"
#include "formats/nastran/format.hpp"
#include "formats/native_json/format.hpp"
#include "formats/native_mesh/format.hpp"
#include "formats/syntax/input_file.hpp"
#include "formats/unv/format.hpp"
#include "formats/vtkhdf/format.hpp"
#include "formats/vtu/format.hpp"
#include "formats/xdmf/format.hpp"
#include "pcbmesh/base/error.hpp"
#include "pcbmesh/mesh/prism_source.hpp"

namespace pcbmesh::formats {
namespace {

// The tables: a new format is one include above and one line here.
constexpr std::array<const BoardFormat*, 2> board_table{&native_json::board_format, &kicad::board_format};
constexpr std::array<const MeshFormat*, 13> mesh_table{
    &msh::mesh_format,    &vtu::mesh_format,         &vtu::parallel_format, &vtu::multiblock_format, &xdmf::mesh_format,
    &vtkhdf::mesh_format, &native_mesh::mesh_format, &mfem::mesh_format,    &elmer::mesh_format,     &exodus::mesh_format,
    &abaqus::mesh_format, &nastran::mesh_format,     &unv::mesh_format};

constexpr std::size_t head_bytes = 4096;

std::string lower_case(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

/// File name in lower case, without .gz or .xz.
std::string plain_name(const std::filesystem::path& file) {
  std::string name = lower_case(file.filename().string());
  for (const std::string_view packed : {".gz", ".xz"})
    if (name.ends_with(packed)) name.resize(name.size() - packed.size());
  return name;
}

template <class Format>
const Format* find_by_name(std::span<const Format* const> table, std::string_view name) {
  const auto found = std::ranges::find(table, name, [](const Format* format) { return format->name; });
  return found == table.end() ? nullptr : *found;
}

template <class Format>
const Format* find_by_ending(std::span<const Format* const> table, const std::string& name) {
  for (const Format* format : table)
    for (const std::string_view ending : format->extensions)
      if (name.ends_with(ending)) return format;
  return nullptr;
}

/// "msh (.msh), vtu (.vtu)"
template <class Format>
std::string list_of(std::span<const Format* const> table) {
  std::string out;
  for (const Format* format : table) {
    out += fmt::format("{}{} (", out.empty() ? "" : ", ", format->name);
    for (std::size_t i = 0; i < format->extensions.size(); ++i)
      out += fmt::format("{}{}", i > 0 ? " " : "", format->extensions[i]);
    out += ")";
  }
  return out;
}

/// Start of the file for a message: one line, nothing a terminal could trip over.
std::string shown(std::string_view head) {
  std::string out;
  for (const char c : head.substr(0, 60)) out += c >= 0x20 && c < 0x7F ? c : '.';
  return out;
}

const BoardFormat* choose_board_format(const std::filesystem::path& file) {
  const std::string head = syntax::read_head(file, head_bytes), name = plain_name(file);
  std::vector<const BoardFormat*> sure, possible;
  for (const BoardFormat* format : board_formats()) {
    const Match match = format->sniff(head, name);
    if (match == Match::yes) sure.push_back(format);
    if (match != Match::no) possible.push_back(format);
  }
  if (sure.size() == 1) return sure.front();
  const BoardFormat* by_ending = find_by_ending(board_formats(), name);
  // An ending decides among candidates, and speaks up for a file no reader is sure of.
  if (by_ending != nullptr && (possible.empty() || std::ranges::count(possible, by_ending) > 0)) return by_ending;
  if (possible.size() == 1) return possible.front();
  const std::string_view why = possible.empty() ? "no reader knows this file" : "several readers claim this file";
  throw Error(ErrorCode::format_unknown,
              fmt::format("{}. It starts with '{}'. Board formats: {}; name one to force it", why, shown(head),
                          list_of(board_formats())),
              {.file = file.string()});
}

const MeshFormat& mesh_format_for(const std::filesystem::path& file, std::string_view format, ErrorCode code) {
  if (const MeshFormat* found = find_mesh_format(file, format)) return *found;
  throw Error(code,
              format.empty()
                  ? fmt::format("no mesh format has the ending of this file. Mesh formats: {}", list_of(mesh_formats()))
                  : fmt::format("there is no mesh format '{}'. Mesh formats: {}", format, list_of(mesh_formats())),
              {.file = file.string()});
}

/// Formats that have the wanted ability, for messages.
std::string names_with(auto ability) {
  std::string out;
  for (const MeshFormat* format : mesh_formats())
    if (format->*ability != nullptr) out += fmt::format("{}{}", out.empty() ? "" : ", ", format->name);
  return out;
}

/// Cells that the format has no word for are refused before the first byte. Faces may be left out: the table of formats says
/// so.
void require_kinds(const mesh::MeshSource& source, const MeshFormat& format, const std::filesystem::path& file) {
  if (format.scope.written == 0) return;
  for (const mesh::ElementBlock& block : source.blocks()) {
    if (mesh::dimension_of(block.kind) < 3 || holds(format.scope.written, block.kind)) continue;
    std::string known;
    for (int i = 0; i <= static_cast<int>(mesh::ElementKind::wedge18); ++i)
      if (const auto kind = static_cast<mesh::ElementKind>(i);
          mesh::dimension_of(kind) == 3 && holds(format.scope.written, kind))
        known += fmt::format("{}{}", known.empty() ? "" : ", ", mesh::name_of(kind));
    throw Error(ErrorCode::format_limit,
                fmt::format("the mesh has {} cells of kind {}, which {} does not hold; it holds {}{}", block.count,
                            mesh::name_of(block.kind), format.name, known,
                            block.kind == mesh::ElementKind::wedge18 && holds(format.scope.written, mesh::ElementKind::wedge15)
                                ? ". Give --wedge15"
                            : mesh::order_of(block.kind) == 2 ? ". Write the mesh with order 1, or second order as .msh"
                                                              : ""),
                {.file = file.string()});
  }
}

}  // namespace

std::span<const BoardFormat* const> board_formats() {
  return board_table;
}

std::span<const MeshFormat* const> mesh_formats() {
  return mesh_table;
}

const MeshFormat* find_mesh_format(const std::filesystem::path& file, std::string_view format) {
  return format.empty() ? find_by_ending(mesh_formats(), plain_name(file)) : find_by_name(mesh_formats(), format);
}

ReadBoardResult read_board(const std::filesystem::path& file, std::string_view format, const Progress& progress) {
  progress.check();
  if (format.empty()) return choose_board_format(file)->read(file, progress);
  if (const BoardFormat* found = find_by_name(board_formats(), format)) return found->read(file, progress);
  throw Error(ErrorCode::format_unknown,
              fmt::format("there is no board format '{}'. Board formats: {}", format, list_of(board_formats())),
              {.file = file.string()});
}

void write_mesh(const mesh::PrismMesh& mesh, const std::filesystem::path& file, const WriteMeshOptions& options,
                std::string_view format, const Progress& progress) {
  mesh::PrismSource source(mesh);
  write_mesh(source, file, options, format, progress);
}

void write_mesh(mesh::MeshSource& source, const std::filesystem::path& file, const WriteMeshOptions& options,
                std::string_view format, const Progress& progress) {
  progress.check();
  const MeshFormat& chosen = mesh_format_for(file, format, ErrorCode::usage);
  // Nothing is packed on writing: a name that promises it would lie.
  const std::string name = lower_case(file.filename().string());
  if (name.ends_with(".gz") || name.ends_with(".xz"))
    throw Error(ErrorCode::usage, "meshes are not packed on writing; leave out .gz or .xz and pack the file afterwards",
                {.file = file.string()});
  if (chosen.write == nullptr)
    throw Error(ErrorCode::usage,
                fmt::format("{} is not written, only read; these are: {}", chosen.name, names_with(&MeshFormat::write)),
                {.file = file.string()});
  require_kinds(source, chosen, file);
  // Only our own meshes promise a tagged hull; one from elsewhere is written as it is, holes and all.
  FaceBalance balance(source, file);
  mesh::MeshSource& watched = source.has_tagged_hull() ? balance : source;
  if (options.one_number_space) {
    deck::OneNumberSpace numbered(watched);
    chosen.write(numbered, file, options, progress);
  } else {
    chosen.write(watched, file, options, progress);
  }
}

std::vector<std::filesystem::path> parts_of_mesh(const std::filesystem::path& file, std::string_view format) {
  const MeshFormat* const found = find_mesh_format(file, format);
  if (found == nullptr || found->parts == nullptr) return {};
  std::vector<std::filesystem::path> parts = found->parts(file);
  std::erase_if(parts, [](const std::filesystem::path& part) { return !std::filesystem::exists(part); });
  return parts;
}

mesh::MeshData read_mesh(const std::filesystem::path& file, std::string_view format, const Progress& progress) {
  progress.check();
  // Folders of Elmer have names of their own.
  const bool is_elmer = format.empty() && (file.filename() == "mesh.header" || std::filesystem::exists(file / "mesh.header"));
  const MeshFormat& chosen = mesh_format_for(file, is_elmer ? elmer::mesh_format.name : format, ErrorCode::format_unknown);
  if (chosen.read == nullptr)
    throw Error(ErrorCode::format_unknown,
                fmt::format("{} is not read, only written; these are read: {}", chosen.name, names_with(&MeshFormat::read)),
                {.file = file.string()});
  return chosen.read(file, progress);
}

}  // namespace pcbmesh::formats
