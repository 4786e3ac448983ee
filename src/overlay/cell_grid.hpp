// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "pcbmesh/geometry/point.hpp"
#include "src/overlay/edge_graph.hpp"

namespace pcbmesh::overlay {

/// Uniform square cells over a box. Everything outside the box counts to the border cells.
class CellGrid {
 public:
  /// @param count  expected items: about one cell each. @param least_cell  smallest cell side.
  CellGrid(const geometry::Box& box, std::size_t count, Nm least_cell);

  [[nodiscard]] std::int32_t num_cells() const { return columns_ * rows_; }
  [[nodiscard]] std::int32_t columns() const { return columns_; }
  [[nodiscard]] std::int32_t rows() const { return rows_; }
  [[nodiscard]] std::int32_t column_of(double x) const { return clamped((x - x0_) * per_side_, columns_); }
  [[nodiscard]] std::int32_t row_of(double y) const { return clamped((y - y0_) * per_side_, rows_); }
  [[nodiscard]] std::int32_t cell_of(Point p) const {
    return row_of(static_cast<double>(p.y)) * columns_ + column_of(static_cast<double>(p.x));
  }
  [[nodiscard]] double row_bottom(std::int32_t row) const { return y0_ + side_ * row; }
  [[nodiscard]] double side() const { return side_; }

  /// Calls visit(first_cell, last_cell) for each row of cells within `pad` of segment a-b.
  template <class Visit>
  void along_segment(Point a, Point b, double pad, Visit&& visit) const {
    if (b.y < a.y) std::swap(a, b);
    const double ax = static_cast<double>(a.x), ay = static_cast<double>(a.y);
    const double bx = static_cast<double>(b.x), by = static_cast<double>(b.y);
    const double reach = pad + 1;
    const std::int32_t first_row = row_of(ay - reach), last_row = row_of(by + reach);
    const double slope = by > ay ? (bx - ax) / (by - ay) : 0;
    for (std::int32_t row = first_row; row <= last_row; ++row) {
      double x_low = ax, x_high = bx;
      if (first_row != last_row && by > ay) {
        const double bottom = std::clamp(row_bottom(row) - reach, ay, by),
                     top = std::clamp(row_bottom(row + 1) + reach, ay, by);
        x_low = row == 0 ? ax : ax + (bottom - ay) * slope;
        x_high = row == rows_ - 1 ? bx : ax + (top - ay) * slope;
      }
      if (x_low > x_high) std::swap(x_low, x_high);
      visit(row * columns_ + column_of(x_low - reach), row * columns_ + column_of(x_high + reach));
    }
  }

  /// Calls visit(first_cell, last_cell) for each row of cells that meets the box.
  template <class Visit>
  void over_box(double x_low, double y_low, double x_high, double y_high, Visit&& visit) const {
    const std::int32_t first_column = column_of(x_low), last_column = column_of(x_high);
    for (std::int32_t row = row_of(y_low), last = row_of(y_high); row <= last; ++row)
      visit(row * columns_ + first_column, row * columns_ + last_column);
  }

 private:
  static std::int32_t clamped(double index, std::int32_t size) {
    return index <= 0 ? 0 : index >= size ? size - 1 : static_cast<std::int32_t>(index);
  }
  double x0_ = 0, y0_ = 0, side_ = 1, per_side_ = 1;
  std::int32_t columns_ = 1, rows_ = 1;
};

/// Items per cell, flat.
class CellLists {
 public:
  void start(std::int32_t num_cells) {
    num_cells_ = num_cells;
    pairs_.clear();
  }
  void put(std::int32_t cell, std::int32_t item) { pairs_.push_back({cell, item}); }
  /// Sorts what was put; items of a cell keep their order.
  void finish();
  /// Items of neighbouring cells first..last.
  [[nodiscard]] std::span<const std::int32_t> items(std::int32_t first_cell, std::int32_t last_cell) const {
    const auto first = ix(offsets_[ix(first_cell)]), last = ix(offsets_[ix(last_cell) + 1]);
    return std::span(items_).subspan(first, last - first);
  }

 private:
  struct Pair {
    std::int32_t cell, item;
  };
  std::int32_t num_cells_ = 0;
  std::vector<Pair> pairs_;
  std::vector<std::int32_t> offsets_, items_;
};

/// Bounding box of the points used by edges.
[[nodiscard]] geometry::Box box_of(const std::vector<Point>& points, const std::vector<Edge>& edges);

}  // namespace pcbmesh::overlay
