// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/unv/format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <string>

#include "formats/elements/element_walk.hpp"

namespace pcbmesh::formats::unv {
namespace {

using mesh::ElementKind;

constexpr std::array<std::string_view, 1> extensions{".unv"};
constexpr std::size_t integer = 10, real = 25;
constexpr std::size_t longest_name = 40;

/// Descriptor of an element kind in data set 2412.
int descriptor_of(ElementKind kind) {
  constexpr int descriptors[] = {91, 94, 111, 0, 112, 115};
  return descriptors[static_cast<int>(kind)];
}

void put_integers(FileSink& sink, std::initializer_list<std::int64_t> values) {
  for (const std::int64_t value : values) put_padded(sink, value, integer);
  sink.put("\n");
}

/// Seventeen digits, which read back to the same value, with the exponent letter of FORTRAN.
void put_real(FileSink& sink, double value) {
  std::array<char, 40> text;
  char* end = std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::scientific, 16).ptr;
  std::replace(text.data(), end, 'e', 'D');
  const auto size = static_cast<std::size_t>(end - text.data());
  sink.put(std::string_view("                         ").substr(0, real - std::min(real, size)));
  sink.put({text.data(), size});
}

void write_units(const WriteJob& job, LengthUnit unit) {
  // Units code 1 = SI, 5 = mm; lengths, forces, temperatures as factors from SI.
  job.sink.put("    -1\n   164\n");
  job.sink.put(unit == LengthUnit::metre ? "         1  SI: metre           2\n" : "         9USER_DEFINED             2\n");
  for (const double factor : {1.0 / metres_per(unit), 1.0, 1.0}) put_real(job.sink, factor);
  job.sink.put("\n");
  put_real(job.sink, 273.15);
  job.sink.put("\n    -1\n");
}

void write_nodes(const WriteJob& job) {
  FileSink& sink = job.sink;
  sink.put("    -1\n  2411\n");
  visit_nodes(job, [&](std::int64_t first, std::span<const std::array<double, 3>> nodes) {
    for (const auto& node : nodes) {
      put_integers(sink, {++first, 1, 1, 11});
      for (const double x : node) put_real(sink, x);
      sink.put("\n");
    }
  });
  sink.put("    -1\n");
}

void write_elements(const WriteJob& job) {
  FileSink& sink = job.sink;
  sink.put("    -1\n  2412\n");
  std::int64_t number = 1;
  for (std::size_t b = 0; b < job.source.blocks().size(); ++b) {
    const mesh::ElementBlock& block = job.source.blocks()[b];
    number = visit_elements(job, b, NodeOrder::gmsh, number, [&](std::int64_t id, std::span<const std::int64_t> nodes) {
      put_integers(sink, {id, descriptor_of(block.kind), block.tag, block.tag, 7, static_cast<std::int64_t>(nodes.size())});
      for (const std::int64_t node : nodes) put_padded(sink, node + 1, integer);
      sink.put("\n");
    });
  }
  sink.put("    -1\n");
}

/// One permanent group per tag; two elements a line.
void write_groups(const WriteJob& job) {
  FileSink& sink = job.sink;
  sink.put("    -1\n  2467\n");
  std::int64_t first = 1, group_number = 0;
  for (const mesh::ElementGroup& group : job.source.groups()) {
    if (group.num_elements == 0) continue;
    put_integers(sink, {++group_number, 0, 0, 0, 0, 0, 0, group.num_elements});
    sink.put(std::string_view(group.name).substr(0, longest_name));
    sink.put("\n");
    for (std::int64_t i = 0; i < group.num_elements; ++i) {
      for (const std::int64_t value : {std::int64_t{8}, first + i, std::int64_t{0}, std::int64_t{0}})
        put_padded(sink, value, integer);
      if (i % 2 == 1 || i + 1 == group.num_elements) sink.put("\n");
    }
    first += group.num_elements;
  }
  sink.put("    -1\n");
}

void write(mesh::MeshSource& source, const std::filesystem::path& file, const WriteMeshOptions& options,
           const Progress& progress) {
  FileSink sink(file);
  const WriteJob job{source, sink, source.unit_m() / metres_per(options.unit), progress, file};
  require_count(job, "UNV", std::numeric_limits<std::int32_t>::max());
  write_units(job, options.unit);
  write_nodes(job);
  write_elements(job);
  write_groups(job);
  progress.check();
  sink.commit();
}

using enum ElementKind;
constexpr KindSet kinds = kind_set(triangle, quadrangle, tetrahedron, wedge, hexahedron);

}  // namespace

constinit const MeshFormat mesh_format{"unv",      "Universal file of I-DEAS",
                                       extensions, write,
                                       nullptr,    {.written = kinds, .readable = 0, .has_tags = true, .has_names = true}};

}  // namespace pcbmesh::formats::unv
