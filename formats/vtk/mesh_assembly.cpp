// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/vtk/mesh_assembly.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats::vtk {
namespace {

using mesh::CellKind;
using mesh::ElementKind;
using mesh::FaceKind;

/// Where elements of a kind belong: index into cells or faces; -1 = not read.
int place_of(ElementKind kind) {
  switch (kind) {
    case ElementKind::triangle:
      return static_cast<int>(FaceKind::triangle);
    case ElementKind::quadrangle:
      return static_cast<int>(FaceKind::quadrangle);
    case ElementKind::tetrahedron:
      return static_cast<int>(CellKind::tetrahedron);
    case ElementKind::pyramid:
      return static_cast<int>(CellKind::pyramid);
    case ElementKind::wedge:
      return static_cast<int>(CellKind::wedge);
    case ElementKind::hexahedron:
      return static_cast<int>(CellKind::hexahedron);
    default:
      return -1;
  }
}

using Point = std::array<double, 3>;

/// Six times the volume between the bottom triangle and the middle of the top one: its sign is the wedge's.
double orientation(const Point& a, const Point& b, const Point& c, const Point& d) {
  Point u, v, w;
  for (std::size_t i = 0; i < 3; ++i) {
    u[i] = b[i] - a[i];
    v[i] = c[i] - a[i];
    w[i] = d[i] - a[i];
  }
  return (u[1] * v[2] - u[2] * v[1]) * w[0] + (u[2] * v[0] - u[0] * v[2]) * w[1] + (u[0] * v[1] - u[1] * v[0]) * w[2];
}

}  // namespace

MeshAssembly::MeshAssembly(std::filesystem::path file) : file_(std::move(file)) {
  mesh_.source = file_.string();
  mesh_.num_other_elements.assign(2, 0);
  for (std::size_t i = 0; i < cells_.size(); ++i) cells_[i].kind = static_cast<CellKind>(i);
  for (std::size_t i = 0; i < faces_.size(); ++i) faces_[i].kind = static_cast<FaceKind>(i);
}

void MeshAssembly::add_nodes(std::span<const double> values) {
  mesh_.nodes.reserve(mesh_.nodes.size() + values.size() / 3);
  for (std::size_t i = 0; i + 2 < values.size(); i += 3) mesh_.nodes.push_back({values[i], values[i + 1], values[i + 2]});
}

void MeshAssembly::reserve(ElementKind kind, std::int64_t count) {
  const int place = place_of(kind);
  if (place < 0) return;
  const auto grow = [&](auto& block) {
    const auto size = block.tags.size() + static_cast<std::size_t>(count);
    block.tags.reserve(size);
    block.corners.reserve(size * static_cast<std::size_t>(mesh::nodes_of(kind)));
  };
  mesh::dimension_of(kind) == 3 ? grow(cells_[static_cast<std::size_t>(place)]) : grow(faces_[static_cast<std::size_t>(place)]);
}

void MeshAssembly::add_element(ElementKind kind, std::span<const std::int64_t> nodes, std::span<const std::uint8_t> order,
                               std::int32_t tag, std::int64_t first_node) {
  const int place = place_of(kind);
  if (place < 0)
    throw Error(ErrorCode::file_syntax,
                fmt::format("holds elements of the kind {}; this reader takes the first order alone", mesh::name_of(kind)),
                {.file = file_.string()}, {num_elements_});
  const bool is_cell = mesh::dimension_of(kind) == 3;
  const auto index = static_cast<std::size_t>(place);
  std::vector<std::int64_t>& corners = is_cell ? cells_[index].corners : faces_[index].corners;
  const std::size_t start = corners.size();
  corners.resize(start + nodes.size());
  const std::int64_t most = num_nodes() - first_node;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i] < 0 || nodes[i] >= most) {
      corners.resize(start);
      throw Error(
          ErrorCode::file_syntax,
          fmt::format("element {} (counted from 0) refers to node {}, but there are {} nodes", num_elements_, nodes[i], most),
          {.file = file_.string()}, {num_elements_});
    }
    corners[start + order[i]] = first_node + nodes[i];
  }
  (is_cell ? cells_[index].tags : faces_[index].tags).push_back(tag);
  ++num_elements_;
}

void MeshAssembly::set_tag_of_cell(ElementKind kind, std::span<const std::int64_t> nodes, std::int32_t tag,
                                   std::int64_t first_node) {
  using Key = std::array<std::int64_t, 8>;
  const auto key_of = [](std::span<const std::int64_t> corners, std::int64_t first) {
    Key key;
    key.fill(-1);
    for (std::size_t i = 0; i < std::min(corners.size(), key.size()); ++i) key[i] = corners[i] + first;
    std::sort(key.begin(), key.end());
    return key;
  };
  const int place = place_of(kind);
  std::int64_t num_cells = 0;
  for (const mesh::CellBlock& block : cells_) num_cells += block.size();
  if (num_cells != num_cells_known_) {
    cell_of_corners_.clear();
    for (const mesh::CellBlock& block : cells_) {
      const auto n = static_cast<std::size_t>(mesh::corners_of(block.kind));
      for (std::size_t i = 0; i < block.tags.size(); ++i)
        cell_of_corners_.emplace(key_of(std::span(block.corners).subspan(i * n, n), 0), i);
    }
    num_cells_known_ = num_cells;
  }
  const auto found = place < 0 ? cell_of_corners_.end() : cell_of_corners_.find(key_of(nodes, first_node));
  if (found == cell_of_corners_.end())
    throw Error(ErrorCode::file_syntax,
                fmt::format("a grid of tags gives {} to a cell that is not in the mesh, with node {}", tag,
                            nodes.empty() ? -1 : nodes.front()),
                {.file = file_.string()});
  cells_[static_cast<std::size_t>(place)].tags[found->second] = tag;
}

void MeshAssembly::turn_wedges_if_inside_out() {
  std::vector<std::int64_t>& corners = cells_[static_cast<std::size_t>(CellKind::wedge)].corners;
  std::int64_t balance = 0;
  for (std::size_t i = 0; i < corners.size(); i += 6) {
    const auto at = [&](std::size_t k) -> const Point& { return mesh_.nodes[static_cast<std::size_t>(corners[i + k])]; };
    Point middle{};
    for (std::size_t axis = 0; axis < 3; ++axis) middle[axis] = (at(3)[axis] + at(4)[axis] + at(5)[axis]) / 3;
    const double sign = orientation(at(0), at(1), at(2), middle);
    balance += sign > 0 ? 1 : sign < 0 ? -1 : 0;
  }
  if (balance >= 0) return;
  for (std::size_t i = 0; i < corners.size(); i += 6) {
    std::swap(corners[i + 1], corners[i + 2]);
    std::swap(corners[i + 4], corners[i + 5]);
  }
}

mesh::MeshData MeshAssembly::take() {
  for (mesh::CellBlock& block : cells_)
    if (block.size() > 0) mesh_.cells.push_back(std::move(block));
  for (mesh::FaceBlock& block : faces_)
    if (block.size() > 0) mesh_.faces.push_back(std::move(block));
  return std::move(mesh_);
}

}  // namespace pcbmesh::formats::vtk
