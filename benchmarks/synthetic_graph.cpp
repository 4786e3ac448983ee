// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmarks/synthetic_graph.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

namespace pcbmesh::benchmarks {
namespace {

using geometry::Point;

constexpr Nm pitch = 250'000;
constexpr int cells_per_mm = 4;
constexpr std::array<std::array<int, 2>, 8> directions{{{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};

class Draughtsman {
 public:
  Draughtsman(int width_mm, int height_mm, std::uint32_t seed)
      : columns_(width_mm * cells_per_mm + 1),
        rows_(height_mm * cells_per_mm + 1),
        random_(seed),
        is_taken_(static_cast<std::size_t>(columns_ * rows_), 0),
        diagonals_(is_taken_.size(), 0) {}

  mesh::PlanarGraph draw() {
    const Point far{(columns_ - 1) * pitch, (rows_ - 1) * pitch};
    add_ring({{0, 0}, {far.x, 0}, far, {0, far.y}}, {{0, 1}, {1, 1}});
    for (int y = 4; y + 4 < rows_; y += cells_per_mm) {
      for (int x = 4; x + 4 < columns_; x += cells_per_mm) {
        if (roll(100) < 60) add_via(x, y);
      }
    }
    const int num_attempts = columns_ * rows_ / 8;
    for (int i = 0; i < num_attempts; ++i) add_track();
    return mesh::PlanarGraph::from_parts(std::move(parts_));
  }

 private:
  int roll(int sides) { return static_cast<int>(random_() % static_cast<std::uint32_t>(sides)); }  // the same on every library
  [[nodiscard]] std::size_t cell(int x, int y) const { return static_cast<std::size_t>(y * columns_ + x); }

  void add_ring(const std::vector<Point>& ring, const std::vector<mesh::Increment>& bodies) {
    const auto first = static_cast<std::int32_t>(parts_.vertices.size()), size = static_cast<std::int32_t>(ring.size());
    parts_.vertices.insert(parts_.vertices.end(), ring.begin(), ring.end());
    if (parts_.increment_offsets.empty()) parts_.increment_offsets.push_back(0);
    for (std::int32_t i = 0; i < size; ++i) {
      const bool closes = i + 1 == size;
      parts_.edges.push_back(closes ? std::array{first, first + i} : std::array{first + i, first + i + 1});
      for (const auto& [body, delta] : bodies) parts_.increments.push_back({body, closes ? -delta : delta});
      parts_.increment_offsets.push_back(static_cast<std::int32_t>(parts_.increments.size()));
    }
  }

  void add_via(int x, int y) {
    for (int j = -1; j <= 1; ++j) {
      for (int i = -1; i <= 1; ++i) is_taken_[cell(x + i, y + j)] = 1;
    }
    for (const auto& [radius, body] : {std::pair{250'000.0, 2}, std::pair{125'000.0, 3}}) {
      std::vector<Point> ring;
      for (int k = 0; k < 24; ++k) {
        const double angle = 2 * std::numbers::pi * k / 24;
        ring.push_back(
            {x * pitch + std::llround(radius * std::cos(angle)), y * pitch + std::llround(radius * std::sin(angle))});
      }
      add_ring(ring, {{body, 1}});
    }
  }

  bool can_step(int x, int y, std::size_t direction) const {
    const auto [dx, dy] = directions[direction];
    const int to_x = x + dx, to_y = y + dy;
    if (to_x < 1 || to_y < 1 || to_x >= columns_ - 1 || to_y >= rows_ - 1 || is_taken_[cell(to_x, to_y)] != 0) return false;
    return dx == 0 || dy == 0 || diagonals_[cell(std::min(x, to_x), std::min(y, to_y))] == 0;  // another diagonal would cross
  }

  void add_track() {
    int x = 1 + roll(columns_ - 2), y = 1 + roll(rows_ - 2);
    if (is_taken_[cell(x, y)] != 0) return;
    auto direction = static_cast<std::size_t>(roll(8));
    std::vector<std::array<int, 2>> path{{x, y}};
    is_taken_[cell(x, y)] = 1;
    const int wanted = 4 + roll(40);
    for (int step = 0; step < wanted; ++step) {
      if (step > 1 && roll(5) == 0) direction = (direction + (roll(2) == 0 ? 1 : 7)) % 8;
      for (const std::size_t turn : {0U, 1U, 7U}) {
        if (!can_step(x, y, (direction + turn) % 8)) continue;
        direction = (direction + turn) % 8;
        const auto [dx, dy] = directions[direction];
        if (dx != 0 && dy != 0) diagonals_[cell(std::min(x, x + dx), std::min(y, y + dy))] = 1;
        x += dx;
        y += dy;
        is_taken_[cell(x, y)] = 1;
        path.push_back({x, y});
        break;
      }
      if (path.size() != static_cast<std::size_t>(step) + 2) break;
    }
    if (path.size() >= 3) add_ring(outline(path), {{2, 1}});
  }

  /// Both sides of a path, 0.1 mm wide, mitred.
  static std::vector<Point> outline(const std::vector<std::array<int, 2>>& path) {
    constexpr double half_width = 50'000;
    std::vector<std::array<double, 2>> bends, normals;
    for (std::size_t i = 0; i < path.size(); ++i) {
      const auto direction = [&](std::size_t from) {
        const double dx = path[from + 1][0] - path[from][0], dy = path[from + 1][1] - path[from][1],
                     length = std::hypot(dx, dy);
        return std::array{-dy / length, dx / length};
      };
      const auto before = direction(i > 0 ? i - 1 : i), after = direction(i + 1 < path.size() ? i : i - 1);
      const double cosine = before[0] * after[0] + before[1] * after[1];
      if (i > 0 && i + 1 < path.size() && cosine > 0.99) continue;
      bends.push_back({static_cast<double>(path[i][0] * pitch), static_cast<double>(path[i][1] * pitch)});
      normals.push_back({(before[0] + after[0]) / (1 + cosine), (before[1] + after[1]) / (1 + cosine)});
    }
    std::vector<Point> ring;
    const auto push = [&](std::size_t i, double side) {
      ring.push_back({std::llround(bends[i][0] + side * normals[i][0]), std::llround(bends[i][1] + side * normals[i][1])});
    };
    for (std::size_t i = 0; i < bends.size(); ++i) push(i, -half_width);
    for (std::size_t i = bends.size(); i-- > 0;) push(i, half_width);
    return ring;
  }

  int columns_, rows_;
  std::mt19937 random_;
  std::vector<char> is_taken_, diagonals_;  // per grid point; per grid cell by its lower left point
  mesh::PlanarGraphParts parts_;
};

}  // namespace

mesh::PlanarGraph synthetic_graph(int width_mm, int height_mm, std::uint32_t seed) {
  return Draughtsman(width_mm, height_mm, seed).draw();
}

model::Model synthetic_model() {
  model::ModelParts parts;
  parts.materials.resize(2);
  parts.slabs.push_back({"L1", model::SlabKind::dielectric, 0, 100'000, 0, -1});
  for (const auto kind : {model::BodyKind::domain, model::BodyKind::board, model::BodyKind::copper, model::BodyKind::barrel}) {
    model::Body body;
    body.kind = kind;
    body.material = 1;
    parts.bodies.push_back(body);
  }
  return model::Model::from_parts(std::move(parts));
}

}  // namespace pcbmesh::benchmarks
