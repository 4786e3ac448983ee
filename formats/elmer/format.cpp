// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/elmer/format.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <string>

#include "formats/elements/element_walk.hpp"
#include "formats/face_parents/face_parents.hpp"
#include "formats/sink/folder_sink.hpp"

namespace pcbmesh::formats::elmer {
namespace {

using mesh::ElementKind;

constexpr std::array<std::string_view, 1> extensions{".elmer"};
constexpr std::array<std::string_view, 5> names{"mesh.header", "mesh.nodes", "mesh.elements", "mesh.boundary", "mesh.names"};

/// Elmer's number of an element kind: family of the shape, then nodes.
int type_of(ElementKind kind) {
  constexpr int types[] = {303, 404, 504, 605, 706, 808, 306, 408, 409, 510, 715, 718};
  return types[static_cast<int>(kind)];
}

struct Job {
  mesh::MeshSource& source;
  const FolderSink& folder;
  double scale;
  const Progress& progress;
};

template <class Write>
void write_file(const Job& job, std::string_view name, Write&& write) {
  const std::filesystem::path file = job.folder.file(name);
  FileSink sink(file);
  const WriteJob inner{job.source, sink, job.scale, job.progress, file};
  write(inner, sink);
  job.progress.check();
  sink.commit();
}

void put_words(FileSink& sink, std::initializer_list<std::int64_t> numbers) {
  for (const std::int64_t number : numbers) {
    sink.put_number(number);
    sink.put(" ");
  }
}

void put_row(FileSink& sink, std::span<const std::int64_t> nodes) {
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    sink.put_number(nodes[i] + 1);
    sink.put(i + 1 < nodes.size() ? " " : "\n");
  }
}

void write_header(const WriteJob& job, FileSink& sink) {
  std::map<int, std::int64_t> counts;
  for (const mesh::ElementBlock& block : job.source.blocks()) counts[type_of(block.kind)] += block.count;
  put_words(sink, {job.source.num_nodes(), job.source.num_elements(3), job.source.num_elements(2)});
  sink.put("\n");
  sink.put_number(counts.size());
  sink.put("\n");
  for (const auto& [type, count] : counts) {
    put_words(sink, {type, count});
    sink.put("\n");
  }
}

void write_nodes(const WriteJob& job, FileSink& sink) {
  visit_nodes(job, [&](std::int64_t first, std::span<const std::array<double, 3>> nodes) {
    for (const auto& node : nodes) {
      sink.put_number(++first);
      sink.put(" -1");
      for (const double x : node) {
        sink.put(" ");
        sink.put_number(x);
      }
      sink.put("\n");
    }
  });
}

void write_elements(const WriteJob& job, FileSink& sink) {
  std::int64_t number = 1;
  for (std::size_t b = 0; b < job.source.blocks().size(); ++b) {
    const mesh::ElementBlock& block = job.source.blocks()[b];
    if (mesh::dimension_of(block.kind) != 3) continue;
    number = visit_elements(job, b, NodeOrder::exodus, number, [&](std::int64_t id, std::span<const std::int64_t> nodes) {
      put_words(sink, {id, block.tag, type_of(block.kind)});
      put_row(sink, nodes);
    });
  }
}

void write_boundary(const WriteJob& job, FileSink& sink) {
  const FaceParents parents(job.source, job.progress);
  std::int64_t number = 1;
  for (std::size_t b = 0; b < job.source.blocks().size(); ++b) {
    const mesh::ElementBlock& block = job.source.blocks()[b];
    if (mesh::dimension_of(block.kind) != 2) continue;
    number = visit_elements(job, b, NodeOrder::exodus, number, [&](std::int64_t id, std::span<const std::int64_t> nodes) {
      const auto [first, second] = parents.of(id - 1);
      put_words(sink, {id, block.tag, first.cell + 1, second.cell + 1, type_of(block.kind)});
      put_row(sink, nodes);
    });
  }
}

/// "$ name = number" is read up to the '='; '!' starts a comment.
std::string spelt(std::string name) {
  for (char& c : name)
    if (c == '=' || c == '!' || c == '$') c = '_';
  return name;
}

void write_names(const WriteJob& job, FileSink& sink) {
  for (const int dimension : {3, 2}) {
    sink.put(dimension == 3 ? "! ----- names for bodies -----\n" : "! ----- names for boundaries -----\n");
    for (const mesh::ElementGroup& group : job.source.groups()) {
      if (group.dimension != dimension || group.num_elements == 0) continue;
      sink.put("$ " + spelt(group.name) + " = ");
      sink.put_number(group.tag);
      sink.put("\n");
    }
  }
}

void write(mesh::MeshSource& source, const std::filesystem::path& file, const WriteMeshOptions& options,
           const Progress& progress) {
  FolderSink folder(file, [](std::string_view name) { return std::ranges::find(names, name) != names.end(); });
  const Job job{source, folder, source.unit_m() / metres_per(options.unit), progress};
  write_file(job, "mesh.header", [](const WriteJob& inner, FileSink& sink) {
    require_count(inner, "Elmer", std::numeric_limits<std::int32_t>::max());
    write_header(inner, sink);
  });
  write_file(job, "mesh.nodes", write_nodes);
  write_file(job, "mesh.elements", write_elements);
  write_file(job, "mesh.boundary", write_boundary);
  write_file(job, "mesh.names", write_names);
  folder.commit();
}

using enum ElementKind;
constexpr KindSet kinds =
    kind_set(triangle, quadrangle, tetrahedron, pyramid, wedge, hexahedron, triangle6, quadrangle8, tetrahedron10, wedge15);

}  // namespace

constinit const MeshFormat mesh_format{
    "elmer",    "Elmer mesh, a folder of mesh.* files",
    extensions, write,
    nullptr,    {.written = kinds, .readable = 0, .has_tags = true, .has_names = true, .is_folder = true}};

}  // namespace pcbmesh::formats::elmer
