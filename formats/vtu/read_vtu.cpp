// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/vtu/read_vtu.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <string>
#include <utility>

#include "formats/syntax/input_file.hpp"
#include "formats/syntax/xml_tree.hpp"
#include "formats/vtk/cells.hpp"
#include "formats/vtk/mesh_assembly.hpp"
#include "formats/vtu/array_reader.hpp"
#include "formats/vtu/name_tables.hpp"

namespace pcbmesh::formats::vtu {
namespace {

using syntax::XmlElement;

constexpr int vertex = 1, line = 3;
constexpr std::int64_t most_items = std::int64_t{1} << 40;

std::int64_t count_of(const ArrayReader& reader, const XmlElement& piece, std::string_view name) {
  const std::string_view text = piece.attribute(name);
  std::int64_t count = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (error != std::errc() || end != text.data() + text.size() || count < 0 || count > most_items)
    reader.fail(piece, fmt::format("{}='{}' is no sensible count", name, text.substr(0, 40)));
  return count;
}

const XmlElement& array_of(const ArrayReader& reader, const XmlElement& piece, std::string_view section,
                           std::string_view name) {
  const XmlElement* found = piece.child(section);
  if (found == nullptr) reader.fail(piece, fmt::format("the piece has no {}", section));
  for (const XmlElement& array : found->children)
    if (array.name == "DataArray" && (name.empty() || array.attribute("Name") == name)) return array;
  reader.fail(*found, fmt::format("{} has no array {}", section, name));
}

/// Tags of all cells, or nothing.
std::vector<std::int64_t> tags_of(const ArrayReader& reader, const XmlElement& piece, std::int64_t num_cells,
                                  std::initializer_list<std::string_view> names) {
  const XmlElement* section = piece.child("CellData");
  if (section == nullptr) return {};
  for (const std::string_view name : names)
    for (const XmlElement& array : section->children)
      if (array.attribute("Name") == name && !array.attribute("type").starts_with("Float"))
        return reader.integers(array, num_cells);
  return {};
}

void read_piece(const ArrayReader& reader, const XmlElement& piece, vtk::MeshAssembly& mesh) {
  const std::int64_t num_points = count_of(reader, piece, "NumberOfPoints"),
                     num_cells = count_of(reader, piece, "NumberOfCells"), first_node = mesh.num_nodes();
  mesh.add_nodes(reader.reals(array_of(reader, piece, "Points", ""), 3 * num_points));
  const auto types = reader.integers(array_of(reader, piece, "Cells", "types"), num_cells);
  const auto ends = reader.integers(array_of(reader, piece, "Cells", "offsets"), num_cells);
  const XmlElement& connectivity = array_of(reader, piece, "Cells", "connectivity");
  const std::int64_t num_corners = ends.empty() ? 0 : ends.back();
  if (num_corners < 0 || num_corners > most_items)
    reader.fail(connectivity, fmt::format("{} entries are announced", num_corners));
  const auto corners = reader.integers(connectivity, num_corners);
  const auto volume_tags = tags_of(reader, piece, num_cells, {"volume_tag", "gmsh:physical", "material", "attribute"}),
             face_tags = tags_of(reader, piece, num_cells, {"face_tag", "gmsh:physical", "material", "attribute"});
  std::int64_t begin = 0;
  for (std::size_t i = 0; i < types.size(); begin = ends[i], ++i) {
    const std::int64_t count = ends[i] - begin;
    if (count < 0 || ends[i] > num_corners) reader.fail(connectivity, fmt::format("offsets do not ascend at cell {}", i));
    if (types[i] == vertex || types[i] == line) {
      mesh.add_point_or_line(types[i] == line);
      continue;
    }
    const auto kind = types[i] < 0 || types[i] > 255 ? std::nullopt : vtk::element_kind(static_cast<int>(types[i]));
    if (!kind)
      reader.fail(piece, fmt::format("cell {} is of VTK type {}, which is not read", i, types[i]), ErrorCode::file_syntax);
    if (count != mesh::nodes_of(*kind))
      reader.fail(connectivity, fmt::format("cell {} of type {} has {} corners", i, types[i], count));
    const auto& tags = mesh::dimension_of(*kind) == 3 ? volume_tags : face_tags;
    const std::int64_t tag = tags.empty() ? 0 : tags[i];
    if (tag < std::numeric_limits<std::int32_t>::min() || tag > std::numeric_limits<std::int32_t>::max())
      reader.fail(piece, fmt::format("tag {} of cell {} does not fit 32 bits", tag, i));
    mesh.add_element(*kind, std::span(corners).subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(count)),
                     vtk::node_order(*kind, VtkWedge::legacy), static_cast<std::int32_t>(tag), first_node);
  }
}

}  // namespace

mesh::MeshData read_vtu(const std::filesystem::path& file, const Progress& progress) {
  progress.check();
  const std::string bytes = syntax::read_whole_file(file);
  const syntax::XmlTree tree = syntax::parse_xml(bytes, file, "AppendedData");
  const ArrayReader reader(bytes, tree, file);
  constexpr std::size_t tail = 64;
  if (tree.stopped_at >= 0 && bytes.find("</VTKFile>", bytes.size() - std::min(bytes.size(), tail)) == std::string::npos)
    throw Error(ErrorCode::file_truncated, "the file ends too early: </VTKFile> is not at its end; write or copy it again",
                {.file = file.string(), .byte = static_cast<std::int64_t>(bytes.size())});
  const XmlElement* grid = tree.root.child("UnstructuredGrid");
  if (grid == nullptr) reader.fail(tree.root, "the file holds no UnstructuredGrid");
  vtk::MeshAssembly mesh(file);
  bool has_piece = false;
  for (const XmlElement& piece : grid->children) {
    if (piece.name != "Piece") continue;
    read_piece(reader, piece, mesh);
    has_piece = true;
    progress.check();
  }
  if (!has_piece) reader.fail(*grid, "the file holds no Piece");
  read_name_tables(reader, *grid, mesh);
  mesh.turn_wedges_if_inside_out();
  mesh::MeshData out = mesh.take();
  out.format.name = "vtu";
  return out;
}

}  // namespace pcbmesh::formats::vtu
