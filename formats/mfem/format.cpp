// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/mfem/format.hpp"

#include <fmt/format.h>

#include <array>
#include <limits>

#include "formats/elements/element_walk.hpp"
#include "formats/mfem/read_mfem.hpp"
#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats::mfem {
namespace {

using mesh::ElementKind;

constexpr std::array<std::string_view, 2> extensions{".mesh", ".mfem"};

/// MFEM's number of a geometry.
int geometry_of(ElementKind kind) {
  constexpr int geometries[] = {2, 3, 4, 7, 6, 5};
  return geometries[static_cast<int>(kind)];
}

void write_elements(const WriteJob& job, int dimension) {
  FileSink& sink = job.sink;
  sink.put(dimension == 3 ? "\nelements\n" : "\nboundary\n");
  sink.put_number(job.source.num_elements(dimension));
  sink.put("\n");
  for (std::size_t b = 0; b < job.source.blocks().size(); ++b) {
    const mesh::ElementBlock& block = job.source.blocks()[b];
    if (mesh::dimension_of(block.kind) != dimension) continue;
    const std::string opening = fmt::format("{} {}", block.tag, geometry_of(block.kind));
    visit_elements(job, b, NodeOrder::gmsh, 0, [&](std::int64_t, std::span<const std::int64_t> nodes) {
      sink.put(opening);
      for (const std::int64_t node : nodes) {
        sink.put(" ");
        sink.put_number(node);
      }
      sink.put("\n");
    });
  }
}

void write_sets(const WriteJob& job, int dimension) {
  FileSink& sink = job.sink;
  std::int64_t count = 0;
  for (const mesh::ElementGroup& group : job.source.groups()) count += group.dimension == dimension && group.num_elements > 0;
  sink.put(dimension == 3 ? "\nattribute_sets\n" : "\nbdr_attribute_sets\n");
  sink.put_number(count);
  sink.put("\n");
  for (const mesh::ElementGroup& group : job.source.groups())
    if (group.dimension == dimension && group.num_elements > 0) sink.put(fmt::format("\"{}\" 1 {}\n", group.name, group.tag));
}

void write(mesh::MeshSource& source, const std::filesystem::path& file, const WriteMeshOptions& options,
           const Progress& progress) {
  const bool has_sets = options.mfem_version.empty() || options.mfem_version == "1.3";
  if (!has_sets && options.mfem_version != "1.0")
    throw Error(ErrorCode::usage, fmt::format("there is no MFEM mesh version '{}' here; use 1.3 or 1.0", options.mfem_version),
                {.file = file.string()});
  FileSink sink(file);
  const WriteJob job{source, sink, source.unit_m() / metres_per(options.unit), progress, file};
  require_count(job, "MFEM", std::numeric_limits<std::int32_t>::max());
  sink.put(has_sets ? "MFEM mesh v1.3\n" : "MFEM mesh v1.0\n");
  sink.put("\ndimension\n3\n");
  write_elements(job, 3);
  if (has_sets) write_sets(job, 3);
  write_elements(job, 2);
  if (has_sets) write_sets(job, 2);
  sink.put("\nvertices\n");
  sink.put_number(source.num_nodes());
  sink.put("\n3\n");
  visit_nodes(job, [&](std::int64_t, std::span<const std::array<double, 3>> nodes) {
    for (const auto& node : nodes)
      for (std::size_t i = 0; i < 3; ++i) {
        sink.put_number(node[i]);
        sink.put(i < 2 ? " " : "\n");
      }
  });
  if (has_sets) sink.put("\nmfem_mesh_end\n");
  progress.check();
  sink.commit();
}

using enum ElementKind;
constexpr KindSet kinds = kind_set(triangle, quadrangle, tetrahedron, pyramid, wedge, hexahedron);

}  // namespace

constinit const MeshFormat mesh_format{"mfem",     "MFEM mesh, versions 1.3 and 1.0 (Palace, MFEM)",
                                       extensions, write,
                                       read_mfem,  {.written = kinds, .readable = kinds, .has_tags = true, .has_names = true}};

}  // namespace pcbmesh::formats::mfem
