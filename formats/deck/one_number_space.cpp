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
  announce_as(source);
  for (mesh::ElementGroup& group : groups_)
    if (group.dimension == 2) group.tag += shift;
  for (mesh::ElementBlock& block : blocks_)
    if (mesh::dimension_of(block.kind) == 2) block.tag += shift;
}

}  // namespace pcbmesh::formats::deck
