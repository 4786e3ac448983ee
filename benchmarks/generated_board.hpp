// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <random>
#include <string>

#include "pcbmesh/board/board.hpp"

namespace pcbmesh::benchmarks {

/// A seeded board of `columns` x `rows` cells of 1 mm on four copper layers: a via in every cell, tracks of 0.15 mm with 45
/// degree bends between the vias on each signal layer, and a plane on each inner layer drawn as a frame round the vias.
inline board::Board generated_board(int columns, int rows, unsigned seed = 1) {
  constexpr Nm mm = nm_per_mm, um = nm_per_um;
  board::BoardParts parts;
  parts.name = parts.source = "generated board";
  parts.materials = {{"copper", 1, 0, 1, 5.8e7}, {"FR4", 4.4, 0.02, 1, 0}};
  for (int i = 0; i < 4; ++i) {
    if (i > 0)
      parts.stackup.push_back(
          {"dielectric " + std::to_string(i), "", board::LayerKind::dielectric, i == 2 ? 1000 * um : 200 * um, 1});
    parts.stackup.push_back({i == 0   ? "F.Cu"
                             : i == 3 ? "B.Cu"
                                      : "In" + std::to_string(i) + ".Cu",
                             "", board::LayerKind::copper, 35 * um, 0});
  }
  parts.outlines = {{geometry::Path{{{0, 0}, {columns * mm, 0}, {columns * mm, rows * mm}, {0, rows * mm}}, {}, true}, {}}};
  std::mt19937 random(seed);
  const auto below = [&](unsigned n) { return static_cast<int>(random() % n); };
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      const geometry::Point via{x * mm + mm / 2, y * mm + mm / 2};
      const auto net = static_cast<std::int32_t>(parts.nets.size());
      parts.nets.push_back("net" + std::to_string(net));
      parts.drills.push_back({geometry::disc(via, 300 * um), 0, 3, true, net, board::ShapeKind::via, 0});
      for (std::int32_t layer = 0; layer < 4; ++layer)
        parts.shapes.push_back({layer, net, board::ShapeKind::via, geometry::disc(via, 500 * um), 0});
      // A stub of track that stays inside its own cell: east or west, then 45 degrees towards a corner.
      for (std::int32_t layer : {0, 3}) {
        const int sx = below(2) == 0 ? 1 : -1, sy = below(2) == 0 ? 1 : -1;
        const geometry::Point bend{via.x + sx * 300 * um, via.y},
            end{bend.x + sx * 70 * um, bend.y + sy * (70 + 10 * below(25)) * um};
        parts.shapes.push_back({layer, net, board::ShapeKind::track, geometry::segment(via, bend, 150 * um), 0});
        parts.shapes.push_back({layer, net, board::ShapeKind::track, geometry::segment(bend, end, 150 * um), 0});
      }
    }
  return board::Board::from_parts(std::move(parts));
}

}  // namespace pcbmesh::benchmarks
