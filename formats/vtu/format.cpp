// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/vtu/format.hpp"

#include <fmt/format.h>

#include <array>
#include <string>
#include <vector>

#include "formats/sink/file_sink.hpp"
#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats::vtu {
namespace {

constexpr std::array<std::string_view, 1> extensions{".vtu"};
constexpr std::int64_t block = 1024;
constexpr std::uint8_t vtk_wedge = 13;

/// One array of the file: name, type and size are known before its bytes are made.
struct Array {
  std::string_view section, type, name;
  int num_components = 1;
  std::int64_t num_bytes = 0;
  std::int64_t offset = 0;  ///< behind the '_' that starts the appended data
};

class Writer {
 public:
  Writer(const mesh::PrismMesh& mesh, FileSink& sink, double scale, const Progress& progress)
      : mesh_(mesh), sink_(sink), scale_(scale), progress_(progress) {}
  void write();

 private:
  void write_header() const;
  void write_points() const;
  void write_connectivity() const;
  void write_ends() const;
  void write_types() const;
  template <class Value>
  void write_cell_array(Value value_of) const;
  void begin(std::size_t array) const { sink_.put_raw(arrays_[array].num_bytes); }

  const mesh::PrismMesh& mesh_;
  FileSink& sink_;
  double scale_;
  const Progress& progress_;
  std::array<Array, 8> arrays_{};
};

std::array<Array, 8> arrays_of(std::int64_t num_nodes, std::int64_t num_cells) {
  std::array<Array, 8> arrays{{{"Points", "Float64", "Points", 3, num_nodes * 24},
                               {"Cells", "Int64", "connectivity", 1, num_cells * 48},
                               {"Cells", "Int64", "offsets", 1, num_cells * 8},
                               {"Cells", "UInt8", "types", 1, num_cells},
                               {"CellData", "Int32", "volume_tag", 1, num_cells * 4},
                               {"CellData", "Int32", "layer_id", 1, num_cells * 4},
                               {"CellData", "Int32", "material_id", 1, num_cells * 4},
                               {"CellData", "Int32", "net_id", 1, num_cells * 4}}};
  std::int64_t offset = 0;
  for (Array& array : arrays) {
    array.offset = offset;
    offset += static_cast<std::int64_t>(sizeof(std::int64_t)) + array.num_bytes;
  }
  return arrays;
}

void Writer::write_header() const {
  sink_.put(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
      " <UnstructuredGrid>\n");
  sink_.put(fmt::format("  <Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n", mesh_.num_nodes(), mesh_.num_prisms()));
  std::string_view open;
  for (const Array& array : arrays_) {
    if (array.section != open) {
      if (!open.empty()) sink_.put(fmt::format("   </{}>\n", open));
      sink_.put(fmt::format("   <{}>\n", array.section));
      open = array.section;
    }
    sink_.put(fmt::format("    <DataArray type=\"{}\" Name=\"{}\"", array.type, array.name));
    // Left out where it is 1: meshio else makes columns of what are plain arrays.
    if (array.num_components > 1) sink_.put(fmt::format(" NumberOfComponents=\"{}\"", array.num_components));
    sink_.put(fmt::format(" format=\"appended\" offset=\"{}\"/>\n", array.offset));
  }
  sink_.put(fmt::format("   </{}>\n  </Piece>\n </UnstructuredGrid>\n <AppendedData encoding=\"raw\">\n_", open));
}

void Writer::write_points() const {
  std::vector<std::array<double, 3>> nodes(block);
  for (std::int64_t first = 0; first < mesh_.num_nodes(); first += block) {
    const auto part = std::span(nodes).first(static_cast<std::size_t>(std::min(block, mesh_.num_nodes() - first)));
    mesh_.fill_nodes(first, part);
    if (scale_ != 1)
      for (auto& node : part)
        for (double& x : node) x *= scale_;
    sink_.put_bytes(part.data(), part.size_bytes());
    progress_.check();
  }
}

void Writer::write_connectivity() const {
  std::vector<std::array<std::int64_t, 6>> corners(block);
  for (std::int64_t first = 0, call = 0; first < mesh_.num_prisms(); first += block, ++call) {
    const auto part = std::span(corners).first(static_cast<std::size_t>(std::min(block, mesh_.num_prisms() - first)));
    mesh_.fill_prisms(first, part);
    for (auto& wedge : part) {
      std::swap(wedge[1], wedge[2]);
      std::swap(wedge[4], wedge[5]);
    }
    sink_.put_bytes(part.data(), part.size_bytes());
    progress_.check();
    if (call % 64 == 0) progress_.at("write", static_cast<double>(first) / static_cast<double>(mesh_.num_prisms()));
  }
}

void Writer::write_ends() const {
  std::array<std::int64_t, block> ends;
  for (std::int64_t first = 0; first < mesh_.num_prisms(); first += block) {
    const std::int64_t count = std::min(block, mesh_.num_prisms() - first);
    for (std::int64_t i = 0; i < count; ++i) ends[static_cast<std::size_t>(i)] = 6 * (first + i + 1);
    sink_.put_bytes(ends.data(), static_cast<std::size_t>(count) * sizeof ends[0]);
    progress_.check();
  }
}

void Writer::write_types() const {
  const std::string types(block * 16, static_cast<char>(vtk_wedge));
  for (std::int64_t left = mesh_.num_prisms(); left > 0; left -= static_cast<std::int64_t>(types.size()))
    sink_.put(std::string_view(types).substr(0, static_cast<std::size_t>(std::min<std::int64_t>(left, block * 16))));
}

/// Sub-layers of a slab repeat the same values: they are looked up once per slab.
template <class Value>
void Writer::write_cell_array(Value value_of) const {
  std::vector<std::int32_t> values;
  for (std::int32_t slab = 0; slab < mesh_.plan().num_slabs(); ++slab) {
    values.clear();
    for (std::int32_t t = 0; t < mesh_.planar().num_triangles(); ++t)
      if (const std::int32_t tag = mesh_.tag_of(slab, t); tag >= 0)
        values.push_back(value_of(mesh_.volume_tags()[static_cast<std::size_t>(tag)]));
    const std::int32_t num_sublayers = mesh_.plan().first_sublayer(slab + 1) - mesh_.plan().first_sublayer(slab);
    for (std::int32_t i = 0; i < num_sublayers; ++i) sink_.put_bytes(values.data(), values.size() * sizeof values[0]);
    progress_.check();
  }
}

void Writer::write() {
  arrays_ = arrays_of(mesh_.num_nodes(), mesh_.num_prisms());
  write_header();
  const std::uint64_t start = sink_.size();
  std::size_t next = 0;
  const auto array = [&](auto write_values) {
    begin(next++);
    write_values();
  };
  array([&] { write_points(); });
  array([&] { write_connectivity(); });
  array([&] { write_ends(); });
  array([&] { write_types(); });
  array([&] { write_cell_array([](const mesh::VolumeTag& tag) { return tag.id; }); });
  array([&] { write_cell_array([](const mesh::VolumeTag& tag) { return tag.layer; }); });
  array([&] { write_cell_array([](const mesh::VolumeTag& tag) { return tag.material; }); });
  array([&] { write_cell_array([](const mesh::VolumeTag& tag) { return tag.net; }); });
  // Offsets were promised in the header.
  const Array& last = arrays_.back();
  PCBMESH_ASSERT(sink_.size() - start == static_cast<std::uint64_t>(last.offset + last.num_bytes) + sizeof last.num_bytes);
  sink_.put("\n </AppendedData>\n</VTKFile>\n");
}

void write(mesh::MeshSource& source, const std::filesystem::path& file, const WriteMeshOptions& options,
           const Progress& progress) {
  if (source.prisms() == nullptr) throw Error(ErrorCode::format_limit, "VTU holds prisms only", {.file = file.string()});
  const mesh::PrismMesh& mesh = *source.prisms();
  const Array last = arrays_of(mesh.num_nodes(), mesh.num_prisms()).back();
  FileSink sink(file, static_cast<std::uint64_t>(last.offset + last.num_bytes));
  Writer(mesh, sink, 1.0 / metres_per(options.unit), progress).write();
  progress.check();
  sink.commit();
}

}  // namespace

constinit const MeshFormat mesh_format{"vtu", "VTK unstructured grid (ParaView)", extensions, write, nullptr};

}  // namespace pcbmesh::formats::vtu
