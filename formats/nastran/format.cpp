// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/nastran/format.hpp"

#include <fmt/format.h>

#include <array>
#include <string>

#include "formats/elements/element_walk.hpp"

namespace pcbmesh::formats::nastran {
namespace {

using mesh::ElementKind;

constexpr std::array<std::string_view, 2> extensions{".bdf", ".nas"};
constexpr std::int64_t most = 99'999'999;  // eight digits
constexpr std::size_t field = 8, large_field = 16, fields_per_line = 8;

std::string_view card_of(ElementKind kind) {
  constexpr std::string_view cards[] = {"CTRIA3", "CQUAD4", "CTETRA", "CPYRAM", "CPENTA", "CHEXA",
                                        "CTRIA6", "CQUAD8", "",       "CTETRA", "CPENTA", ""};
  return cards[static_cast<int>(kind)];
}

void put_left(FileSink& sink, std::string_view text) {
  sink.put(text);
  sink.put(std::string_view("                ").substr(0, field - text.size()));
}

/// GRID in large fields over two lines: sixteen characters per coordinate.
void write_nodes(const WriteJob& job) {
  FileSink& sink = job.sink;
  const auto put_coordinate = [&](double x) {
    const std::uint64_t start = sink.size();
    put_real(sink, x, large_field);
    for (std::uint64_t used = sink.size() - start; used < large_field; ++used) sink.put(" ");
  };
  visit_nodes(job, [&](std::int64_t first, std::span<const std::array<double, 3>> nodes) {
    for (const auto& node : nodes) {
      sink.put("GRID*   ");
      put_padded(sink, ++first, large_field);
      sink.put("                ");
      put_coordinate(node[0]);
      put_coordinate(node[1]);
      sink.put("\n*       ");
      put_coordinate(node[2]);
      sink.put("\n");
    }
  });
}

void write_elements(const WriteJob& job) {
  FileSink& sink = job.sink;
  std::int64_t number = 1;
  for (std::size_t b = 0; b < job.source.blocks().size(); ++b) {
    const mesh::ElementBlock& block = job.source.blocks()[b];
    const mesh::ElementGroup& group = job.source.groups()[static_cast<std::size_t>(block.group)];
    sink.put(fmt::format("$ {} {}: {}\n", group.dimension == 3 ? "volume" : "surface", group.tag, group.name));
    number = visit_elements(job, b, NodeOrder::exodus, number, [&](std::int64_t id, std::span<const std::int64_t> nodes) {
      put_left(sink, card_of(block.kind));
      put_padded(sink, id, field);
      put_padded(sink, block.tag, field);
      std::size_t used = 2;
      for (const std::int64_t node : nodes) {
        if (used == fields_per_line) {
          sink.put("\n+       ");
          used = 0;
        }
        put_padded(sink, node + 1, field);
        ++used;
      }
      sink.put("\n");
    });
  }
}

void write(mesh::MeshSource& source, const std::filesystem::path& file, const WriteMeshOptions& options,
           const Progress& progress) {
  FileSink sink(file);
  const WriteJob job{source, sink, source.unit_m() / metres_per(options.unit), progress, file};
  require_count(job, "Nastran bulk data in fields of eight characters", most);
  sink.put("$ Written by pcbmesh. Property = tag; volumes and surfaces are numbered on their own.\nBEGIN BULK\n");
  write_nodes(job);
  write_elements(job);
  sink.put("ENDDATA\n");
  progress.check();
  sink.commit();
}

using enum ElementKind;
constexpr KindSet kinds =
    kind_set(triangle, quadrangle, tetrahedron, pyramid, wedge, hexahedron, triangle6, quadrangle8, tetrahedron10, wedge15);

}  // namespace

constinit const MeshFormat mesh_format{"nastran",  "Nastran bulk data",
                                       extensions, write,
                                       nullptr,    {.written = kinds, .readable = 0, .has_tags = true, .has_names = false}};

}  // namespace pcbmesh::formats::nastran
