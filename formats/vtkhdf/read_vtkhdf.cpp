// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/vtkhdf/read_vtkhdf.hpp"

#include <fmt/format.h>

#include <limits>
#include <string>

#include "formats/hdf5/file_reader.hpp"
#include "formats/vtk/cells.hpp"
#include "formats/vtk/mesh_assembly.hpp"
#include "formats/xdmf/topology.hpp"

namespace pcbmesh::formats::vtkhdf {
namespace {

constexpr int vertex = 1, line = 3;

std::vector<std::int64_t> tags_of(const hdf5::FileReader& file, std::initializer_list<const char*> paths, std::size_t count) {
  for (const char* path : paths) {
    if (!file.has(path)) continue;
    std::vector<std::int64_t> tags = file.integers(path);
    if (tags.size() != count) file.fail(path, fmt::format("has {} values for {} elements", tags.size(), count));
    for (const std::int64_t tag : tags)
      if (tag < std::numeric_limits<std::int32_t>::min() || tag > std::numeric_limits<std::int32_t>::max())
        file.fail(path, fmt::format("tag {} does not fit 32 bits", tag));
    return tags;
  }
  return std::vector<std::int64_t>(count, 0);
}

void read_cells(const hdf5::FileReader& file, vtk::MeshAssembly& mesh) {
  const auto num_points = file.integers("/VTKHDF/NumberOfPoints"), num_cells = file.integers("/VTKHDF/NumberOfCells"),
             num_ids = file.integers("/VTKHDF/NumberOfConnectivityIds");
  if (num_points.size() != num_cells.size() || num_ids.size() != num_cells.size())
    file.fail("/VTKHDF", "the numbers of partitions differ");
  const auto corners = file.integers("/VTKHDF/Connectivity"), ends = file.integers("/VTKHDF/Offsets"),
             types = file.integers("/VTKHDF/Types");
  const auto tags =
      tags_of(file, {"/VTKHDF/CellData/volume_tag", "/VTKHDF/CellData/material", "/VTKHDF/CellData/attribute"}, types.size());
  const auto shape = file.shape("/VTKHDF/Points");
  if (shape.size() != 2 || shape[1] != 3) file.fail("/VTKHDF/Points", "needs three columns");
  mesh.add_nodes(file.reals("/VTKHDF/Points"));
  std::int64_t first_node = 0, first_id = 0, cell = 0, next_end = 0;
  for (std::size_t part = 0; part < num_cells.size(); ++part) {
    const auto within = [](std::int64_t first, std::int64_t count, std::size_t size) {
      return count >= 0 && count <= static_cast<std::int64_t>(size) - first;
    };
    if (!within(first_node, num_points[part], static_cast<std::size_t>(mesh.num_nodes())) ||
        !within(first_id, num_ids[part], corners.size()) || !within(cell, num_cells[part], types.size()) ||
        !within(next_end, num_cells[part] + 1, ends.size()))
      file.fail("/VTKHDF", fmt::format("partition {} is larger than its arrays", part));
    for (std::int64_t i = 0; i < num_cells[part]; ++i, ++cell, ++next_end) {
      const std::int64_t begin = ends[static_cast<std::size_t>(next_end)], end = ends[static_cast<std::size_t>(next_end) + 1];
      if (begin < 0 || end < begin || end > num_ids[part])
        file.fail("/VTKHDF/Offsets", fmt::format("do not ascend at cell {}", cell));
      const std::int64_t type = types[static_cast<std::size_t>(cell)];
      if (type == vertex || type == line) {
        mesh.add_point_or_line(type == line);
        continue;
      }
      const auto kind = type < 0 || type > 255 ? std::nullopt : vtk::element_kind(static_cast<int>(type));
      if (!kind)
        file.fail("/VTKHDF/Types", fmt::format("cell {} is of VTK type {}, which is not read", cell, type),
                  ErrorCode::format_limit);
      if (end - begin != mesh::nodes_of(*kind))
        file.fail("/VTKHDF/Offsets", fmt::format("cell {} of type {} has {} corners", cell, type, end - begin));
      mesh.add_element(
          *kind, std::span(corners).subspan(static_cast<std::size_t>(first_id + begin), static_cast<std::size_t>(end - begin)),
          vtk::node_order(*kind, VtkWedge::legacy), static_cast<std::int32_t>(tags[static_cast<std::size_t>(cell)]),
          first_node);
    }
    ++next_end;
    first_node += num_points[part];
    first_id += num_ids[part];
  }
  mesh.turn_wedges_if_inside_out();
}

/// Faces as our own files have them: all of one kind, or one mixed stream.
void read_faces(const hdf5::FileReader& file, vtk::MeshAssembly& mesh) {
  for (const auto& [path, topology] : {std::pair<std::string, const char*>{"/mesh/faces", "Mixed"},
                                       {"/mesh/triangle", "Triangle"},
                                       {"/mesh/quadrangle", "Quadrilateral"},
                                       {"/mesh/triangle6", "Triangle_6"}}) {
    if (!file.has(path)) continue;
    const auto numbers = file.integers(path);
    const std::int64_t count = static_cast<std::int64_t>(file.shape(path + "_face_tag").at(0));
    const auto tags = tags_of(file, {(path + "_face_tag").c_str()}, static_cast<std::size_t>(count));
    xdmf::add_elements(mesh, topology, numbers, tags, [&](const std::string& text) { file.fail(path, text); });
  }
}

void read_names(const hdf5::FileReader& file, vtk::MeshAssembly& mesh) {
  for (const int dimension : {2, 3}) {
    const std::string path = std::string("/VTKHDF/FieldData/") + (dimension == 3 ? "volume" : "face");
    if (!file.has(path + "_names") || !file.has(path + "_tags")) continue;
    const auto names = file.texts(path + "_names");
    const auto tags = file.integers(path + "_tags");
    if (names.size() != tags.size()) file.fail(path, "has not as many names as tags");
    for (std::size_t i = 0; i < names.size(); ++i) mesh.add_name(dimension, static_cast<std::int32_t>(tags[i]), names[i]);
  }
}

}  // namespace

mesh::MeshData read_vtkhdf(const std::filesystem::path& path, const Progress& progress) {
  progress.check();
  const hdf5::FileReader file(path);
  if (!file.has("/VTKHDF")) file.fail("", "this HDF5 file has no group VTKHDF; an XDMF file beside it may tell what it holds");
  const auto type = file.text_attribute("/VTKHDF", "Type");
  if (type && *type != "UnstructuredGrid")
    file.fail("/VTKHDF", fmt::format("is of the type '{}', not UnstructuredGrid", type->substr(0, 40)));
  vtk::MeshAssembly mesh(path);
  read_cells(file, mesh);
  progress.check();
  read_faces(file, mesh);
  read_names(file, mesh);
  return mesh.take();
}

}  // namespace pcbmesh::formats::vtkhdf
