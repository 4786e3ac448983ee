// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/vtkhdf/heavy_file.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "formats/hdf5/file_writer.hpp"
#include "formats/vtk/cells.hpp"
#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats::vtkhdf {
namespace {

using hdf5::NumberType;
using mesh::ElementKind;

constexpr std::array<std::string_view, 12> xdmf_names{"Triangle",        "Quadrilateral",  "Tetrahedron", "Pyramid",
                                                      "Wedge",           "Hexahedron",     "Triangle_6",  "Quadrilateral_8",
                                                      "Quadrilateral_9", "Tetrahedron_10", "Wedge_15",    "Wedge_18"};
/// Codes of a mixed topology.
constexpr std::array<std::int32_t, 12> xdmf_codes{4, 5, 6, 7, 8, 9, 36, 37, 35, 38, 40, 41};

std::vector<ElementKind> kinds_of(const mesh::MeshSource& source, int dimension) {
  std::vector<ElementKind> kinds;
  for (const mesh::ElementBlock& block : source.blocks())
    if (mesh::dimension_of(block.kind) == dimension && std::ranges::count(kinds, block.kind) == 0) kinds.push_back(block.kind);
  return kinds;
}

std::string path_of(ElementKind kind) {
  return "/mesh/" + std::string(mesh::name_of(kind));
}

class Writer {
 public:
  Writer(mesh::MeshSource& source, const std::filesystem::path& file, const WriteMeshOptions& options, const Progress& progress)
      : source_(source),
        options_(options),
        progress_(progress),
        cells_(source, vtk::runs_of(source, [](const mesh::ElementBlock& b) { return mesh::dimension_of(b.kind) == 3; }), true,
               progress),
        index_bytes_(vtk::index_bytes(cells_, options, file)),
        file_(file, {expected_bytes(), options.compression != Compression::none, options.num_threads}),
        meter_(progress, num_items()) {}
  void write(const HeavyVisit& before_it_appears);

 private:
  [[nodiscard]] std::uint64_t expected_bytes() const;
  [[nodiscard]] std::int64_t num_items() const {
    return source_.num_nodes() + cells_.num_elements() * static_cast<std::int64_t>(4 + cells_.cell_arrays().size());
  }
  [[nodiscard]] NumberType index_type() const { return index_bytes_ == 8 ? NumberType::int64 : NumberType::int32; }
  void write_vtkhdf();
  void write_tables();
  void write_array(const vtk::Piece& piece, vtk::CellArray array, const std::string& path);
  void write_cells(HeavyFile& out);
  void write_faces(HeavyFile& out);
  void write_mixed_faces(const vtk::Piece& piece, const std::string& path, HeavyGrid& grid);
  void write_rows(const vtk::Piece& piece, ElementKind kind);

  mesh::MeshSource& source_;
  const WriteMeshOptions& options_;
  const Progress& progress_;
  vtk::Piece cells_;
  std::size_t index_bytes_;
  hdf5::FileWriter file_;
  Meter meter_;
};

std::uint64_t Writer::expected_bytes() const {
  if (options_.compression != Compression::none) return 0;
  const auto cells = static_cast<std::uint64_t>(cells_.num_elements());
  return static_cast<std::uint64_t>(source_.num_nodes()) * 24 +
         static_cast<std::uint64_t>(cells_.num_corners()) * 2 * index_bytes_ +
         cells * (index_bytes_ + 1 + 4 * cells_.cell_arrays().size());
}

void Writer::write_array(const vtk::Piece& piece, vtk::CellArray array, const std::string& path) {
  const NumberType type = array == vtk::CellArray::quality ? NumberType::float32 : NumberType::int32;
  const auto out = file_.begin(path, type, piece.num_elements());
  piece.put_cell_array(array, *out, meter_);
  out->finish();
}

void Writer::write_vtkhdf() {
  file_.make_group("/VTKHDF");
  file_.put_attribute("/VTKHDF", "Version", std::array<std::int64_t, 2>{1, 0});
  file_.put_attribute("/VTKHDF", "Type", "UnstructuredGrid");
  for (const auto& [name, count] : {std::pair<const char*, std::int64_t>{"NumberOfPoints", cells_.num_nodes()},
                                    {"NumberOfCells", cells_.num_elements()},
                                    {"NumberOfConnectivityIds", cells_.num_corners()}})
    file_.put(std::string("/VTKHDF/") + name, std::span<const std::int64_t>(&count, 1));
  const auto points = file_.begin("/VTKHDF/Points", NumberType::float64, cells_.num_nodes(), 3);
  cells_.put_points(source_.unit_m() / metres_per(options_.unit), *points, meter_);
  points->finish();
  const auto corners = file_.begin("/VTKHDF/Connectivity", index_type(), cells_.num_corners());
  if (const std::vector<ElementKind> kinds = kinds_of(source_, 3); kinds.size() == 1) {
    // Both arrays in one go: the rows are made once.
    const auto rows = file_.begin(path_of(kinds.front()), index_type(), cells_.num_elements(), mesh::nodes_of(kinds.front()));
    cells_.put_corners_twice(options_.vtk_wedge, index_bytes_, *corners, *rows, meter_);
    rows->finish();
  } else {
    cells_.put_corners(options_.vtk_wedge, index_bytes_, *corners, meter_);
  }
  corners->finish();
  const auto ends = file_.begin("/VTKHDF/Offsets", index_type(), cells_.num_elements() + 1);
  cells_.put_ends(true, index_bytes_, *ends, meter_);
  ends->finish();
  const auto types = file_.begin("/VTKHDF/Types", NumberType::uint8, cells_.num_elements());
  cells_.put_types(*types, meter_);
  types->finish();
  for (const vtk::CellArray array : cells_.cell_arrays())
    write_array(cells_, array, "/VTKHDF/CellData/" + std::string(vtk::name_of(array)));
}

void Writer::write_tables() {
  std::vector<std::string> names[2], materials;
  std::vector<std::int32_t> ids[2];
  for (const mesh::ElementGroup& group : source_.groups()) {
    names[group.dimension - 2].push_back(group.name);
    ids[group.dimension - 2].push_back(group.tag);
  }
  for (const board::Material& material : source_.materials()) materials.push_back(material.name);
  const std::string field = "/VTKHDF/FieldData/";
  for (const int i : {1, 0}) {
    const std::string kind = i == 1 ? "volume" : "face";
    file_.put_strings_for_vtk(field + kind + "_names", names[i]);
    file_.put(field + kind + "_tags", std::span<const std::int32_t>(ids[i]));
  }
  file_.put_strings_for_vtk(field + "layers", source_.layers());
  file_.put_strings_for_vtk(field + "materials", materials);
  file_.put_strings_for_vtk(field + "nets", source_.nets());
}

HeavyGrid grid_of(const vtk::Piece& piece, ElementKind kind) {
  return {std::string(xdmf_names[static_cast<std::size_t>(kind)]),
          path_of(kind),
          piece.num_elements(),
          mesh::nodes_of(kind),
          piece.num_corners(),
          piece.cell_arrays(),
          {}};
}

void Writer::write_rows(const vtk::Piece& piece, ElementKind kind) {
  const auto out = file_.begin(path_of(kind), index_type(), piece.num_elements(), mesh::nodes_of(kind));
  piece.put_corners(VtkWedge::parametric, index_bytes_, *out, meter_);
  out->finish();
}

void Writer::write_cells(HeavyFile& out) {
  const std::vector<ElementKind> kinds = kinds_of(source_, 3);
  for (const ElementKind kind : kinds) {
    const vtk::Piece piece(source_, vtk::runs_of(source_, [&](const mesh::ElementBlock& b) { return b.kind == kind; }), true,
                           progress_);
    const std::string path = path_of(kind);
    if (kinds.size() > 1) write_rows(piece, kind);
    out.cells.push_back(grid_of(piece, kind));
    if (kinds.size() == 1 && mesh::order_of(kind) == 1) out.cells.back().vtk_path = "/VTKHDF/Connectivity";
    for (const vtk::CellArray array : piece.cell_arrays()) {
      const std::string name(vtk::name_of(array));
      if (kinds.size() == 1)
        file_.link("/VTKHDF/CellData/" + name, path + "_" + name);
      else
        write_array(piece, array, path + "_" + name);
    }
  }
}

/// One stream: the kind's code, then its nodes.
void Writer::write_mixed_faces(const vtk::Piece& piece, const std::string& path, HeavyGrid& grid) {
  grid = {"Mixed", path, piece.num_elements(), 0, piece.num_elements() + piece.num_corners(), piece.cell_arrays()};
  const auto out = file_.begin(path, index_type(), grid.num_numbers);
  const auto put = [&](std::int64_t value) {
    index_bytes_ == 8 ? out->put(value) : out->put(static_cast<std::int32_t>(value));
  };
  for (std::size_t i = 0; i < source_.blocks().size(); ++i) {
    const mesh::ElementBlock& block = source_.blocks()[i];
    if (mesh::dimension_of(block.kind) != 2) continue;
    const auto width = static_cast<std::size_t>(mesh::nodes_of(block.kind));
    source_.visit(i, [&](std::span<const std::int64_t> nodes) {
      for (std::size_t at = 0; at < nodes.size(); ++at) {
        if (at % width == 0) put(xdmf_codes[static_cast<std::size_t>(block.kind)]);
        put(nodes[at]);
      }
      progress_.check();
    });
  }
  out->finish();
}

void Writer::write_faces(HeavyFile& out) {
  const vtk::Piece piece(source_,
                         vtk::runs_of(source_, [](const mesh::ElementBlock& b) { return mesh::dimension_of(b.kind) == 2; }),
                         true, progress_);
  const std::vector<ElementKind> kinds = kinds_of(source_, 2);
  if (kinds.empty()) return;
  HeavyGrid grid;
  if (kinds.size() == 1) {
    write_rows(piece, kinds.front());
    grid = grid_of(piece, kinds.front());
  } else {
    write_mixed_faces(piece, "/mesh/faces", grid);
  }
  for (const vtk::CellArray array : grid.arrays) write_array(piece, array, grid.path + "_" + std::string(vtk::name_of(array)));
  out.faces.push_back(std::move(grid));
}

void Writer::write(const HeavyVisit& before_it_appears) {
  file_.make_group("/mesh");
  write_vtkhdf();
  write_tables();
  file_.put_attribute("/mesh", "unit_m", metres_per(options_.unit));
  file_.put_attribute("/mesh", "vtk_wedge", name_of(options_.vtk_wedge));
  file_.link("/VTKHDF/Points", "/mesh/points");
  HeavyFile out{source_.num_nodes(), index_bytes_, {}, {}};
  write_cells(out);
  write_faces(out);
  progress_.check();
  file_.save();
  if (before_it_appears) before_it_appears(out);
  file_.commit();
}

}  // namespace

void write_heavy(mesh::MeshSource& source, const std::filesystem::path& file, const WriteMeshOptions& options,
                 const Progress& progress, const HeavyVisit& before_it_appears) {
  if (options.compression == Compression::lz4)
    throw Error(ErrorCode::usage, "HDF5 files are packed with zlib alone; choose zlib, or a VTU file for LZ4",
                {.file = file.string()});
  Writer(source, file, options, progress).write(before_it_appears);
}

}  // namespace pcbmesh::formats::vtkhdf
