// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/mesh/mesh_source.hpp"

#include "pcbmesh/base/error.hpp"

namespace pcbmesh::mesh {

std::string_view name_of(ElementKind kind) {
  constexpr std::string_view names[] = {"triangle",  "quadrangle",  "tetrahedron", "pyramid",       "wedge",   "hexahedron",
                                        "triangle6", "quadrangle8", "quadrangle9", "tetrahedron10", "wedge15", "wedge18"};
  return names[static_cast<std::size_t>(kind)];
}

std::string_view name_of(CellField field) {
  constexpr std::string_view names[] = {"region", "sublayer", "quality"};
  return names[static_cast<std::size_t>(field)];
}

std::int64_t MeshSource::num_elements(int dimension) const {
  std::int64_t sum = 0;
  for (const ElementBlock& block : blocks_)
    if (dimension_of(block.kind) == dimension) sum += block.count;
  return sum;
}

void MeshSource::announce_as(const MeshSource& source) {
  groups_ = source.groups_;
  blocks_ = source.blocks_;
  layers_ = source.layers_;
  nets_ = source.nets_;
  materials_ = source.materials_;
  num_nodes_ = source.num_nodes_;
  unit_m_ = source.unit_m_;
}

void MeshSource::visit_field(std::size_t, CellField, const VisitValues&) {
  report_bug("the source has the field", __FILE__, __LINE__);
}

}  // namespace pcbmesh::mesh
