// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <limits>

#include "formats/msh/write_msh.hpp"
#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats::msh {
namespace {

constexpr std::int64_t most = std::numeric_limits<std::int32_t>::max();

void require_32_bit(std::int64_t count, std::string_view what, const std::filesystem::path& file) {
  if (count <= most) return;
  throw Error(
      ErrorCode::format_limit,
      fmt::format("MSH 2.2 numbers {} with 32 bits, at most {}, and this mesh has {}; write version 4.1 or a coarser mesh",
                  what, most, count),
      {.file = file.string()});
}

void write_nodes(const WriteJob& job, Meter& meter) {
  FileSink& sink = job.sink;
  sink.put("$Nodes\n");
  sink.put_number(job.source.num_nodes());
  sink.put("\n");
  visit_nodes(job, [&](std::int64_t first, std::span<const std::array<double, 3>> nodes) {
    std::int64_t number = first + 1;
    if (job.binary) {
      std::int32_t id = 0;
      constexpr std::size_t width = sizeof id + sizeof nodes[0];
      char* to = sink.room(nodes.size() * width);
      for (const auto& node : nodes) {
        id = static_cast<std::int32_t>(number++);
        std::memcpy(to, &id, sizeof id);
        std::memcpy(to + sizeof id, node.data(), sizeof node);
        to += width;
      }
      sink.advance(nodes.size() * width);
    } else {
      for (const auto& node : nodes) {
        sink.put_number(number++);
        for (const double x : node) {
          sink.put(" ");
          sink.put_number(x);
        }
        sink.put("\n");
      }
    }
    meter.add(static_cast<std::int64_t>(nodes.size()));
  });
  sink.put(job.binary ? "\n$EndNodes\n" : "$EndNodes\n");
}

template <std::size_t width>
void write_rows_of(FileSink& sink, std::int32_t tag, std::int64_t id, std::span<const std::int64_t> corners) {
  constexpr std::size_t row = (3 + width) * sizeof tag;
  const std::size_t num_bytes = corners.size() / width * row;
  char* to = sink.room(num_bytes);
  const std::int64_t* from = corners.data();
  for (char* const end = to + num_bytes; to != end; to += row, from += width) {
    store(to, static_cast<std::int32_t>(id++));
    store(to + sizeof tag, tag);
    store(to + 2 * sizeof tag, tag);
    for (std::size_t i = 0; i < width; ++i) store(to + (3 + i) * sizeof tag, static_cast<std::int32_t>(from[i] + 1));
  }
  sink.advance(num_bytes);
}

void write_rows_binary(FileSink& sink, const mesh::ElementBlock& block, std::int64_t id, std::span<const std::int64_t> nodes) {
  with_width(block.kind, [&]<std::size_t width>() { write_rows_of<width>(sink, block.tag, id, nodes); });
}

void write_rows_text(FileSink& sink, const mesh::ElementBlock& block, std::int64_t id, std::span<const std::int64_t> nodes) {
  const auto width = static_cast<std::size_t>(mesh::nodes_of(block.kind));
  const std::string middle = fmt::format(" {} 2 {} {}", gmsh_type(block.kind), block.tag, block.tag);
  for (std::size_t at = 0; at < nodes.size(); at += width) {
    sink.put_number(id++);
    sink.put(middle);
    for (std::size_t i = 0; i < width; ++i) {
      sink.put(" ");
      sink.put_number(nodes[at + i] + 1);
    }
    sink.put("\n");
  }
}

void write_elements(const WriteJob& job, Meter& meter) {
  FileSink& sink = job.sink;
  sink.put("$Elements\n");
  sink.put_number(num_elements(job.source));
  sink.put("\n");
  std::int64_t id = 1;
  for (std::size_t i = 0; i < job.source.blocks().size(); ++i) {
    const mesh::ElementBlock& block = job.source.blocks()[i];
    if (job.binary)  // one header for the whole block: 12 bytes per element less than a header each
      for (const std::int32_t field : {gmsh_type(block.kind), static_cast<std::int32_t>(block.count), 2}) sink.put_raw(field);
    job.source.visit(i, [&](std::span<const std::int64_t> nodes) {
      (job.binary ? write_rows_binary : write_rows_text)(sink, block, id, nodes);
      const std::int64_t count = static_cast<std::int64_t>(nodes.size()) / mesh::nodes_of(block.kind);
      id += count;
      meter.add(count);
    });
  }
  sink.put(job.binary ? "\n$EndElements\n" : "$EndElements\n");
}

}  // namespace

void require_fits_22(const mesh::MeshSource& source, const std::filesystem::path& file) {
  require_32_bit(source.num_nodes(), "nodes", file);
  require_32_bit(num_elements(source), "elements", file);
}

std::uint64_t expected_bytes_22(const mesh::MeshSource& source, bool binary) {
  if (!binary) return 0;
  std::uint64_t bytes = static_cast<std::uint64_t>(source.num_nodes()) * 28;
  for (const mesh::ElementBlock& block : source.blocks())
    bytes += static_cast<std::uint64_t>(block.count) * static_cast<std::uint64_t>(12 + 4 * mesh::nodes_of(block.kind));
  return bytes;
}

void write_22(const WriteJob& job) {
  Meter meter(job.progress, job.source.num_nodes() + num_elements(job.source));
  write_opening(job, "2.2");
  write_nodes(job, meter);
  write_elements(job, meter);
  write_periodic_22(job);
}

}  // namespace pcbmesh::formats::msh
