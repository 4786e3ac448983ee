// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/vtu/write_vtu.hpp"

#include <fmt/format.h>

#include <string>

#include "formats/sink/file_sink.hpp"
#include "formats/vtu/array_writer.hpp"
#include "formats/vtu/name_tables.hpp"
#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats::vtu {
namespace {

constexpr std::string_view offset_room = "                    ";  // digits of the largest offset

class Writer {
 public:
  Writer(const vtk::Piece& piece, FileSink& sink, const WriteMeshOptions& options, double scale, const Progress& progress,
         const mesh::MeshSource* named)
      : piece_(piece),
        named_(named),
        sink_(sink),
        options_(options),
        scale_(scale),
        bytes_of_index_(vtk::index_bytes(piece, options, sink.target())),
        arrays_(arrays_of(piece, bytes_of_index_)),
        values_(sink, options),
        meter_(progress, num_items(arrays_)) {}
  void write();

 private:
  static std::int64_t num_items(const std::vector<ArrayHead>& arrays) {
    std::int64_t sum = 0;
    for (const ArrayHead& array : arrays) sum += array.num_values / array.num_components;
    return sum;
  }
  void write_opening();
  void write_array(const ArrayHead& head);
  void fill(const ArrayHead& head, ArraySink& out);
  [[nodiscard]] bool is_appended() const { return options_.binary && !options_.base64; }

  const vtk::Piece& piece_;
  const mesh::MeshSource* named_;
  FileSink& sink_;
  const WriteMeshOptions& options_;
  double scale_;
  std::size_t bytes_of_index_;
  std::vector<ArrayHead> arrays_;
  ArrayWriter values_;
  Meter meter_;
  std::vector<std::uint64_t> offsets_at_;  ///< places in the file where the offset of each appended array belongs
};

void Writer::write_opening() {
  sink_.put("<?xml version=\"1.0\"?>\n");
  sink_.put("<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\"");
  if (options_.binary && options_.compression != Compression::none)
    sink_.put(fmt::format(" compressor=\"vtk{}DataCompressor\"", options_.compression == Compression::lz4 ? "LZ4" : "ZLib"));
  sink_.put(fmt::format(">\n <!-- wedges: {} order of corners -->\n <UnstructuredGrid>\n", name_of(options_.vtk_wedge)));
  if (named_ != nullptr) put_name_tables(sink_, *named_, options_.faces);
  sink_.put(fmt::format("  <Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n", piece_.num_nodes(), piece_.num_elements()));
}

void Writer::fill(const ArrayHead& head, ArraySink& out) {
  if (head.section == "Points") return piece_.put_points(scale_, out, meter_);
  if (head.name == "connectivity") return piece_.put_corners(options_.vtk_wedge, bytes_of_index_, out, meter_);
  if (head.name == "offsets") return piece_.put_ends(false, bytes_of_index_, out, meter_);
  if (head.name == "types") return piece_.put_types(out, meter_);
  for (const vtk::CellArray array : piece_.cell_arrays())
    if (head.name == vtk::name_of(array)) return piece_.put_cell_array(array, out, meter_);
}

void Writer::write_array(const ArrayHead& head) {
  sink_.put(fmt::format("    <DataArray type=\"{}\" Name=\"{}\"", head.type, head.name));
  // Left out where it is 1: meshio else makes columns of what are plain arrays.
  if (head.num_components > 1) sink_.put(fmt::format(" NumberOfComponents=\"{}\"", head.num_components));
  const FillArray values = [&](ArraySink& out) { fill(head, out); };
  if (is_appended()) {
    sink_.put(" format=\"appended\" ");
    offsets_at_.push_back(sink_.size());
    sink_.put(fmt::format("offset=\"0\"{}/>\n", offset_room));
  } else {
    sink_.put(options_.binary ? " format=\"binary\">\n" : " format=\"ascii\">\n");
    options_.binary ? values_.put_base64(head, values) : values_.put_text(head, values);
    sink_.put("    </DataArray>\n");
  }
}

void Writer::write() {
  write_opening();
  std::string_view open;
  for (const ArrayHead& head : arrays_) {
    if (head.section != open) {
      if (!open.empty()) sink_.put(fmt::format("   </{}>\n", open));
      sink_.put(fmt::format("   <{}>\n", head.section));
      open = head.section;
    }
    write_array(head);
  }
  sink_.put(fmt::format("   </{}>\n  </Piece>\n </UnstructuredGrid>\n", open));
  if (is_appended()) {
    sink_.put(" <AppendedData encoding=\"raw\">\n_");
    const std::uint64_t start = sink_.size();
    for (std::size_t i = 0; i < arrays_.size(); ++i) {
      sink_.overwrite(offsets_at_[i], fmt::format("offset=\"{}\"", sink_.size() - start));
      values_.put_appended(arrays_[i], [&](ArraySink& out) { fill(arrays_[i], out); });
    }
    sink_.put("\n </AppendedData>\n");
  }
  sink_.put("</VTKFile>\n");
}

/// Exact but for the headers where nothing is packed, else 0: nobody knows.
std::uint64_t expected_bytes(const std::vector<ArrayHead>& arrays, const WriteMeshOptions& options) {
  if (!options.binary || options.compression != Compression::none) return 0;
  std::uint64_t bytes = 0;
  for (const ArrayHead& array : arrays) bytes += array.num_bytes();
  return options.base64 ? bytes / 3 * 4 : bytes;
}

}  // namespace

std::vector<ArrayHead> arrays_of(const vtk::Piece& piece, std::size_t bytes_of_index) {
  const std::string_view integer = bytes_of_index == sizeof(std::int64_t) ? "Int64" : "Int32";
  std::vector<ArrayHead> arrays{{"Points", "Float64", "Points", 3, sizeof(double), 3 * piece.num_nodes()},
                                {"Cells", integer, "connectivity", 1, bytes_of_index, piece.num_corners()},
                                {"Cells", integer, "offsets", 1, bytes_of_index, piece.num_elements()},
                                {"Cells", "UInt8", "types", 1, 1, piece.num_elements()}};
  for (const vtk::CellArray array : piece.cell_arrays())
    arrays.push_back(
        {"CellData", array == vtk::CellArray::quality ? "Float32" : "Int32", vtk::name_of(array), 1, 4, piece.num_elements()});
  return arrays;
}

void write_vtu(const vtk::Piece& piece, const std::filesystem::path& file, const WriteMeshOptions& options, double scale,
               const Progress& progress, const mesh::MeshSource* named) {
  const std::size_t bytes_of_index = vtk::index_bytes(piece, options, file);
  FileSink sink(file, expected_bytes(arrays_of(piece, bytes_of_index), options));
  Writer(piece, sink, options, scale, progress, named).write();
  progress.check();
  sink.commit();
}

}  // namespace pcbmesh::formats::vtu
