// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/abaqus/format.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <vector>

#include "formats/abaqus/read_inp.hpp"
#include "formats/elements/element_walk.hpp"
#include "formats/face_parents/face_parents.hpp"

namespace pcbmesh::formats::abaqus {
namespace {

using mesh::ElementKind;

constexpr std::array<std::string_view, 1> extensions{".inp"};
constexpr std::size_t widest_real = 20;  // CalculiX reads no more
constexpr std::size_t longest_name = 80;

std::string_view type_of(ElementKind kind) {
  constexpr std::string_view types[] = {"", "", "C3D4", "C3D5", "C3D6", "C3D8", "", "", "", "C3D10", "C3D15", ""};
  return types[static_cast<int>(kind)];
}

/// Number of a side of a cell, S1 to S6, by its index in sides_of().
int side_number(ElementKind kind, std::int32_t side) {
  constexpr int tetrahedron[] = {1, 2, 3, 4};
  return mesh::corners_of(kind) == 4 ? tetrahedron[side] : side + 1;
}

/// "V3_top_copper_GND": the tag makes it unique and lets it be read back.
std::string set_name(char what, const mesh::ElementGroup& group) {
  return plain_word(fmt::format("{}{}_{}", what, group.tag, group.name), longest_name);
}

void write_opening(const WriteJob& job) {
  job.sink.put("** Written by pcbmesh. Element sets V<tag>, node sets N<tag> and surfaces S<tag> of these groups:\n");
  for (const mesh::ElementGroup& group : job.source.groups())
    if (group.num_elements > 0)
      job.sink.put(fmt::format("** {} {} {}\n", group.dimension == 3 ? "volume" : "surface", group.tag, group.name));
}

void write_nodes(const WriteJob& job) {
  FileSink& sink = job.sink;
  sink.put("*NODE, NSET=ALL_NODES\n");
  visit_nodes(job, [&](std::int64_t first, std::span<const std::array<double, 3>> nodes) {
    for (const auto& node : nodes) {
      sink.put_number(++first);
      for (const double x : node) {
        sink.put(", ");
        put_real(sink, x, widest_real);
      }
      sink.put("\n");
    }
  });
}

void write_elements(const WriteJob& job) {
  FileSink& sink = job.sink;
  std::int64_t number = 1;
  for (std::size_t b = 0; b < job.source.blocks().size(); ++b) {
    const mesh::ElementBlock& block = job.source.blocks()[b];
    if (mesh::dimension_of(block.kind) != 3) continue;
    sink.put(fmt::format("*ELEMENT, TYPE={}, ELSET={}\n", type_of(block.kind),
                         set_name('V', job.source.groups()[static_cast<std::size_t>(block.group)])));
    number = visit_elements(job, b, NodeOrder::vtk, number, [&](std::int64_t id, std::span<const std::int64_t> nodes) {
      sink.put_number(id);
      for (const std::int64_t node : nodes) {
        sink.put(", ");
        sink.put_number(node + 1);
      }
      sink.put("\n");
    });
  }
}

/// Surfaces for loads, node sets for boundary values.
void write_faces(const WriteJob& job) {
  if (job.source.num_elements(2) == 0) return;
  FileSink& sink = job.sink;
  const FaceParents parents(job.source, job.progress);
  parents.require_no_loose("Abaqus input", job.file);
  std::int64_t face = 0;
  for (std::size_t b = 0; b < job.source.blocks().size();) {
    const std::int32_t group_index = job.source.blocks()[b].group;
    const mesh::ElementGroup& group = job.source.groups()[static_cast<std::size_t>(group_index)];
    if (group.dimension != 2) break;
    std::vector<std::int64_t> nodes_of_group;
    sink.put(fmt::format("*SURFACE, NAME={}, TYPE=ELEMENT\n", set_name('S', group)));
    for (; b < job.source.blocks().size() && job.source.blocks()[b].group == group_index; ++b) {
      face = visit_elements(job, b, NodeOrder::vtk, face, [&](std::int64_t id, std::span<const std::int64_t> nodes) {
        const FaceParents::Parent parent = parents.of(id)[0];
        sink.put_number(parent.cell + 1);
        sink.put(", S");
        sink.put_number(side_number(parent.kind, parent.side));
        sink.put("\n");
        nodes_of_group.insert(nodes_of_group.end(), nodes.begin(), nodes.end());
      });
    }
    std::ranges::sort(nodes_of_group);
    nodes_of_group.erase(std::unique(nodes_of_group.begin(), nodes_of_group.end()), nodes_of_group.end());
    sink.put(fmt::format("*NSET, NSET={}\n", set_name('N', group)));
    for (std::size_t i = 0; i < nodes_of_group.size(); ++i) {
      sink.put_number(nodes_of_group[i] + 1);
      sink.put(i % 8 == 7 || i + 1 == nodes_of_group.size() ? "\n" : ", ");
    }
  }
}

void write(mesh::MeshSource& source, const std::filesystem::path& file, const WriteMeshOptions& options,
           const Progress& progress) {
  FileSink sink(file);
  const WriteJob job{source, sink, source.unit_m() / metres_per(options.unit), progress, file};
  require_count(job, "Abaqus input", std::numeric_limits<std::int32_t>::max());
  write_opening(job);
  write_nodes(job);
  write_elements(job);
  write_faces(job);
  progress.check();
  sink.commit();
}

using enum ElementKind;
constexpr KindSet solids = kind_set(tetrahedron, pyramid, wedge, hexahedron, tetrahedron10, wedge15);
constexpr KindSet faces = kind_set(triangle, quadrangle, triangle6, quadrangle8);

}  // namespace

constinit const MeshFormat mesh_format{
    "abaqus",   "Abaqus and CalculiX input",
    extensions, write,
    read_inp,   {.written = solids | faces, .readable = solids | faces, .has_tags = true, .has_names = true}};

}  // namespace pcbmesh::formats::abaqus
