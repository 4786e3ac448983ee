// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/mesh/mesh_data_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <tuple>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/mesh/group_names.hpp"

namespace pcbmesh::mesh {
namespace {

constexpr std::size_t num_kinds = static_cast<std::size_t>(ElementKind::wedge18) + 1;

std::optional<ElementKind> kind_with(int dimension, int corners, int nodes) {
  for (std::size_t i = 0; i < num_kinds; ++i) {
    const auto kind = static_cast<ElementKind>(i);
    if (dimension_of(kind) == dimension && corners_of(kind) == corners && nodes_of(kind) == nodes) return kind;
  }
  return std::nullopt;
}

constexpr int dimension_of_block(const CellBlock&) {
  return 3;
}
constexpr int dimension_of_block(const FaceBlock&) {
  return 2;
}

}  // namespace

std::optional<ElementKind> element_kind(const CellBlock& block) {
  return kind_with(3, corners_of(block.kind), corners_of(block.kind) + block.num_mid);
}

std::optional<ElementKind> element_kind(const FaceBlock& block) {
  return kind_with(2, corners_of(block.kind), corners_of(block.kind) + block.num_mid);
}

MeshDataSource::MeshDataSource(const MeshData& mesh, double unit_m) : mesh_(mesh) {
  unit_m_ = unit_m;
  num_nodes_ = static_cast<std::int64_t>(mesh.nodes.size());
  first_run_.push_back(0);
  gather(mesh.faces);
  add_groups(2);
  gather(mesh.cells);
  add_groups(3);
}

template <class Block>
void MeshDataSource::gather(const std::vector<Block>& blocks) {
  std::int32_t greatest = 0;
  for (const Block& block : blocks)
    for (const std::int32_t tag : block.tags) greatest = std::max(greatest, tag);
  for (const GroupName& name : mesh_.names)
    if (!blocks.empty() && name.dimension == dimension_of_block(blocks.front())) greatest = std::max(greatest, name.tag);
  const auto start = static_cast<std::ptrdiff_t>(runs_.size());
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const Block& block = blocks[b];
    const std::optional<ElementKind> kind = element_kind(block);
    if (!kind)
      throw Error(ErrorCode::file_syntax, "a block has elements with a number of nodes that no kind has",
                  {.file = mesh_.source});
    for (std::int64_t i = 0; i < block.size();) {
      const std::int32_t tag = block.tags[static_cast<std::size_t>(i)];
      std::int64_t end = i + 1;
      while (end < block.size() && block.tags[static_cast<std::size_t>(end)] == tag) ++end;
      if (tag <= 0) {
        if (greatest == std::numeric_limits<std::int32_t>::max())
          throw Error(ErrorCode::format_limit,
                      fmt::format("the greatest tag is {}, which leaves none for elements without a tag", greatest),
                      {.file = mesh_.source});
        num_untagged_cells_ += dimension_of_block(block) == 3 ? end - i : 0;
      }
      runs_.push_back({tag > 0 ? tag : greatest + 1, *kind, static_cast<std::int32_t>(b), i, end - i});
      i = end;
    }
  }
  std::stable_sort(runs_.begin() + start, runs_.end(),
                   [](const Run& a, const Run& b) { return std::tuple(a.tag, a.kind) < std::tuple(b.tag, b.kind); });
}

void MeshDataSource::add_groups(int dimension) {
  std::map<std::int32_t, std::string> names;
  for (const GroupName& name : mesh_.names)
    if (name.dimension == dimension && name.tag > 0) names.emplace(name.tag, name.name);
  std::size_t run = first_run_.back();
  const auto untagged_in_block = [&](const Run& r) {
    const auto& tags = dimension == 3 ? mesh_.cells[static_cast<std::size_t>(r.block)].tags
                                      : mesh_.faces[static_cast<std::size_t>(r.block)].tags;
    return tags[static_cast<std::size_t>(r.first)] <= 0;
  };
  for (std::size_t i = run; i < runs_.size(); ++i)
    names.emplace(runs_[i].tag, untagged_in_block(runs_[i])
                                    ? "untagged"
                                    : (dimension == 3 ? "volume " : "surface ") + std::to_string(runs_[i].tag));
  std::vector<std::string> spelt;
  for (const auto& [tag, name] : names) spelt.push_back(name);
  spelt = group_names(spelt);
  std::size_t next_name = 0;
  for (const auto& [tag, given] : names) {
    ElementGroup group{.dimension = dimension, .tag = tag, .name = spelt[next_name++]};
    const auto index = static_cast<std::int32_t>(groups_.size());
    while (run < runs_.size() && runs_[run].tag == tag) {
      const ElementKind kind = runs_[run].kind;
      std::int64_t count = 0;
      for (; run < runs_.size() && runs_[run].tag == tag && runs_[run].kind == kind; ++run) count += runs_[run].count;
      blocks_.push_back({kind, index, tag, count});
      first_run_.push_back(run);
      group.num_elements += count;
    }
    groups_.push_back(std::move(group));
  }
}

Extent MeshDataSource::extent_of(std::size_t group) {
  std::optional<Extent> extent;
  for (std::size_t block = 0; block < blocks_.size(); ++block) {
    if (static_cast<std::size_t>(blocks_[block].group) != group) continue;
    visit(block, [&](std::span<const std::int64_t> nodes) {
      for (const std::int64_t node : nodes) {
        const std::array<double, 3>& at = mesh_.nodes[static_cast<std::size_t>(node)];
        if (!extent) extent = {at, at};
        for (std::size_t i = 0; i < 3; ++i) {
          extent->min[i] = std::min(extent->min[i], at[i]);
          extent->max[i] = std::max(extent->max[i], at[i]);
        }
      }
    });
  }
  return extent.value_or(Extent{});
}

void MeshDataSource::fill_nodes(std::int64_t first, std::span<std::array<double, 3>> out) {
  PCBMESH_ASSERT(first >= 0 && static_cast<std::int64_t>(out.size()) <= num_nodes_ - first);
  std::copy_n(mesh_.nodes.begin() + first, out.size(), out.begin());
}

void MeshDataSource::visit(std::size_t block, const VisitNodes& visit) {
  const auto num_corners = static_cast<std::size_t>(corners_of(blocks_.at(block).kind));
  const std::size_t width = static_cast<std::size_t>(nodes_of(blocks_[block].kind)), num_mid = width - num_corners;
  const bool is_cell = dimension_of(blocks_[block].kind) == 3;
  std::vector<std::int64_t> rows(chunk * width);
  for (std::size_t r = first_run_[block]; r < first_run_[block + 1]; ++r) {
    const Run& run = runs_[r];
    const auto b = static_cast<std::size_t>(run.block);
    const std::span<const std::int64_t> corners = is_cell ? mesh_.cells[b].corners : mesh_.faces[b].corners,
                                        mids = is_cell ? mesh_.cells[b].mids : mesh_.faces[b].mids;
    for (std::int64_t done = 0; done < run.count;) {
      const auto first = static_cast<std::size_t>(run.first + done);
      const std::size_t count = std::min(chunk, static_cast<std::size_t>(run.count - done));
      done += static_cast<std::int64_t>(count);
      if (num_mid == 0) {
        visit(corners.subspan(first * width, count * width));
        continue;
      }
      for (std::size_t i = 0; i < count; ++i) {
        std::copy_n(corners.begin() + static_cast<std::ptrdiff_t>((first + i) * num_corners), num_corners, &rows[i * width]);
        std::copy_n(mids.begin() + static_cast<std::ptrdiff_t>((first + i) * num_mid), num_mid, &rows[i * width + num_corners]);
      }
      visit(std::span<const std::int64_t>(rows).first(count * width));
    }
  }
}

namespace {

CellKind cell_kind(ElementKind kind) {
  switch (corners_of(kind)) {
    case 4:
      return CellKind::tetrahedron;
    case 5:
      return CellKind::pyramid;
    case 6:
      return CellKind::wedge;
    default:
      return CellKind::hexahedron;
  }
}

template <class Block>
void append(Block& block, MeshSource& source, std::size_t index) {
  const ElementBlock& from = source.blocks()[index];
  const auto num_corners = static_cast<std::ptrdiff_t>(corners_of(from.kind)),
             width = static_cast<std::ptrdiff_t>(nodes_of(from.kind));
  block.num_mid = static_cast<std::int32_t>(width - num_corners);
  block.tags.insert(block.tags.end(), static_cast<std::size_t>(from.count), from.tag);
  source.visit(index, [&](std::span<const std::int64_t> rows) {
    for (auto row = rows.begin(); row != rows.end(); row += width) {
      block.corners.insert(block.corners.end(), row, row + num_corners);
      block.mids.insert(block.mids.end(), row + num_corners, row + width);
    }
  });
}

}  // namespace

MeshData expand(MeshSource& source) {
  MeshData out;
  out.source = "mesh in memory";
  out.num_other_elements = {0, 0};
  out.nodes.resize(static_cast<std::size_t>(source.num_nodes()));
  source.fill_nodes(0, out.nodes);
  std::map<ElementKind, FaceBlock> faces;
  std::map<ElementKind, CellBlock> cells;
  for (std::size_t i = 0; i < source.blocks().size(); ++i) {
    const ElementKind kind = source.blocks()[i].kind;
    if (dimension_of(kind) == 2) {
      faces[kind].kind = corners_of(kind) == 3 ? FaceKind::triangle : FaceKind::quadrangle;
      append(faces[kind], source, i);
    } else {
      cells[kind].kind = cell_kind(kind);
      append(cells[kind], source, i);
    }
  }
  for (auto& [kind, block] : faces) out.faces.push_back(std::move(block));
  for (auto& [kind, block] : cells) out.cells.push_back(std::move(block));
  for (const ElementGroup& group : source.groups()) out.names.push_back({group.dimension, group.tag, group.name});
  return out;
}

}  // namespace pcbmesh::mesh
