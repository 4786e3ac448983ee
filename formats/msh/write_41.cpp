// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/msh/write_msh.hpp"
#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats::msh {
namespace {

void write_entities(const WriteJob& job) {
  Fields out(job);
  job.sink.put("$Entities\n");
  const auto groups = job.source.groups();
  const auto num_surfaces = std::ranges::count(groups, 2, &mesh::ElementGroup::dimension);
  for (const std::int64_t count : {std::int64_t{0}, std::int64_t{0}, static_cast<std::int64_t>(num_surfaces),
                                   static_cast<std::int64_t>(groups.size()) - num_surfaces})
    out.size(count);
  out.end_line();
  for (std::size_t i = 0; i < groups.size(); ++i) {  // faces stand before volumes, as the section wants it
    const mesh::ElementGroup& group = groups[i];
    const mesh::Extent extent = job.source.extent_of(i);
    out.integer(group.tag);
    for (const auto& corner : {extent.min, extent.max})
      for (const double x : corner) out.real(x * job.scale);
    out.size(1);
    out.integer(group.tag);
    out.size(0);  // no bounding entities: readers rebuild adjacency from the elements
    out.end_line();
  }
  job.sink.put(job.binary ? "\n$EndEntities\n" : "$EndEntities\n");
}

void write_node_tags(const WriteJob& job, std::int64_t num_nodes) {
  constexpr std::int64_t block = 8192;
  for (std::int64_t first = 1; first <= num_nodes; first += block) {
    const std::int64_t last = std::min(num_nodes, first + block - 1);
    if (job.binary) {
      const auto size = static_cast<std::size_t>(last - first + 1) * sizeof first;
      char* to = job.sink.room(size);
      for (std::int64_t tag = first; tag <= last; ++tag, to += sizeof tag) std::memcpy(to, &tag, sizeof tag);
      job.sink.advance(size);
    } else {
      for (std::int64_t tag = first; tag <= last; ++tag) {
        job.sink.put_number(tag);
        job.sink.put("\n");
      }
    }
    job.progress.check();
  }
}

void write_nodes(const WriteJob& job, Meter& meter) {
  Fields out(job);
  FileSink& sink = job.sink;
  const std::int64_t num_nodes = job.source.num_nodes();
  sink.put("$Nodes\n");
  for (const std::int64_t count : {std::int64_t{num_nodes > 0}, num_nodes, std::int64_t{num_nodes > 0}, num_nodes})
    out.size(count);
  out.end_line();
  if (num_nodes > 0) {
    out.integer(job.source.groups().back().dimension);
    out.integer(job.source.groups().back().tag);
    out.integer(0);  // no parametric coordinates
    out.size(num_nodes);
    out.end_line();
  }
  write_node_tags(job, num_nodes);
  visit_nodes(job, [&](std::int64_t, std::span<const std::array<double, 3>> nodes) {
    if (job.binary) {
      sink.put_bytes(nodes.data(), nodes.size_bytes());
    } else {
      for (const auto& node : nodes)
        for (std::size_t i = 0; i < 3; ++i) {
          sink.put_number(node[i]);
          sink.put(i < 2 ? " " : "\n");
        }
    }
    meter.add(static_cast<std::int64_t>(nodes.size()));
  });
  sink.put(job.binary ? "\n$EndNodes\n" : "$EndNodes\n");
}

/// One element per row: its tag, then its nodes' tags, counted from 1.
template <std::size_t width>
void write_rows_binary(FileSink& sink, std::int64_t tag, std::span<const std::int64_t> corners) {
  constexpr std::size_t row = (1 + width) * sizeof tag;
  const std::size_t num_bytes = corners.size() / width * row;
  char* to = sink.room(num_bytes);
  const std::int64_t* from = corners.data();
  for (char* const end = to + num_bytes; to != end; to += row, from += width) {
    // Value by value: rows put together elsewhere first would be read back before they have left the processor.
    store(to, tag++);
    for (std::size_t i = 0; i < width; ++i) store(to + (1 + i) * sizeof tag, from[i] + 1);
  }
  sink.advance(num_bytes);
}

void write_rows_text(FileSink& sink, std::size_t width, std::int64_t tag, std::span<const std::int64_t> corners) {
  for (std::size_t at = 0; at < corners.size(); at += width, ++tag) {
    sink.put_number(tag);
    for (std::size_t i = 0; i < width; ++i) {
      sink.put(" ");
      sink.put_number(corners[at + i] + 1);
    }
    sink.put("\n");
  }
}

void write_rows(const WriteJob& job, mesh::ElementKind kind, std::int64_t tag, std::span<const std::int64_t> nodes) {
  if (!job.binary) return write_rows_text(job.sink, static_cast<std::size_t>(mesh::nodes_of(kind)), tag, nodes);
  with_width(kind, [&]<std::size_t known>() { write_rows_binary<known>(job.sink, tag, nodes); });
}

void write_elements(const WriteJob& job, Meter& meter) {
  Fields out(job);
  const std::int64_t count = num_elements(job.source);
  job.sink.put("$Elements\n");
  for (const std::int64_t field :
       {static_cast<std::int64_t>(job.source.blocks().size()), count, std::int64_t{count > 0}, count})
    out.size(field);
  out.end_line();
  std::int64_t tag = 1;
  for (std::size_t i = 0; i < job.source.blocks().size(); ++i) {
    const mesh::ElementBlock& block = job.source.blocks()[i];
    out.integer(mesh::dimension_of(block.kind));
    out.integer(block.tag);
    out.integer(gmsh_type(block.kind));
    out.size(block.count);
    out.end_line();
    const auto width = static_cast<std::size_t>(mesh::nodes_of(block.kind));
    job.source.visit(i, [&](std::span<const std::int64_t> nodes) {
      write_rows(job, block.kind, tag, nodes);
      const auto rows = static_cast<std::int64_t>(nodes.size() / width);
      tag += rows;
      meter.add(rows);
    });
  }
  job.sink.put(job.binary ? "\n$EndElements\n" : "$EndElements\n");
}

}  // namespace

std::uint64_t expected_bytes_41(const mesh::MeshSource& source, bool binary) {
  if (!binary) return 0;
  std::uint64_t bytes = static_cast<std::uint64_t>(source.num_nodes()) * 32;
  for (const mesh::ElementBlock& block : source.blocks())
    bytes += static_cast<std::uint64_t>(block.count) * static_cast<std::uint64_t>(8 + 8 * mesh::nodes_of(block.kind));
  return bytes;
}

void write_41(const WriteJob& job) {
  Meter meter(job.progress, job.source.num_nodes() + num_elements(job.source));
  write_opening(job, "4.1");
  write_entities(job);
  write_nodes(job, meter);
  write_elements(job, meter);
  write_periodic_41(job);
}

}  // namespace pcbmesh::formats::msh
