// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/msh/write_msh.hpp"

namespace pcbmesh::formats::msh {

void write_opening(const WriteJob& job, std::string_view version) {
  FileSink& sink = job.sink;
  sink.put("$MeshFormat\n");
  sink.put(version);
  sink.put(job.binary ? " 1 8\n" : " 0 8\n");
  if (job.binary) {
    sink.put_raw(std::int32_t{1});  // tells the reader our byte order
    sink.put("\n");
  }
  sink.put("$EndMeshFormat\n$PhysicalNames\n");
  sink.put_number(job.source.groups().size());
  sink.put("\n");
  for (const mesh::ElementGroup& group : job.source.groups()) {
    sink.put_number(group.dimension);
    sink.put(" ");
    sink.put_number(group.tag);
    sink.put(" \"");
    sink.put(group.name);
    sink.put("\"\n");
  }
  sink.put("$EndPhysicalNames\n");
}

std::int64_t num_elements(const mesh::MeshSource& source) {
  return source.num_elements(2) + source.num_elements(3);
}

void visit_nodes(const WriteJob& job, const NodeVisit& visit) {
  constexpr std::int64_t block = 1024;
  std::vector<std::array<double, 3>> nodes(block);
  for (std::int64_t first = 0; first < job.source.num_nodes(); first += block) {
    const auto part = std::span(nodes).first(static_cast<std::size_t>(std::min(block, job.source.num_nodes() - first)));
    job.source.fill_nodes(first, part);
    if (job.scale != 1)
      for (std::array<double, 3>& node : part)
        for (double& x : node) x *= job.scale;
    visit(first, part);
  }
}

}  // namespace pcbmesh::formats::msh
