// SPDX-License-Identifier: GPL-3.0-or-later
// Small explicit meshes for the tests of the checker, made without any code of the generator.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "pcbmesh/validation/report.hpp"

namespace pcbmesh::tests {

/// A mesh with what it is supposed to be.
struct CheckCase {
  mesh::MeshData mesh;
  validation::Expectation expectation;
};

constexpr int empty_label = -1;

/// A grid of squares, each cut in two triangles, times layers. Each square of each layer has a label: an index into
/// `groups`, or empty_label (a void: its surface is tagged as a conductor's skin).
struct BlockPlan {
  struct Group {
    std::string layer, material, net;
    bool conductor = false;
  };
  int nx = 2, ny = 2;
  std::vector<double> heights;    ///< per layer
  std::vector<bool> tetrahedral;  ///< per layer: prisms are cut into three tetrahedra
  std::vector<Group> groups;
  std::vector<int> labels;          ///< [(layer * ny + y) * nx + x]
  std::vector<bool> rising;         ///< per square: diagonal from (0,0) to (1,1)
  std::vector<double> jitter;       ///< two per grid point, in squares; outer points stay
  double square = 1e-3;             ///< metres
  std::uint64_t shuffle_nodes = 0;  ///< seed; 0 = in order

  [[nodiscard]] int num_layers() const { return static_cast<int>(heights.size()); }
  [[nodiscard]] int label(int x, int y, int k) const {
    if (x < 0 || y < 0 || k < 0 || x >= nx || y >= ny || k >= num_layers()) return empty_label;
    return labels[static_cast<std::size_t>((k * ny + y) * nx + x)];
  }
};

/// Builds the mesh and, by plane geometry and a flood fill over squares, what tags.json would say of it.
class BlockBuilder {
 public:
  explicit BlockBuilder(const BlockPlan& plan) : plan_(plan) {}

  CheckCase build() {
    place_nodes();
    add_cells_and_faces();
    describe_nets();
    describe_layers();
    return finish();
  }

 private:
  using Point = std::array<double, 2>;
  [[nodiscard]] std::int64_t node(int x, int y, int k) const {
    return (static_cast<std::int64_t>(k) * (plan_.ny + 1) + y) * (plan_.nx + 1) + x;
  }

  void place_nodes() {
    double z = 0;
    for (int k = 0; k <= plan_.num_layers(); ++k) {
      for (int y = 0; y <= plan_.ny; ++y) {
        for (int x = 0; x <= plan_.nx; ++x) {
          const auto i = static_cast<std::size_t>(2 * (y * (plan_.nx + 1) + x));
          const bool inside = x > 0 && y > 0 && x < plan_.nx && y < plan_.ny && !plan_.jitter.empty();
          nodes_.push_back({(x + (inside ? plan_.jitter[i] : 0.0)) * plan_.square,
                            (y + (inside ? plan_.jitter[i + 1] : 0.0)) * plan_.square, z});
        }
      }
      if (k < plan_.num_layers()) z += plan_.heights[static_cast<std::size_t>(k)];
    }
  }

  [[nodiscard]] Point flat(std::int64_t id) const {
    const auto& at = nodes_[static_cast<std::size_t>(id)];
    return {at[0], at[1]};
  }
  [[nodiscard]] double area(const std::array<std::int64_t, 3>& t) const {
    const Point a = flat(t[0]), b = flat(t[1]), c = flat(t[2]);
    return 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
  }

  /// The two triangles of a square in the plane of level k, counter-clockwise from above.
  [[nodiscard]] std::array<std::array<std::int64_t, 3>, 2> triangles(int x, int y, int k) const {
    const std::int64_t a = node(x, y, k), b = node(x + 1, y, k), c = node(x + 1, y + 1, k), d = node(x, y + 1, k);
    if (plan_.rising[static_cast<std::size_t>(y * plan_.nx + x)]) return {{{a, b, c}, {a, c, d}}};
    return {{{a, b, d}, {b, c, d}}};
  }

  void add_prism(const std::array<std::int64_t, 3>& low, std::int64_t up, int k, std::int32_t tag) {
    std::array<std::int64_t, 6> p{low[0], low[1], low[2], low[0] + up, low[1] + up, low[2] + up};
    if (!plan_.tetrahedral[static_cast<std::size_t>(k)]) {
      wedges_.corners.insert(wedges_.corners.end(), p.begin(), p.end());
      wedges_.tags.push_back(tag);
      return;
    }
    // Every wall is cut from its smallest node: both neighbours choose the same diagonal. Turned so that the smallest
    // bottom node is first, the two walls at it are settled and the third decides between two ways.
    while (p[0] > p[1] || p[0] > p[2]) p = {p[1], p[2], p[0], p[4], p[5], p[3]};
    const auto add = [&](std::int64_t a, std::int64_t b, std::int64_t c, std::int64_t d) {
      tets_.corners.insert(tets_.corners.end(), {a, b, c, d});
      tets_.tags.push_back(tag);
    };
    add(p[0], p[4], p[5], p[3]);
    if (p[1] < p[2]) {
      add(p[0], p[1], p[2], p[5]);
      add(p[0], p[1], p[5], p[4]);
    } else {
      add(p[0], p[1], p[2], p[4]);
      add(p[0], p[4], p[2], p[5]);
    }
  }

  void add_face(std::int32_t tag, const std::vector<std::int64_t>& corners, double area_m2) {
    mesh::FaceBlock& block = corners.size() == 3 ? triangles_ : quads_;
    block.corners.insert(block.corners.end(), corners.begin(), corners.end());
    block.tags.push_back(tag);
    auto& sum = face_sums_[tag];
    ++sum.num_faces;
    sum.area_m2 += area_m2;
  }

  /// Outer sides are tag 1, the skin of voids is tag 2.
  void add_caps(int x, int y, int k, std::int64_t up) {
    for (const auto& t : triangles(x, y, k)) {
      if (plan_.label(x, y, k - 1) == empty_label) add_face(k == 0 ? 1 : 2, {t[0], t[2], t[1]}, area(t));
      if (plan_.label(x, y, k + 1) == empty_label) {
        add_face(k + 1 == plan_.num_layers() ? 1 : 2, {t[0] + up, t[1] + up, t[2] + up}, area(t));
      }
    }
  }

  void add_wall(std::int64_t a, std::int64_t b, std::int64_t up, int k, bool outer) {
    const Point p = flat(a), q = flat(b);
    const double size = std::hypot(q[0] - p[0], q[1] - p[1]) * plan_.heights[static_cast<std::size_t>(k)];
    const std::int32_t tag = outer ? 1 : 2;
    if (!plan_.tetrahedral[static_cast<std::size_t>(k)]) {
      add_face(tag, {a, b, b + up, a + up}, size);
    } else if (a < b) {
      add_face(tag, {a, b, b + up}, size / 2);
      add_face(tag, {a, b + up, a + up}, size / 2);
    } else {
      add_face(tag, {a, b, a + up}, size / 2);
      add_face(tag, {b, b + up, a + up}, size / 2);
    }
  }

  void add_walls(int x, int y, int k, std::int64_t up) {
    const std::int64_t a = node(x, y, k), b = node(x + 1, y, k), c = node(x + 1, y + 1, k), d = node(x, y + 1, k);
    if (plan_.label(x, y - 1, k) == empty_label) add_wall(a, b, up, k, y == 0);
    if (plan_.label(x + 1, y, k) == empty_label) add_wall(b, c, up, k, x + 1 == plan_.nx);
    if (plan_.label(x, y + 1, k) == empty_label) add_wall(c, d, up, k, y + 1 == plan_.ny);
    if (plan_.label(x - 1, y, k) == empty_label) add_wall(d, a, up, k, x == 0);
  }

  void add_cells_and_faces() {
    wedges_.kind = mesh::CellKind::wedge;
    tets_.kind = mesh::CellKind::tetrahedron;
    triangles_.kind = mesh::FaceKind::triangle;
    quads_.kind = mesh::FaceKind::quadrangle;
    const std::int64_t up = node(0, 0, 1) - node(0, 0, 0);
    for (int k = 0; k < plan_.num_layers(); ++k) {
      for (int y = 0; y < plan_.ny; ++y) {
        for (int x = 0; x < plan_.nx; ++x) {
          const int label = plan_.label(x, y, k);
          if (label == empty_label) continue;
          for (const auto& t : triangles(x, y, k)) {
            add_prism(t, up, k, label + 1);
            auto& sum = volume_sums_[label + 1];
            sum.num_cells += plan_.tetrahedral[static_cast<std::size_t>(k)] ? 3 : 1;
            sum.volume_m3 += area(t) * plan_.heights[static_cast<std::size_t>(k)];
          }
          add_caps(x, y, k, up);
          add_walls(x, y, k, up);
        }
      }
    }
  }

  [[nodiscard]] std::string net(int x, int y, int k) const {
    const int label = plan_.label(x, y, k);
    if (label == empty_label || !plan_.groups[static_cast<std::size_t>(label)].conductor) return {};
    return plan_.groups[static_cast<std::size_t>(label)].net;
  }

  void describe_nets() {
    std::map<std::string, std::int32_t> pieces;
    std::set<std::array<std::string, 2>> touching;
    std::set<std::array<int, 3>> seen;
    constexpr int steps[6][3] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (int k = 0; k < plan_.num_layers(); ++k) {
      for (int y = 0; y < plan_.ny; ++y) {
        for (int x = 0; x < plan_.nx; ++x) {
          const std::string here = net(x, y, k);
          if (here.empty()) continue;
          for (const auto& step : steps) {
            const std::string there = net(x + step[0], y + step[1], k + step[2]);
            if (!there.empty() && here < there) touching.insert({there, here});
          }
          if (!seen.insert({x, y, k}).second) continue;
          ++pieces[here];
          std::vector<std::array<int, 3>> open{{x, y, k}};
          while (!open.empty()) {
            const auto at = open.back();
            open.pop_back();
            for (const auto& step : steps) {
              const std::array<int, 3> next{at[0] + step[0], at[1] + step[1], at[2] + step[2]};
              if (net(next[0], next[1], next[2]) == here && seen.insert(next).second) open.push_back(next);
            }
          }
        }
      }
    }
    for (const auto& [name, count] : pieces) out_.expectation.nets.push_back({name, count});
    out_.expectation.touching_nets.assign(touching.begin(), touching.end());
  }

  /// Heights of each layer, one entry per run of neighbouring layers of the plan, and the levels that carry nodes.
  void describe_layers() {
    std::map<std::string, std::set<int>> found;
    std::set<int> levels;
    std::vector<double> z{0};
    for (int k = 0; k < plan_.num_layers(); ++k) {
      z.push_back(z.back() + plan_.heights[static_cast<std::size_t>(k)]);
      for (int i = 0; i < plan_.nx * plan_.ny; ++i) {
        const int label = plan_.labels[static_cast<std::size_t>(k * plan_.nx * plan_.ny + i)];
        if (label == empty_label) continue;
        found[plan_.groups[static_cast<std::size_t>(label)].layer].insert(k);
        levels.insert({k, k + 1});
      }
    }
    for (const auto& [name, layers] : found) {
      for (const int k : layers) {
        auto& list = out_.expectation.layers;
        if (layers.contains(k - 1)) {
          list.back().z_max_m = z[static_cast<std::size_t>(k) + 1];
        } else {
          list.push_back({name, z[static_cast<std::size_t>(k)], z[static_cast<std::size_t>(k) + 1]});
        }
      }
    }
    for (const int k : levels) out_.expectation.levels_m.push_back(z[static_cast<std::size_t>(k)]);
  }

  CheckCase finish() {
    for (const auto& [tag, sum] : volume_sums_) {
      const auto& group = plan_.groups[static_cast<std::size_t>(tag - 1)];
      const std::string name = group.layer + "|" + group.material + "|" + (group.net.empty() ? "none" : group.net);
      out_.expectation.volumes.push_back(
          {tag, name, group.layer, group.material, group.net, group.conductor, sum.num_cells, sum.volume_m3});
      out_.mesh.names.push_back({3, tag, name});
    }
    for (const auto& [tag, sum] : face_sums_) {
      const std::string name = tag == 1 ? "outer" : "void";
      out_.expectation.faces.push_back({tag, name, tag == 1, sum.num_faces, sum.area_m2});
      out_.mesh.names.push_back({2, tag, name});
    }
    std::vector<std::int64_t> to(nodes_.size(), -1), used;
    for (const auto* block : {&wedges_, &tets_}) {
      for (const std::int64_t corner : block->corners) to[static_cast<std::size_t>(corner)] = 0;
    }
    for (std::size_t i = 0; i < to.size(); ++i) {
      if (to[i] == 0) used.push_back(static_cast<std::int64_t>(i));
    }
    if (plan_.shuffle_nodes != 0) std::shuffle(used.begin(), used.end(), std::mt19937_64(plan_.shuffle_nodes));
    for (std::size_t i = 0; i < used.size(); ++i) {
      to[static_cast<std::size_t>(used[i])] = static_cast<std::int64_t>(i);
      out_.mesh.nodes.push_back(nodes_[static_cast<std::size_t>(used[i])]);
    }
    const auto renumber = [&](auto& block, auto& blocks) {
      for (std::int64_t& corner : block.corners) corner = to[static_cast<std::size_t>(corner)];
      if (block.size() > 0) blocks.push_back(block);
    };
    renumber(wedges_, out_.mesh.cells);
    renumber(tets_, out_.mesh.cells);
    renumber(triangles_, out_.mesh.faces);
    renumber(quads_, out_.mesh.faces);
    return std::move(out_);
  }

  struct VolumeSum {
    std::int64_t num_cells = 0;
    double volume_m3 = 0;
  };
  struct FaceSum {
    std::int64_t num_faces = 0;
    double area_m2 = 0;
  };
  const BlockPlan& plan_;
  CheckCase out_;
  std::vector<std::array<double, 3>> nodes_;
  mesh::CellBlock wedges_, tets_;
  mesh::FaceBlock triangles_, quads_;
  std::map<std::int32_t, VolumeSum> volume_sums_;
  std::map<std::int32_t, FaceSum> face_sums_;
};

inline CheckCase build_block(const BlockPlan& plan) {
  return BlockBuilder(plan).build();
}

/// A little board: substrate, a copper layer, substrate. Net A is a strip along y = 1, net B one along y = 3.
/// 5 x 5 squares; the middle layer is at k = 1. No voids, natural order, all prisms.
inline BlockPlan board_plan() {
  BlockPlan plan;
  plan.nx = plan.ny = 5;
  plan.heights = {1e-4, 35e-6, 2e-4};
  plan.tetrahedral = {false, false, false};
  plan.groups = {{"core", "fr4", "", false},
                 {"F.Cu", "copper", "A", true},
                 {"F.Cu", "copper", "B", true},
                 {"F.Cu", "fr4", "", false},
                 {"prepreg", "fr4", "", false}};
  for (int k = 0; k < 3; ++k) {
    for (int y = 0; y < 5; ++y) {
      for (int x = 0; x < 5; ++x) plan.labels.push_back(k == 0 ? 0 : k == 2 ? 4 : y == 1 ? 1 : y == 3 ? 2 : 3);
    }
  }
  for (int i = 0; i < 25; ++i) plan.rising.push_back(i % 2 == 0);
  return plan;
}

inline BlockPlan random_plan(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<std::uint64_t>(n)); };
  BlockPlan plan;
  plan.nx = 1 + below(5);
  plan.ny = 1 + below(5);
  const int layers = 1 + below(4);
  // From a 300 mm panel to a tiny chip.
  plan.square = std::array{6e-2, 1e-3, 1e-5, 3.7e-7}[static_cast<std::size_t>(below(4))];
  for (int k = 0; k < layers; ++k) {
    plan.heights.push_back(1e-6 * (1 + below(200)));
    plan.tetrahedral.push_back(below(3) == 0);
  }
  plan.groups = {{"L", "fr4", "", false},
                 {"L", "copper", "A", true},
                 {"L", "copper", "B", true},
                 {"M", "copper", "A", true},
                 {"M", "copper", "", true}};
  for (int i = 0; i < plan.nx * plan.ny * layers; ++i) {
    const int draw = below(12);
    plan.labels.push_back(draw < 5 ? draw : draw == 11 ? empty_label : 0);
  }
  if (*std::max_element(plan.labels.begin(), plan.labels.end()) == empty_label) plan.labels[0] = 0;
  for (int i = 0; i < plan.nx * plan.ny; ++i) plan.rising.push_back(below(2) == 0);
  for (int i = 0; i < 2 * (plan.nx + 1) * (plan.ny + 1); ++i) plan.jitter.push_back(0.002 * (below(201) - 100));
  plan.shuffle_nodes = below(2) == 0 ? 0 : seed + 1;
  return plan;
}

}  // namespace pcbmesh::tests
