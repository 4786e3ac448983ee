// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/deck/one_number_space.hpp"

#include <algorithm>

namespace pcbmesh::formats::deck {

std::int32_t first_face_tag(const mesh::MeshSource& source) {
  std::int32_t highest = 0;
  for (const mesh::ElementGroup& group : source.groups())
    if (group.dimension == 3) highest = std::max(highest, group.tag);
  return highest;
}

OneNumberSpace::OneNumberSpace(mesh::MeshSource& source) : source_(source) {
  const std::int32_t shift = first_face_tag(source);
  num_nodes_ = source.num_nodes();
  unit_m_ = source.unit_m();
  groups_.assign(source.groups().begin(), source.groups().end());
  blocks_.assign(source.blocks().begin(), source.blocks().end());
  layers_.assign(source.layers().begin(), source.layers().end());
  nets_.assign(source.nets().begin(), source.nets().end());
  materials_.assign(source.materials().begin(), source.materials().end());
  for (mesh::ElementGroup& group : groups_)
    if (group.dimension == 2) group.tag += shift;
  for (mesh::ElementBlock& block : blocks_)
    if (mesh::dimension_of(block.kind) == 2) block.tag += shift;
}

}  // namespace pcbmesh::formats::deck
