// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/xdmf/format.hpp"

#include <fmt/format.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "formats/sink/file_sink.hpp"
#include "formats/vtkhdf/heavy_file.hpp"
#include "formats/xdmf/read_xdmf.hpp"

namespace pcbmesh::formats::xdmf {
namespace {

using vtkhdf::HeavyFile;
using vtkhdf::HeavyGrid;

constexpr std::array<std::string_view, 2> extensions{".xdmf", ".xmf"};

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '"' ? "&quot;" : std::string(1, c);
  return out;
}

class LightFile {
 public:
  LightFile(const std::filesystem::path& file, const std::filesystem::path& heavy_path, const HeavyFile& heavy)
      : sink_(file), heavy_name_(escaped(heavy_path.filename().string())), heavy_(heavy) {
    sink_.put("<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n <Domain>\n");
  }
  /// `for_vtk`: ParaView takes corners as they stand, and its wedges are wound the other way round.
  void put_grid(std::string_view name, const HeavyGrid& grid, bool for_vtk = false);
  void begin_collection() { sink_.put("  <Grid Name=\"board\" GridType=\"Collection\" CollectionType=\"Spatial\">\n"); }
  void end_collection() { sink_.put("  </Grid>\n"); }
  void save() {
    sink_.put(" </Domain>\n</Xdmf>\n");
    sink_.save();
  }
  void commit() { sink_.commit(); }

 private:
  void put_item(const std::string& dimensions, std::string_view type, std::size_t precision, const std::string& path) {
    sink_.put(
        fmt::format("     <DataItem Dimensions=\"{}\" NumberType=\"{}\" Precision=\"{}\" Format=\"HDF\">{}:{}</DataItem>\n",
                    dimensions, type, precision, heavy_name_, path));
  }

  FileSink sink_;
  std::string heavy_name_;
  const HeavyFile& heavy_;
};

void LightFile::put_grid(std::string_view name, const HeavyGrid& grid, bool for_vtk) {
  sink_.put(fmt::format("   <Grid Name=\"{}\" GridType=\"Uniform\">\n    <Geometry GeometryType=\"XYZ\">\n", name));
  put_item(fmt::format("{} 3", heavy_.num_nodes), "Float", 8, "/mesh/points");
  sink_.put(fmt::format("    </Geometry>\n    <Topology TopologyType=\"{}\" NumberOfElements=\"{}\"", grid.topology,
                        grid.num_elements));
  if (grid.num_columns > 0) sink_.put(fmt::format(" NodesPerElement=\"{}\"", grid.num_columns));
  sink_.put(">\n");
  const bool in_vtk_order = for_vtk && !grid.vtk_path.empty();
  put_item(grid.num_columns > 0 && !in_vtk_order ? fmt::format("{} {}", grid.num_elements, grid.num_columns)
                                                 : fmt::format("{}", grid.num_numbers),
           "Int", heavy_.index_bytes, in_vtk_order ? grid.vtk_path : grid.path);
  sink_.put("    </Topology>\n");
  for (const vtk::CellArray array : grid.arrays) {
    sink_.put(fmt::format("    <Attribute Name=\"{}\" AttributeType=\"Scalar\" Center=\"Cell\">\n", vtk::name_of(array)));
    put_item(fmt::format("{}", grid.num_elements), array == vtk::CellArray::quality ? "Float" : "Int", 4,
             grid.path + "_" + std::string(vtk::name_of(array)));
    sink_.put("    </Attribute>\n");
  }
  sink_.put("   </Grid>\n");
}

std::filesystem::path beside(const std::filesystem::path& file, std::string_view ending) {
  std::filesystem::path out = file;
  out.replace_extension();
  out += ending;
  return out;
}

std::filesystem::path heavy_of(const std::filesystem::path& file) {
  return beside(file, ".vtkhdf");
}
std::filesystem::path faces_of(const std::filesystem::path& file) {
  return beside(file, "_faces" + file.extension().string());
}
std::filesystem::path mixed_of(const std::filesystem::path& file) {
  return beside(file, "_paraview" + file.extension().string());
}
std::vector<std::filesystem::path> parts(const std::filesystem::path& file) {
  return {heavy_of(file), faces_of(file), mixed_of(file)};
}

void write(mesh::MeshSource& source, const std::filesystem::path& file, const WriteMeshOptions& options,
           const Progress& progress) {
  const std::filesystem::path heavy_path = heavy_of(file);
  std::vector<std::unique_ptr<LightFile>> light;
  const auto write_light = [&](const HeavyFile& heavy) {
    const auto put_cells = [&](LightFile& out, bool for_vtk) {
      for (const HeavyGrid& grid : heavy.cells) out.put_grid(heavy.cells.size() == 1 ? "cells" : grid.topology, grid, for_vtk);
    };
    const auto begin = [&](const std::filesystem::path& name) -> LightFile& {
      return *light.emplace_back(std::make_unique<LightFile>(name, heavy_path, heavy));
    };
    if (!heavy.faces.empty()) {
      LightFile& faces = begin(faces_of(file));
      faces.put_grid("faces", heavy.faces.front());
      faces.save();
    }
    LightFile& all = begin(mixed_of(file));
    all.begin_collection();
    put_cells(all, true);
    for (const HeavyGrid& grid : heavy.faces) all.put_grid("faces", grid);
    all.end_collection();
    all.save();
    LightFile& cells = begin(file);
    if (heavy.cells.size() > 1) cells.begin_collection();
    put_cells(cells, false);
    if (heavy.cells.size() > 1) cells.end_collection();
    cells.save();
  };
  // Numbers appear first: a light file that is there can be read.
  vtkhdf::write_heavy(source, heavy_path, options, progress, write_light);
  for (const auto& out : light) out->commit();
}

}  // namespace

constinit const MeshFormat mesh_format{
    "xdmf",     "XDMF 3 over HDF5 (dolfinx, meshio, ParaView)",
    extensions, write,
    read_xdmf,  {.written = all_kinds, .readable = all_kinds, .has_tags = true, .has_names = true},
    parts};

}  // namespace pcbmesh::formats::xdmf
