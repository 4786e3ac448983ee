// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "pcbmesh/mesh/planar_mesh.hpp"
#include "pcbmesh/model/model.hpp"

namespace pcbmesh::extrude {

/// What fills every region in every slab; a region without triangles is void.
class Columns {
 public:
  /// @cost O(region bodies x slabs).
  Columns(const mesh::PlanarMesh& planar, const model::Model& model);
  [[nodiscard]] const model::Label& at(std::int32_t region, std::int32_t slab) const {
    return labels_[static_cast<std::size_t>(region) * num_slabs_ + static_cast<std::size_t>(slab)];
  }
  [[nodiscard]] std::int32_t num_slabs() const { return static_cast<std::int32_t>(num_slabs_); }
  /// Body of the sheet at a face, or -1.
  [[nodiscard]] std::int32_t sheet_at(std::int32_t region, std::int32_t face) const {
    return sheets_.empty() ? -1 : sheets_[static_cast<std::size_t>(region) * (num_slabs_ + 1) + static_cast<std::size_t>(face)];
  }

 private:
  std::size_t num_slabs_ = 0;
  std::vector<model::Label> labels_;
  std::vector<std::int32_t> sheets_;  ///< empty if the model has none
};

}  // namespace pcbmesh::extrude
