// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/vtk/mesh_assembly.hpp"

#include <fmt/format.h>

#include <utility>

#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats::vtk {
namespace {

using mesh::ElementKind;
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
}

void MeshAssembly::add_nodes(std::span<const double> values) {
  mesh_.nodes.reserve(mesh_.nodes.size() + values.size() / 3);
  for (std::size_t i = 0; i + 2 < values.size(); i += 3) mesh_.nodes.push_back({values[i], values[i + 1], values[i + 2]});
}

void MeshAssembly::add_element(ElementKind kind, std::span<const std::int64_t> nodes, std::span<const std::uint8_t> order,
                               std::int32_t tag, std::int64_t first_node) {
  std::array<std::int64_t, 18> indices{};
  const std::int64_t most = num_nodes() - first_node;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i] < 0 || nodes[i] >= most)
      throw Error(
          ErrorCode::file_syntax,
          fmt::format("element {} (counted from 0) refers to node {}, but there are {} nodes", num_elements_, nodes[i], most),
          {.file = file_.string()}, {num_elements_});
    indices[order[i]] = first_node + nodes[i];
  }
  blocks_.add(kind, tag, std::span(indices).first(nodes.size()));
  ++num_elements_;
}

void MeshAssembly::turn_wedges_if_inside_out() {
  const std::span<std::int64_t> corners = blocks_.cell_corners(ElementKind::wedge);
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
  blocks_.move_to(mesh_);
  return std::move(mesh_);
}

}  // namespace pcbmesh::formats::vtk
