// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/vtk/piece.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <utility>

#include "formats/vtk/cells.hpp"
#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats::vtk {
namespace {

constexpr std::int64_t nodes_at_once = 1024;

template <class Value>
void store(char* to, Value value) {
  std::memcpy(to, &value, sizeof value);
}

/// Rows of fixed width: the compiler unrolls them.
template <class Integer, std::size_t width, class NumberOf>
void put_rows(std::span<const std::int64_t> nodes, std::span<const std::uint8_t> order, ArraySink& out, NumberOf number_of) {
  char* to = out.room(nodes.size() * sizeof(Integer));
  const std::int64_t* from = nodes.data();
  std::array<std::uint8_t, width> at{};
  std::copy_n(order.begin(), width, at.begin());
  for (std::size_t rows = nodes.size() / width; rows > 0; --rows, from += width, to += width * sizeof(Integer))
    for (std::size_t i = 0; i < width; ++i) store(to + i * sizeof(Integer), static_cast<Integer>(number_of(from[at[i]])));
  out.advance(nodes.size() * sizeof(Integer));
}

template <class Integer, class NumberOf>
void put_rows(std::span<const std::int64_t> nodes, std::span<const std::uint8_t> order, ArraySink& out, NumberOf number_of) {
  switch (order.size()) {
    case 3:
      return put_rows<Integer, 3>(nodes, order, out, number_of);
    case 4:
      return put_rows<Integer, 4>(nodes, order, out, number_of);
    case 6:
      return put_rows<Integer, 6>(nodes, order, out, number_of);
    default:
      for (std::size_t row = 0; row < nodes.size(); row += order.size())
        for (const std::uint8_t i : order) out.put(static_cast<Integer>(number_of(nodes[row + i])));
  }
}

/// `count` times the same value.
template <class Value>
void put_constant(Value value, std::int64_t count, ArraySink& out, Meter& meter) {
  constexpr std::int64_t piece = static_cast<std::int64_t>(ArraySink::max_piece / sizeof value);
  while (count > 0) {
    const std::int64_t part = std::min(count, piece);
    char* to = out.room(static_cast<std::size_t>(part) * sizeof value);
    for (std::int64_t i = 0; i < part; ++i) store(to + static_cast<std::size_t>(i) * sizeof value, value);
    out.advance(static_cast<std::size_t>(part) * sizeof value);
    meter.add(part);
    count -= part;
  }
}

}  // namespace

std::vector<Run> runs_of(const mesh::MeshSource& source, const std::function<bool(const mesh::ElementBlock&)>& wanted) {
  std::vector<Run> runs;
  for (std::size_t i = 0; i < source.blocks().size(); ++i)
    if (wanted(source.blocks()[i])) runs.push_back({i, 0, source.blocks()[i].count});
  return runs;
}

std::vector<Run> part_of(std::span<const Run> runs, std::int64_t first, std::int64_t count) {
  std::vector<Run> out;
  for (const Run& run : runs) {
    const std::int64_t begin = std::max<std::int64_t>(first, 0), end = std::min(first + count, run.count);
    if (begin < end) out.push_back({run.block, run.first + begin, end - begin});
    first -= run.count;
  }
  return out;
}

std::string_view name_of(CellArray array) {
  constexpr std::string_view names[] = {"volume_tag", "face_tag", "layer", "material", "net", "region", "quality"};
  return names[static_cast<std::size_t>(array)];
}

Piece::Piece(mesh::MeshSource& source, std::vector<Run> runs, bool all_nodes, const Progress& progress)
    : source_(source), runs_(std::move(runs)), num_nodes_(source.num_nodes()) {
  for (const Run& run : runs_) {
    num_elements_ += run.count;
    num_corners_ += run.count * mesh::nodes_of(source.blocks()[run.block].kind);
  }
  cell_arrays_ = telling_arrays();
  if (!all_nodes) mark_nodes(progress);
}

Piece::Piece(mesh::MeshSource& source, std::vector<Run> runs, std::vector<CellArray> arrays, const Progress& progress)
    : Piece(source, std::move(runs), false, progress) {
  cell_arrays_ = std::move(arrays);
}

void Piece::visit(const Run& run, const VisitRows& visit_rows) const {
  const std::int64_t width = mesh::nodes_of(source_.blocks()[run.block].kind);
  std::int64_t at = -run.first;  // of the next element, counted from the run's first
  source_.visit(run.block, [&](std::span<const std::int64_t> nodes) {
    const std::int64_t count = static_cast<std::int64_t>(nodes.size()) / width;
    const std::int64_t begin = std::max<std::int64_t>(0, -at), end = std::min(count, run.count - at);
    if (begin < end)
      visit_rows(nodes.subspan(static_cast<std::size_t>(begin * width), static_cast<std::size_t>((end - begin) * width)));
    at += count;
  });
}

void Piece::mark_nodes(const Progress& progress) {
  words_.assign(static_cast<std::size_t>((source_.num_nodes() + 63) / 64), 0);
  for (const Run& run : runs_)
    visit(run, [&](std::span<const std::int64_t> nodes) {
      for (const std::int64_t node : nodes) words_[static_cast<std::size_t>(node) / 64] |= std::uint64_t{1} << (node % 64);
      progress.check();
    });
  ranks_.reserve(words_.size());
  num_nodes_ = 0;
  for (const std::uint64_t word : words_) {
    ranks_.push_back(num_nodes_);
    num_nodes_ += std::popcount(word);
  }
}

bool Piece::has(std::int64_t node) const {
  return words_.empty() || ((words_[static_cast<std::size_t>(node) / 64] >> (node % 64)) & 1U) != 0;
}

std::int64_t Piece::number_of(std::int64_t node) const {
  const std::uint64_t before = (std::uint64_t{1} << (node % 64)) - 1;
  const auto word = static_cast<std::size_t>(node) / 64;
  return ranks_[word] + std::popcount(words_[word] & before);
}

std::vector<CellArray> Piece::telling_arrays() const {
  const auto has_dimension = [&](int dimension) {
    return std::ranges::any_of(
        runs_, [&](const Run& run) { return mesh::dimension_of(source_.blocks()[run.block].kind) == dimension; });
  };
  std::vector<CellArray> out;
  const bool has_cells = has_dimension(3), has_faces = has_dimension(2);
  if (has_cells) out.push_back(CellArray::volume_tag);
  if (has_faces) out.push_back(CellArray::face_tag);
  if (has_cells && !source_.layers().empty()) out.push_back(CellArray::layer);
  if (has_cells && !source_.materials().empty()) out.push_back(CellArray::material);
  if (!source_.layers().empty() || !source_.nets().empty()) out.push_back(CellArray::net);
  if (has_cells && source_.has_field(mesh::CellField::region)) out.push_back(CellArray::region);
  if (has_cells && source_.has_field(mesh::CellField::quality)) out.push_back(CellArray::quality);
  return out;
}

bool Piece::fits_32_bits() const {
  return std::max(num_nodes_, num_corners_) <= std::numeric_limits<std::int32_t>::max();
}

void Piece::put_points(double scale, ArraySink& out, Meter& meter) const {
  std::vector<std::array<double, 3>> nodes(nodes_at_once);
  for (std::int64_t first = 0; first < source_.num_nodes(); first += nodes_at_once) {
    const auto part = std::span(nodes).first(static_cast<std::size_t>(std::min(nodes_at_once, source_.num_nodes() - first)));
    source_.fill_nodes(first, part);
    std::size_t count = part.size();
    if (!words_.empty()) {
      count = 0;
      for (std::size_t i = 0; i < part.size(); ++i)
        if (has(first + static_cast<std::int64_t>(i))) part[count++] = part[i];
    }
    if (scale != 1)
      for (auto& node : part.first(count))
        for (double& x : node) x *= scale;
    std::memcpy(out.room(count * sizeof part[0]), part.data(), count * sizeof part[0]);
    out.advance(count * sizeof part[0]);
    meter.add(static_cast<std::int64_t>(count));
  }
}

template <class Integer>
void Piece::put_corners_of(const Run& run, VtkWedge wedge, ArraySink& out, ArraySink* parametric, Meter& meter) const {
  const mesh::ElementKind kind = source_.blocks()[run.block].kind;
  const auto order = node_order(kind, wedge), parametric_order = node_order(kind, VtkWedge::parametric);
  visit(run, [&](std::span<const std::int64_t> nodes) {
    const auto put = [&](auto number_of) {
      put_rows<Integer>(nodes, order, out, number_of);
      if (parametric != nullptr) put_rows<Integer>(nodes, parametric_order, *parametric, number_of);
    };
    if (words_.empty())
      put([](std::int64_t node) { return node; });
    else
      put([this](std::int64_t node) { return number_of(node); });
    meter.add(static_cast<std::int64_t>(nodes.size() / order.size()));
  });
}

void Piece::put_corners(VtkWedge wedge, std::size_t bytes, ArraySink& out, Meter& meter) const {
  for (const Run& run : runs_) {
    if (bytes == sizeof(std::int32_t))
      put_corners_of<std::int32_t>(run, wedge, out, nullptr, meter);
    else
      put_corners_of<std::int64_t>(run, wedge, out, nullptr, meter);
  }
}

void Piece::put_corners_twice(VtkWedge wedge, std::size_t bytes, ArraySink& out, ArraySink& parametric, Meter& meter) const {
  for (const Run& run : runs_) {
    if (bytes == sizeof(std::int32_t))
      put_corners_of<std::int32_t>(run, wedge, out, &parametric, meter);
    else
      put_corners_of<std::int64_t>(run, wedge, out, &parametric, meter);
  }
}

template <class Integer>
void Piece::put_ends_of(bool from_zero, ArraySink& out, Meter& meter) const {
  constexpr std::int64_t piece = static_cast<std::int64_t>(ArraySink::max_piece / sizeof(Integer));
  Integer end = 0;
  if (from_zero) out.put(end);
  for (const Run& run : runs_) {
    const auto width = static_cast<Integer>(mesh::nodes_of(source_.blocks()[run.block].kind));
    for (std::int64_t left = run.count; left > 0;) {
      const std::int64_t part = std::min(left, piece);
      char* to = out.room(static_cast<std::size_t>(part) * sizeof end);
      for (std::int64_t i = 0; i < part; ++i, to += sizeof end) store(to, end += width);
      out.advance(static_cast<std::size_t>(part) * sizeof end);
      meter.add(part);
      left -= part;
    }
  }
}

void Piece::put_ends(bool from_zero, std::size_t bytes, ArraySink& out, Meter& meter) const {
  if (bytes == sizeof(std::int32_t))
    put_ends_of<std::int32_t>(from_zero, out, meter);
  else
    put_ends_of<std::int64_t>(from_zero, out, meter);
}

void Piece::put_types(ArraySink& out, Meter& meter) const {
  for (const Run& run : runs_) put_constant(cell_type(source_.blocks()[run.block].kind), run.count, out, meter);
}

std::int32_t Piece::value_of(const Run& run, CellArray array) const {
  const mesh::ElementBlock& block = source_.blocks()[run.block];
  const mesh::ElementGroup& group = source_.groups()[static_cast<std::size_t>(block.group)];
  switch (array) {
    case CellArray::volume_tag:
      return group.dimension == 3 ? group.tag : 0;
    case CellArray::face_tag:
      return group.dimension == 2 ? group.tag : 0;
    case CellArray::layer:
      return group.layer;
    case CellArray::material:
      return group.material;
    case CellArray::net:
      return group.net;
    default:
      return -1;  // faces have neither region nor quality
  }
}

void Piece::put_cell_array(CellArray array, ArraySink& out, Meter& meter) const {
  for (const Run& run : runs_) {
    const bool is_field = array == CellArray::region || array == CellArray::quality;
    if (!is_field || mesh::dimension_of(source_.blocks()[run.block].kind) != 3) {
      if (array == CellArray::quality)
        put_constant(-1.0F, run.count, out, meter);
      else
        put_constant(value_of(run, array), run.count, out, meter);
      continue;
    }
    const auto field = array == CellArray::region ? mesh::CellField::region : mesh::CellField::quality;
    std::int64_t at = -run.first;
    source_.visit_field(run.block, field, [&](std::span<const double> values) {
      const std::int64_t count = static_cast<std::int64_t>(values.size());
      const std::int64_t begin = std::max<std::int64_t>(0, -at), end = std::min(count, run.count - at);
      at += count;
      if (begin >= end) return;
      const auto wanted = values.subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(end - begin));
      char* to = out.room(wanted.size() * sizeof(std::int32_t));
      const auto put_as = [&]<class Value>(Value) {
        for (std::size_t i = 0; i < wanted.size(); ++i) store(to + i * sizeof(Value), static_cast<Value>(wanted[i]));
      };
      array == CellArray::quality ? put_as(float{}) : put_as(std::int32_t{});
      out.advance(wanted.size() * sizeof(std::int32_t));
      meter.add(end - begin);
    });
  }
}

std::size_t index_bytes(const Piece& piece, const WriteMeshOptions& options, const std::filesystem::path& file) {
  if (options.index_bits == 32 && !piece.fits_32_bits())
    throw Error(ErrorCode::format_limit,
                fmt::format("{} nodes and {} corners of cells do not fit 32 bits; take 64 or leave the choice to the program",
                            piece.num_nodes(), piece.num_corners()),
                {.file = file.string()});
  return options.index_bits == 64 || !piece.fits_32_bits() ? sizeof(std::int64_t) : sizeof(std::int32_t);
}

}  // namespace pcbmesh::formats::vtk
