// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/elements/element_walk.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats {
namespace {

using mesh::ElementKind;

constexpr std::array<std::uint8_t, 18> same{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17};
constexpr std::array<std::uint8_t, 18> wedge_vtk{0, 1, 2, 3, 4, 5, 6, 9, 7, 12, 14, 13, 8, 10, 11, 15, 17, 16};
constexpr std::array<std::uint8_t, 18> wedge_exodus{0, 1, 2, 3, 4, 5, 6, 9, 7, 8, 10, 11, 12, 14, 13, 15, 17, 16};
constexpr std::array<std::uint8_t, 10> tetrahedron_vtk{0, 1, 2, 3, 4, 5, 6, 7, 9, 8};

}  // namespace

std::span<const std::uint8_t> node_order(ElementKind kind, NodeOrder order) {
  const auto width = static_cast<std::size_t>(mesh::nodes_of(kind));
  if (order == NodeOrder::gmsh || mesh::order_of(kind) == 1 || mesh::dimension_of(kind) == 2)
    return std::span(same).first(width);
  if (kind == ElementKind::tetrahedron10) return tetrahedron_vtk;
  return std::span(order == NodeOrder::vtk ? wedge_vtk : wedge_exodus).first(width);
}

void visit_nodes(const WriteJob& job, const NodeVisit& visit) {
  constexpr std::int64_t block = 1024;
  std::vector<std::array<double, 3>> nodes(block);
  const std::int64_t count = job.source.num_nodes();
  for (std::int64_t first = 0; first < count; first += block) {
    const auto part = std::span(nodes).first(static_cast<std::size_t>(std::min(block, count - first)));
    job.source.fill_nodes(first, part);
    if (job.scale != 1)
      for (std::array<double, 3>& node : part)
        for (double& x : node) x *= job.scale;
    visit(first, part);
    if (first % (64 * block) == 0) job.progress.at("write", 0.3 * static_cast<double>(first) / static_cast<double>(count));
  }
}

std::int64_t visit_elements(const WriteJob& job, std::size_t block, NodeOrder order, std::int64_t number,
                            const ElementVisit& visit) {
  const ElementKind kind = job.source.blocks()[block].kind;
  const auto width = static_cast<std::size_t>(mesh::nodes_of(kind));
  const std::span<const std::uint8_t> permutation = node_order(kind, order);
  std::array<std::int64_t, 18> row{};
  std::int64_t calls = 0;
  job.source.visit(block, [&](std::span<const std::int64_t> nodes) {
    if (++calls % 64 == 0) job.progress.check();
    for (; !nodes.empty(); nodes = nodes.subspan(width)) {
      for (std::size_t i = 0; i < width; ++i) row[i] = nodes[permutation[i]];
      visit(number++, std::span(row).first(width));
    }
  });
  return number;
}

void require_count(const WriteJob& job, std::string_view format, std::int64_t most) {
  const std::int64_t elements = job.source.num_elements(2) + job.source.num_elements(3), nodes = job.source.num_nodes();
  if (nodes <= most && elements <= most) return;
  throw Error(
      ErrorCode::format_limit,
      fmt::format("{} numbers nodes and elements up to {}, and this mesh has {} nodes and {} elements; write MSH 4.1 or "
                  "a coarser mesh",
                  format, most, nodes, elements),
      {.file = job.file.string()});
}

void put_real(FileSink& sink, double value, std::size_t width) {
  const auto finish = [](std::string text) {
    // "1" and "1e-05" would be taken for integers by column readers: a real has a point.
    const std::size_t exponent = text.find('e');
    const std::size_t end = exponent == std::string::npos ? text.size() : exponent;
    if (text.find('.') == std::string::npos && text.find_first_not_of("-0123456789e+") == std::string::npos)
      text.insert(end, ".");
    std::ranges::replace(text, 'e', 'E');
    return text;
  };
  std::array<char, 64> buffer;
  const auto text_of = [&](auto... format) {
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, format...).ptr;
    return finish(std::string(buffer.data(), end));
  };
  std::string best = text_of();
  if (best.size() > width) {
    double error = std::numeric_limits<double>::infinity();
    for (const std::chars_format format : {std::chars_format::scientific, std::chars_format::fixed})
      for (int digits = 17; digits > 0; --digits) {
        if (std::abs(value) >= 1e16 && format == std::chars_format::fixed) break;
        std::string text = text_of(format, digits);
        if (text.size() > width) continue;
        double read = 0;
        std::from_chars(text.data(), text.data() + text.size(), read);
        if (std::abs(read - value) < error) {
          error = std::abs(read - value);
          best = std::move(text);
        }
        break;  // fewer digits are never nearer
      }
  }
  sink.put(best);
}

void put_padded(FileSink& sink, std::int64_t value, std::size_t width) {
  std::array<char, 24> digits;
  const auto size =
      static_cast<std::size_t>(std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr - digits.data());
  char* to = sink.room(width);
  std::memset(to, ' ', width - size);
  std::memcpy(to + width - size, digits.data(), size);
  sink.advance(width);
}

std::string plain_word(std::string_view name, std::size_t most) {
  std::string out(name.substr(0, most));
  for (char& c : out)
    if (!((c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-')) c = '_';
  return out;
}

}  // namespace pcbmesh::formats
