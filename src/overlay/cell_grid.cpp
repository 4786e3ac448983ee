// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/overlay/cell_grid.hpp"

namespace pcbmesh::overlay {

CellGrid::CellGrid(const geometry::Box& box, std::size_t count, Nm least_cell) {
  if (box.is_empty()) return;
  x0_ = static_cast<double>(box.min.x);
  y0_ = static_cast<double>(box.min.y);
  const double width = static_cast<double>(box.max.x - box.min.x) + 1, height = static_cast<double>(box.max.y - box.min.y) + 1;
  const double wanted = static_cast<double>(std::max<std::size_t>(count, 1));
  side_ = std::max({std::sqrt(width * height / wanted), static_cast<double>(least_cell), width / 30000, height / 30000, 1.0});
  per_side_ = 1 / side_;
  columns_ = static_cast<std::int32_t>(width / side_) + 1;
  rows_ = static_cast<std::int32_t>(height / side_) + 1;
}

void CellLists::finish() {
  offsets_.assign(ix(num_cells_) + 1, 0);
  for (const Pair& pair : pairs_) ++offsets_[ix(pair.cell) + 1];
  for (std::size_t i = 1; i < offsets_.size(); ++i) offsets_[i] += offsets_[i - 1];
  items_.resize(pairs_.size());
  for (const Pair& pair : pairs_) items_[ix(offsets_[ix(pair.cell)]++)] = pair.item;
  for (std::size_t i = offsets_.size() - 1; i > 0; --i) offsets_[i] = offsets_[i - 1];
  offsets_[0] = 0;
}

geometry::Box box_of(const std::vector<Point>& points, const std::vector<Edge>& edges) {
  geometry::Box box;
  for (const Edge& e : edges) {
    box.add(points[ix(e.u)]);
    box.add(points[ix(e.v)]);
  }
  return box;
}

}  // namespace pcbmesh::overlay
