// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/mesh_builder/element_blocks.hpp"

#include <algorithm>
#include <utility>

namespace pcbmesh::formats {
namespace {

using mesh::ElementKind;

bool is_face(ElementKind kind) {
  return mesh::dimension_of(kind) == 2;
}

}  // namespace

ElementBlocks::ElementBlocks() {
  constexpr mesh::CellKind by_corners[] = {mesh::CellKind::tetrahedron, mesh::CellKind::pyramid, mesh::CellKind::wedge,
                                           mesh::CellKind::hexahedron, mesh::CellKind::hexahedron};
  for (std::size_t i = 0; i < num_kinds; ++i) {
    const auto kind = static_cast<ElementKind>(i);
    const int corners = mesh::corners_of(kind), num_mid = mesh::nodes_of(kind) - corners;
    cells_[i].num_mid = faces_[i].num_mid = num_mid;
    if (is_face(kind))
      faces_[i].kind = corners == 3 ? mesh::FaceKind::triangle : mesh::FaceKind::quadrangle;
    else
      cells_[i].kind = by_corners[corners - 4];
  }
}

void ElementBlocks::reserve(ElementKind kind, std::int64_t count) {
  const auto more = [](auto& items, std::size_t extra) {
    // Many small blocks must not make each of them a copy of all before.
    if (items.size() + extra > items.capacity()) items.reserve(std::max(items.size() + extra, items.capacity() * 2));
  };
  const auto in = [&](auto& block) {
    const auto wanted = static_cast<std::size_t>(count);
    more(block.tags, wanted);
    more(block.corners, wanted * static_cast<std::size_t>(mesh::corners_of(kind)));
    more(block.mids, wanted * static_cast<std::size_t>(block.num_mid));
  };
  is_face(kind) ? in(faces_[static_cast<std::size_t>(kind)]) : in(cells_[static_cast<std::size_t>(kind)]);
}

void ElementBlocks::add(ElementKind kind, std::int32_t tag, std::span<const std::int64_t> nodes) {
  const auto corners = nodes.first(static_cast<std::size_t>(mesh::corners_of(kind))), mids = nodes.subspan(corners.size());
  const auto into = [&](auto& block) {
    block.tags.push_back(tag);
    block.corners.insert(block.corners.end(), corners.begin(), corners.end());
    block.mids.insert(block.mids.end(), mids.begin(), mids.end());
  };
  is_face(kind) ? into(faces_[static_cast<std::size_t>(kind)]) : into(cells_[static_cast<std::size_t>(kind)]);
}

void ElementBlocks::move_to(mesh::MeshData& mesh) {
  for (mesh::CellBlock& block : cells_)
    if (!block.tags.empty()) mesh.cells.push_back(std::move(block));
  for (mesh::FaceBlock& block : faces_)
    if (!block.tags.empty()) mesh.faces.push_back(std::move(block));
}

}  // namespace pcbmesh::formats
