// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/vtu/write_many.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "formats/sink/file_sink.hpp"
#include "formats/sink/folder_sink.hpp"
#include "formats/vtk/piece.hpp"
#include "formats/vtu/write_vtu.hpp"
#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats::vtu {

std::filesystem::path folder_of(const std::filesystem::path& file) {
  const std::string ending = file.extension().string();
  if (ending.empty())
    throw Error(ErrorCode::usage, "a file without ending leaves no name for the folder of its parts", {.file = file.string()});
  std::filesystem::path folder = file;
  folder.replace_extension();
  folder += "_" + ending.substr(1);
  return folder;
}

namespace {

/// As this file names them: "12.vtu", "volume_3.vtu", "face_3.vtu".
bool is_piece(std::string_view name) {
  for (const std::string_view start : {"volume_", "face_"})
    if (name.starts_with(start)) name.remove_prefix(start.size());
  const std::size_t digits = std::min(name.find_first_not_of("0123456789"), name.size());
  return digits > 0 && name.substr(digits) == ".vtu";
}

/// Text as an attribute's value.
std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += c;
  }
  return out;
}

void put_array_head(FileSink& sink, const ArrayHead& head) {
  sink.put(fmt::format("   <PDataArray type=\"{}\" Name=\"{}\"", head.type, head.name));
  if (head.num_components > 1) sink.put(fmt::format(" NumberOfComponents=\"{}\"", head.num_components));
  sink.put("/>\n");
}

}  // namespace

void write_parallel(mesh::MeshSource& source, const std::filesystem::path& file, const WriteMeshOptions& options,
                    const Progress& progress) {
  if (options.num_parts < 1)
    throw Error(ErrorCode::usage, fmt::format("{} parts; at least 1 is needed", options.num_parts), {.file = file.string()});
  const std::filesystem::path folder_path = folder_of(file);
  FolderSink folder(folder_path, is_piece);
  const std::string prefix = folder_path.filename().string() + "/";
  const double scale = source.unit_m() / metres_per(options.unit);
  const std::vector<vtk::Run> all = vtk::runs_of(
      source, [&](const mesh::ElementBlock& block) { return options.faces || mesh::dimension_of(block.kind) == 3; });
  const vtk::Piece whole(source, all, true, progress);
  // All parts have the same arrays of the same types, as the format wants it.
  WriteMeshOptions part_options = options;
  part_options.index_bits = static_cast<int>(8 * vtk::index_bytes(whole, options, file));
  std::vector<std::string> names;
  for (std::int64_t part = 0; part < options.num_parts; ++part) {
    const std::int64_t begin = whole.num_elements() * part / options.num_parts,
                       end = whole.num_elements() * (part + 1) / options.num_parts;
    names.push_back(fmt::format("{}.vtu", part));
    const vtk::Piece piece(source, vtk::part_of(all, begin, end - begin), whole.cell_arrays(), progress);
    write_vtu(piece, folder.file(names.back()), part_options, scale, progress, &source);
  }
  FileSink sink(file);
  sink.put(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
      " <PUnstructuredGrid GhostLevel=\"0\">\n  <PPoints>\n");
  const std::vector<ArrayHead> heads = arrays_of(whole, static_cast<std::size_t>(part_options.index_bits) / 8);
  put_array_head(sink, heads.front());
  sink.put("  </PPoints>\n  <PCellData>\n");
  for (const ArrayHead& head : heads)
    if (head.section == "CellData") put_array_head(sink, head);
  sink.put("  </PCellData>\n");
  for (const std::string& name : names) sink.put(fmt::format("  <Piece Source=\"{}\"/>\n", escaped(prefix + name)));
  sink.put(" </PUnstructuredGrid>\n</VTKFile>\n");
  // The pieces and the list appear one right after the other.
  sink.save();
  folder.commit();
  sink.commit();
}

void write_multiblock(mesh::MeshSource& source, const std::filesystem::path& file, const WriteMeshOptions& options,
                      const Progress& progress) {
  const std::filesystem::path folder_path = folder_of(file);
  FolderSink folder(folder_path, is_piece);
  const std::string prefix = folder_path.filename().string() + "/";
  const double scale = source.unit_m() / metres_per(options.unit);
  struct Block {
    std::string group, file;
  };
  std::vector<Block> kinds[2];  // volumes, faces
  for (std::size_t i = 0; i < source.groups().size(); ++i) {
    const mesh::ElementGroup& group = source.groups()[i];
    if (group.num_elements == 0) continue;
    const bool is_volume = group.dimension == 3;
    const vtk::Piece piece(
        source, vtk::runs_of(source, [&](const mesh::ElementBlock& b) { return b.group == static_cast<std::int32_t>(i); }),
        false, progress);
    const std::string name = fmt::format("{}_{}.vtu", is_volume ? "volume" : "face", group.tag);
    write_vtu(piece, folder.file(name), options, scale, progress);
    kinds[is_volume ? 0 : 1].push_back({group.name, prefix + name});
  }
  FileSink sink(file);
  sink.put(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"vtkMultiBlockDataSet\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
      " <vtkMultiBlockDataSet>\n");
  for (int kind = 0; kind < 2; ++kind) {
    sink.put(fmt::format("  <Block index=\"{}\" name=\"{}\">\n", kind, kind == 0 ? "volumes" : "faces"));
    for (std::size_t i = 0; i < kinds[kind].size(); ++i)
      sink.put(fmt::format("   <DataSet index=\"{}\" name=\"{}\" file=\"{}\"/>\n", i, escaped(kinds[kind][i].group),
                           escaped(kinds[kind][i].file)));
    sink.put("  </Block>\n");
  }
  sink.put(" </vtkMultiBlockDataSet>\n</VTKFile>\n");
  // The pieces and the list appear one right after the other.
  sink.save();
  folder.commit();
  sink.commit();
}

}  // namespace pcbmesh::formats::vtu
