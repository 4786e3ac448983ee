// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/exodus/format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "formats/elements/element_walk.hpp"
#include "formats/exodus/classic_file.hpp"
#include "formats/face_parents/face_parents.hpp"
#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats::exodus {
namespace {

using mesh::ElementKind;

constexpr std::array<std::string_view, 3> extensions{".exo", ".e", ".exii"};
constexpr std::size_t name_bytes = 256;

std::string_view type_of(ElementKind kind) {
  constexpr std::string_view types[] = {"", "", "TETRA", "PYRAMID", "WEDGE",   "HEX",
                                        "", "", "",      "TETRA10", "WEDGE15", "WEDGE18"};
  return types[static_cast<int>(kind)];
}

/// Number of a side of a cell by its index in sides_of().
std::int32_t side_number(ElementKind kind, std::int32_t side) {
  constexpr std::int32_t tetrahedron[] = {4, 1, 2, 3}, pyramid[] = {5, 1, 2, 3, 4}, wedge[] = {4, 5, 1, 2, 3},
                         hexahedron[] = {5, 6, 1, 2, 3, 4};
  switch (mesh::corners_of(kind)) {
    case 4:
      return tetrahedron[side];
    case 5:
      return pyramid[side];
    case 6:
      return wedge[side];
    default:
      return hexahedron[side];
  }
}

/// An element block: cells of one kind in one group. Its id is the group's tag; a second kind in the group gets one of its own.
struct CellBlock {
  std::size_t block;
  std::int32_t id;
  std::string name;
};

std::vector<CellBlock> cell_blocks(const mesh::MeshSource& source) {
  std::vector<CellBlock> out;
  std::int32_t last_id = 0;
  for (const mesh::ElementGroup& group : source.groups())
    if (group.dimension == 3) last_id = std::max(last_id, group.tag);
  std::set<std::int32_t> taken;
  for (std::size_t b = 0; b < source.blocks().size(); ++b) {
    const mesh::ElementBlock& block = source.blocks()[b];
    if (mesh::dimension_of(block.kind) != 3) continue;
    const std::string& name = source.groups()[static_cast<std::size_t>(block.group)].name;
    if (taken.insert(block.tag).second)
      out.push_back({b, block.tag, name});
    else
      out.push_back({b, ++last_id, fmt::format("{} {}", name, mesh::name_of(block.kind))});
  }
  return out;
}

std::vector<std::int32_t> face_groups(const mesh::MeshSource& source) {
  std::vector<std::int32_t> out;
  for (std::size_t g = 0; g < source.groups().size(); ++g)
    if (source.groups()[g].dimension == 2 && source.groups()[g].num_elements > 0) out.push_back(static_cast<std::int32_t>(g));
  return out;
}

class Writer {
 public:
  explicit Writer(const WriteJob& job)
      : job_(job), file_(job.sink), cells_(cell_blocks(job.source)), faces_(face_groups(job.source)) {}

  void write() {
    const FaceParents parents(job_.source, job_.progress);
    parents.require_no_loose("Exodus", job_.file);
    declare();
    if (file_.largest_variable() > ClassicFile::most_bytes)
      throw Error(ErrorCode::format_limit,
                  fmt::format("an array of {} bytes is needed, and a netCDF file of the classic format holds {} in one; write "
                              "MSH 4.1 or a coarser mesh",
                              file_.largest_variable(), ClassicFile::most_bytes),
                  {.file = job_.file.string()});
    file_.write_header();
    write_tables();
    write_coordinates();
    write_cells();
    write_sides(parents);
  }

 private:
  void declare();
  void write_tables();
  void write_coordinates();
  void write_cells();
  void write_sides(const FaceParents& parents);

  const WriteJob& job_;
  ClassicFile file_;
  std::vector<CellBlock> cells_;
  std::vector<std::int32_t> faces_;
};

void Writer::declare() {
  const mesh::MeshSource& source = job_.source;
  file_.add_real("api_version", 5.22F);
  file_.add_real("version", 5.22F);
  file_.add_integer("floating_point_word_size", 8);
  file_.add_integer("file_size", 1);
  file_.add_integer("maximum_name_length", static_cast<std::int32_t>(name_bytes) - 1);
  file_.add_integer("int64_status", 0);
  file_.add_text("title", "board mesh by pcbmesh");
  file_.add_dimension("len_string", 33);
  file_.add_dimension("len_line", 81);
  file_.add_dimension("four", 4);
  const std::int32_t len_name = file_.add_dimension("len_name", static_cast<std::int64_t>(name_bytes));
  const std::int32_t time_step = file_.add_dimension("time_step", 0);
  const std::int32_t num_dim = file_.add_dimension("num_dim", 3);
  const std::int32_t num_nodes = file_.add_dimension("num_nodes", source.num_nodes());
  file_.add_dimension("num_elem", source.num_elements(3));
  const std::int32_t num_blocks = file_.add_dimension("num_el_blk", static_cast<std::int64_t>(cells_.size()));
  const std::int32_t num_sides =
      faces_.empty() ? -1 : file_.add_dimension("num_side_sets", static_cast<std::int64_t>(faces_.size()));
  file_.add_variable("eb_status", ClassicType::integer, {num_blocks});
  file_.add_variable("eb_prop1", ClassicType::integer, {num_blocks}, "name", "ID");
  file_.add_variable("eb_names", ClassicType::character, {num_blocks, len_name});
  if (!faces_.empty()) {
    file_.add_variable("ss_status", ClassicType::integer, {num_sides});
    file_.add_variable("ss_prop1", ClassicType::integer, {num_sides}, "name", "ID");
    file_.add_variable("ss_names", ClassicType::character, {num_sides, len_name});
  }
  file_.add_variable("coor_names", ClassicType::character, {num_dim, len_name});
  for (const char* name : {"coordx", "coordy", "coordz"}) file_.add_variable(name, ClassicType::double_real, {num_nodes});
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const mesh::ElementBlock& block = source.blocks()[cells_[i].block];
    const std::int32_t count = file_.add_dimension(fmt::format("num_el_in_blk{}", i + 1), block.count),
                       width = file_.add_dimension(fmt::format("num_nod_per_el{}", i + 1), mesh::nodes_of(block.kind));
    file_.add_variable(fmt::format("connect{}", i + 1), ClassicType::integer, {count, width}, "elem_type", type_of(block.kind));
  }
  for (std::size_t i = 0; i < faces_.size(); ++i) {
    const std::int32_t count = file_.add_dimension(fmt::format("num_side_ss{}", i + 1),
                                                   source.groups()[static_cast<std::size_t>(faces_[i])].num_elements);
    file_.add_variable(fmt::format("elem_ss{}", i + 1), ClassicType::integer, {count});
    file_.add_variable(fmt::format("side_ss{}", i + 1), ClassicType::integer, {count});
  }
  file_.add_variable("time_whole", ClassicType::double_real, {time_step});  // last: records stand behind all other values
}

void Writer::write_tables() {
  for (std::size_t i = 0; i < cells_.size(); ++i) file_.put(std::int32_t{1});
  file_.end_variable();
  for (const CellBlock& block : cells_) file_.put(block.id);
  file_.end_variable();
  for (const CellBlock& block : cells_) file_.put_text(block.name, name_bytes);
  file_.end_variable();
  if (!faces_.empty()) {
    for (std::size_t i = 0; i < faces_.size(); ++i) file_.put(std::int32_t{1});
    file_.end_variable();
    for (const std::int32_t g : faces_) file_.put(job_.source.groups()[static_cast<std::size_t>(g)].tag);
    file_.end_variable();
    for (const std::int32_t g : faces_) file_.put_text(job_.source.groups()[static_cast<std::size_t>(g)].name, name_bytes);
    file_.end_variable();
  }
  for (const char* name : {"x", "y", "z"}) file_.put_text(name, name_bytes);
  file_.end_variable();
}

void Writer::write_coordinates() {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    visit_nodes(job_, [&](std::int64_t, std::span<const std::array<double, 3>> nodes) {
      for (const auto& node : nodes) file_.put(node[axis]);
    });
    file_.end_variable();
  }
}

void Writer::write_cells() {
  for (const CellBlock& block : cells_) {
    visit_elements(job_, block.block, NodeOrder::exodus, 0, [&](std::int64_t, std::span<const std::int64_t> nodes) {
      for (const std::int64_t node : nodes) file_.put(static_cast<std::int32_t>(node + 1));
    });
    file_.end_variable();
  }
}

void Writer::write_sides(const FaceParents& parents) {
  // Faces are numbered through in file order, group by group.
  std::int64_t first = 0;
  for (const std::int32_t g : faces_) {
    const std::int64_t count = job_.source.groups()[static_cast<std::size_t>(g)].num_elements;
    for (std::int64_t i = first; i < first + count; ++i) file_.put(static_cast<std::int32_t>(parents.of(i)[0].cell + 1));
    file_.end_variable();
    for (std::int64_t i = first; i < first + count; ++i) {
      const FaceParents::Parent parent = parents.of(i)[0];
      file_.put(side_number(parent.kind, parent.side));
    }
    file_.end_variable();
    first += count;
  }
  file_.end_variable();  // no time steps
}

void write(mesh::MeshSource& source, const std::filesystem::path& file, const WriteMeshOptions& options,
           const Progress& progress) {
  FileSink sink(file);
  const WriteJob job{source, sink, source.unit_m() / metres_per(options.unit), progress, file};
  require_count(job, "Exodus", std::numeric_limits<std::int32_t>::max());
  if (source.num_nodes() == 0 || source.num_elements(3) == 0)
    throw Error(ErrorCode::format_limit, "the mesh has no cells, and Exodus files can't be empty", {.file = file.string()});
  Writer(job).write();
  progress.check();
  sink.commit();
}

using enum ElementKind;
constexpr KindSet kinds = kind_set(triangle, quadrangle, tetrahedron, pyramid, wedge, hexahedron, triangle6, quadrangle8,
                                   quadrangle9, tetrahedron10, wedge15, wedge18);

}  // namespace

constinit const MeshFormat mesh_format{"exodus",   "Exodus II (MOOSE, Cubit, ParaView)",
                                       extensions, write,
                                       nullptr,    {.written = kinds, .readable = 0, .has_tags = true, .has_names = true}};

}  // namespace pcbmesh::formats::exodus
