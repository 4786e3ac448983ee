// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <limits>

#include "formats/msh/write_msh.hpp"
#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats::msh {
namespace {

constexpr std::int64_t most = std::numeric_limits<std::int32_t>::max();

void require_32_bit(const WriteJob& job, std::int64_t count, std::string_view what) {
  if (count <= most) return;
  throw Error(
      ErrorCode::format_limit,
      fmt::format("MSH 2.2 numbers {} with 32 bits, at most {}, and this mesh has {}; write version 4.1 or a coarser mesh",
                  what, most, count),
      {.file = job.sink.target().string()});
}

void write_nodes(const WriteJob& job, Meter& meter) {
  FileSink& sink = job.sink;
  sink.put("$Nodes\n");
  sink.put_number(job.elements.mesh().num_nodes());
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

void write_rows_binary(FileSink& sink, const ElementBlock& block, std::int64_t id, std::span<const std::int64_t> corners) {
  const auto width = static_cast<std::size_t>(num_corners(block.kind));
  const std::size_t num_rows = corners.size() / width, row_bytes = (3 + width) * sizeof id;
  char* to = sink.room(num_rows * row_bytes);
  std::array<std::int32_t, 9> fields{0, block.tag, block.tag};
  for (std::size_t row = 0; row < num_rows; ++row) {
    fields[0] = static_cast<std::int32_t>(id++);
    for (std::size_t i = 0; i < width; ++i) fields[3 + i] = static_cast<std::int32_t>(corners[row * width + i] + 1);
    std::memcpy(to, fields.data(), row_bytes);
    to += row_bytes;
  }
  sink.advance(num_rows * row_bytes);
}

void write_rows_text(FileSink& sink, const ElementBlock& block, std::int64_t id, std::span<const std::int64_t> corners) {
  const auto width = static_cast<std::size_t>(num_corners(block.kind));
  const std::string middle = fmt::format(" {} 2 {} {}", static_cast<std::int32_t>(block.kind), block.tag, block.tag);
  for (std::size_t at = 0; at < corners.size(); at += width) {
    sink.put_number(id++);
    sink.put(middle);
    for (std::size_t i = 0; i < width; ++i) {
      sink.put(" ");
      sink.put_number(corners[at + i] + 1);
    }
    sink.put("\n");
  }
}

void write_elements(const WriteJob& job, Meter& meter) {
  FileSink& sink = job.sink;
  sink.put("$Elements\n");
  sink.put_number(job.elements.num_elements());
  sink.put("\n");
  std::int64_t id = 1;
  for (const ElementBlock& block : job.elements.blocks()) {
    if (job.binary)  // one header for the whole block: 12 bytes per element less than a header each
      for (const std::int32_t field : {static_cast<std::int32_t>(block.kind), static_cast<std::int32_t>(block.count), 2})
        sink.put_raw(field);
    job.elements.visit(block, [&](std::span<const std::int64_t> corners) {
      (job.binary ? write_rows_binary : write_rows_text)(sink, block, id, corners);
      const std::int64_t count = static_cast<std::int64_t>(corners.size()) / num_corners(block.kind);
      id += count;
      meter.add(count);
    });
  }
  sink.put(job.binary ? "\n$EndElements\n" : "$EndElements\n");
}

}  // namespace

std::uint64_t expected_bytes_22(const ElementStream& elements, bool binary) {
  if (!binary) return 0;
  std::uint64_t bytes = static_cast<std::uint64_t>(elements.mesh().num_nodes()) * 28;
  for (const ElementBlock& block : elements.blocks())
    bytes += static_cast<std::uint64_t>(block.count) * static_cast<std::uint64_t>(12 + 4 * num_corners(block.kind));
  return bytes;
}

void write_22(const WriteJob& job) {
  require_32_bit(job, job.elements.mesh().num_nodes(), "nodes");
  require_32_bit(job, job.elements.num_elements(), "elements");
  Meter meter(job.progress, job.elements.mesh().num_nodes() + job.elements.num_elements());
  write_opening(job, "2.2");
  write_nodes(job, meter);
  write_elements(job, meter);
}

}  // namespace pcbmesh::formats::msh
