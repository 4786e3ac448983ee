// SPDX-License-Identifier: GPL-3.0-or-later
// A good mesh, and every way the tests know to damage it. The judge is judged with these: unit/fault_matrix_test.cpp and
// validation/cases/checks.
#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "pcbmesh/validation/profiles.hpp"
#include "unit/check_block.hpp"

namespace pcbmesh::tests {

enum class Cells { prisms, tetrahedra, mixed };
inline constexpr std::array<Cells, 3> all_cells{Cells::prisms, Cells::tetrahedra, Cells::mixed};
inline const char* name_of(Cells cells) {
  return cells == Cells::prisms ? "prisms" : cells == Cells::tetrahedra ? "tetrahedra" : "mixed";
}

/// Eight by eight squares of 1 mm in four layers: core, copper (strip A along y = 7..8 mm, strip B along y = 5..6 mm with a
/// gap), prepreg, cover. On it a sheet, a lumped port between sheet and ground, a wave port, and two periodic sides.
class Damage {
 public:
  static constexpr int n = 8, num_levels = 5;
  static constexpr std::int32_t outer = 1, port = 2, xmin = 3, xmax = 4, sheet = 5, ground = 6, wave_port = 7;
  static constexpr std::int32_t core = 1, copper_a = 2, copper_b = 3, copper_layer_fill = 4, prepreg = 5, cover = 6;

  CheckCase c;
  validation::CheckOptions options;
  std::mt19937_64 random;
  Cells cells;

  Damage(Cells kind, std::uint64_t seed) : random(seed), cells(kind) {
    BlockPlan plan;
    plan.nx = plan.ny = n;
    plan.heights = {1e-4, 35e-6, 1e-4, 2e-4};
    for (int k = 0; k < 4; ++k) plan.tetrahedral.push_back(kind == Cells::tetrahedra || (kind == Cells::mixed && k % 2 == 1));
    plan.groups = {{"core", "fr4", "", false}, {"F.Cu", "copper", "A", true}, {"F.Cu", "copper", "B", true},
                   {"F.Cu", "fr4", "", false}, {"prepreg", "fr4", "", false}, {"cover", "fr4", "", false}};
    for (int k = 0; k < 4; ++k) {
      for (int y = 0; y < n; ++y) {
        for (int x = 0; x < n; ++x) {
          plan.labels.push_back(k == 0 ? 0 : k == 2 ? 4 : k == 3 ? 5 : y == 7 ? 1 : y == 5 && x != 4 ? 2 : 3);
        }
      }
    }
    for (int i = 0; i < n * n; ++i) plan.rising.push_back((i / n + i) % 2 == 0);
    // No edge of the sheet's triangles may join two points of its rim.
    const auto diagonal = [&](int x, int y, bool rises) { plan.rising[static_cast<std::size_t>(y * n + x)] = rises; };
    diagonal(1, 1, true);
    diagonal(3, 3, true);
    diagonal(3, 1, false);
    diagonal(1, 3, false);
    c = build_block(plan);
    name_sides();
    c.mesh.format = {"msh", "2.2", true};
    options.num_threads = 1;
    options.profile = validation::find_profile("palace");
    const auto limit = [](double value) { return validation::Limit{value, validation::FindingSeverity::error}; };
    options.limits.min_face_angle_deg = limit(1);
    options.limits.min_dihedral_deg = limit(1);
    options.limits.max_dihedral_deg = limit(179);
    options.limits.max_aspect_ratio = limit(100);
    options.limits.max_height_growth = limit(10);
    options.limits.min_edge_m = limit(9e-6);
    options.limits.min_scaled_jacobian = limit(1e-3);
    options.limits.min_prism_quality = limit(0.02);
  }

  [[nodiscard]] validation::Report check() const { return validation::check(c.mesh, &c.expectation, options); }

  // Nodes and cells by place. All coordinates are products of small integers, so they compare exactly.
  [[nodiscard]] std::int64_t node(int x, int y, int k) const {
    return (static_cast<std::int64_t>(k) * (n + 1) + y) * (n + 1) + x;
  }
  std::array<double, 3>& at(std::int64_t id) { return c.mesh.nodes[static_cast<std::size_t>(id)]; }
  [[nodiscard]] int below(int limit) { return static_cast<int>(random() % static_cast<std::uint64_t>(limit)); }
  /// A node of an inner level over no sheet, port or side; levels 2 and 3 have one group above and below.
  std::int64_t inner_node(int k) { return node(5 + below(2), 2 + below(3), k); }

  struct CellAt {
    std::size_t block = 0;
    std::int64_t index = 0;
    [[nodiscard]] bool operator==(const CellAt&) const = default;
  };
  [[nodiscard]] mesh::CellBlock& block_of(const CellAt& cell) { return c.mesh.cells[cell.block]; }
  [[nodiscard]] std::size_t corner_count(const CellAt& cell) {
    return static_cast<std::size_t>(corners_of(block_of(cell).kind));
  }
  std::int64_t& corner(const CellAt& cell, std::size_t i) {
    return block_of(cell).corners[static_cast<std::size_t>(cell.index) * corner_count(cell) + i];
  }
  std::int32_t& tag(const CellAt& cell) { return block_of(cell).tags[static_cast<std::size_t>(cell.index)]; }
  std::vector<std::int64_t> corners(const CellAt& cell) {
    std::vector<std::int64_t> out;
    for (std::size_t i = 0; i < corner_count(cell); ++i) out.push_back(corner(cell, i));
    return out;
  }
  std::array<double, 3> centre(std::span<const std::int64_t> ids) {
    std::array<double, 3> sum{};
    for (const std::int64_t id : ids) {
      for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += at(id)[axis] / static_cast<double>(ids.size());
    }
    return sum;
  }
  /// Cells whose centre lies in squares [x0, x1) x [y0, y1) of layer k.
  std::vector<CellAt> cells_in(int x0, int x1, int y0, int y1, int k) {
    std::vector<CellAt> out;
    for (std::size_t b = 0; b < c.mesh.cells.size(); ++b) {
      for (std::int64_t i = 0; i < c.mesh.cells[b].size(); ++i) {
        const auto middle = centre(corners(CellAt{b, i}));
        const double x = middle[0] * 1e3, y = middle[1] * 1e3;
        if (x > x0 && x < x1 && y > y0 && y < y1 && middle[2] > at(node(0, 0, k))[2] && middle[2] < at(node(0, 0, k + 1))[2]) {
          out.push_back({b, i});
        }
      }
    }
    return out;
  }
  CellAt pick(const std::vector<CellAt>& from) {
    return from.at(static_cast<std::size_t>(below(static_cast<int>(from.size()))));
  }
  /// A cell that touches neither hull nor sheet nor port, of the fill of the copper layer or of the prepreg.
  CellAt inner_cell() { return pick(cells_in(5, 7, 2, 5, 1 + below(2))); }
  void erase(const CellAt& cell) {
    auto& block = block_of(cell);
    const auto size = static_cast<std::ptrdiff_t>(corner_count(cell));
    block.corners.erase(block.corners.begin() + cell.index * size, block.corners.begin() + (cell.index + 1) * size);
    block.tags.erase(block.tags.begin() + cell.index);
  }
  void erase_all(std::vector<CellAt> list) {
    std::sort(list.begin(), list.end(), [](const CellAt& a, const CellAt& b) { return a.index > b.index; });
    for (const CellAt& cell : list) erase(cell);
    std::erase_if(c.mesh.cells, [](const mesh::CellBlock& block) { return block.size() == 0; });
  }
  void add(mesh::CellKind kind, const std::vector<std::int64_t>& ids, std::int32_t volume_tag) {
    auto block = std::find_if(c.mesh.cells.begin(), c.mesh.cells.end(), [&](const auto& one) { return one.kind == kind; });
    if (block == c.mesh.cells.end()) block = c.mesh.cells.insert(block, mesh::CellBlock{kind, {}, {}});
    block->corners.insert(block->corners.end(), ids.begin(), ids.end());
    block->tags.push_back(volume_tag);
  }
  std::int64_t add_node(const std::array<double, 3>& place) {
    c.mesh.nodes.push_back(place);
    return static_cast<std::int64_t>(c.mesh.nodes.size()) - 1;
  }
  double six_volumes(const std::array<std::int64_t, 4>& ids) {
    std::array<std::array<double, 3>, 3> e{};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) e[i][axis] = at(ids[i + 1])[axis] - at(ids[0])[axis];
    }
    return e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) + e[0][1] * (e[1][2] * e[2][0] - e[1][0] * e[2][2]) +
           e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]);
  }
  bool has_wedge(const CellAt& cell) { return block_of(cell).kind == mesh::CellKind::wedge; }

  struct Cell {
    mesh::CellKind kind;
    std::vector<std::int64_t> corners;
    std::int32_t tag = 0;
  };
  std::vector<Cell> mesh_cells() {
    std::vector<Cell> out;
    for (std::size_t b = 0; b < c.mesh.cells.size(); ++b) {
      for (std::int64_t i = 0; i < c.mesh.cells[b].size(); ++i) {
        const CellAt cell{b, i};
        out.push_back({block_of(cell).kind, corners(cell), tag(cell)});
      }
    }
    return out;
  }

  struct FaceAt {
    std::size_t block = 0;
    std::int64_t index = 0;
  };
  std::vector<std::int64_t> corners(const FaceAt& face) {
    const auto& block = c.mesh.faces[face.block];
    const auto size = static_cast<std::ptrdiff_t>(corners_of(block.kind));
    return {block.corners.begin() + face.index * size, block.corners.begin() + (face.index + 1) * size};
  }
  std::int32_t& tag(const FaceAt& face) { return c.mesh.faces[face.block].tags[static_cast<std::size_t>(face.index)]; }
  FaceAt face_of(std::int32_t face_tag) {
    std::vector<FaceAt> found;
    for (std::size_t b = 0; b < c.mesh.faces.size(); ++b) {
      for (std::int64_t i = 0; i < c.mesh.faces[b].size(); ++i) {
        if (c.mesh.faces[b].tags[static_cast<std::size_t>(i)] == face_tag) found.push_back({b, i});
      }
    }
    return found.at(static_cast<std::size_t>(below(static_cast<int>(found.size()))));
  }
  void erase(const FaceAt& face) {
    auto& block = c.mesh.faces[face.block];
    const auto size = static_cast<std::ptrdiff_t>(corners_of(block.kind));
    block.corners.erase(block.corners.begin() + face.index * size, block.corners.begin() + (face.index + 1) * size);
    block.tags.erase(block.tags.begin() + face.index);
  }
  void add_face(const std::vector<std::int64_t>& ids, std::int32_t face_tag) {
    const mesh::FaceKind kind = ids.size() == 3 ? mesh::FaceKind::triangle : mesh::FaceKind::quadrangle;
    auto block = std::find_if(c.mesh.faces.begin(), c.mesh.faces.end(), [&](const auto& one) { return one.kind == kind; });
    if (block == c.mesh.faces.end()) block = c.mesh.faces.insert(block, mesh::FaceBlock{kind, {}, {}});
    block->corners.insert(block->corners.end(), ids.begin(), ids.end());
    block->tags.push_back(face_tag);
  }
  /// Faces of a cell, outwards, as the definition of the corner order has them.
  std::vector<std::vector<std::int64_t>> faces_of_cell(const CellAt& cell) {
    static const std::vector<std::vector<std::size_t>> wedge{{0, 2, 1}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}},
        tetrahedron{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    std::vector<std::vector<std::int64_t>> out;
    for (const auto& side : has_wedge(cell) ? wedge : tetrahedron) {
      out.emplace_back();
      for (const std::size_t i : side) out.back().push_back(corner(cell, i));
    }
    return out;
  }
  /// All cells of layer k and above get nodes of their own on level k, moved up by `shift`.
  void detach_above(int k, double shift) {
    std::map<std::int64_t, std::int64_t> twin;
    for (int layer = k; layer < num_levels - 1; ++layer) {
      for (const CellAt& cell : cells_in(0, n, 0, n, layer)) {
        for (std::size_t i = 0; i < corner_count(cell); ++i) {
          std::int64_t& id = corner(cell, i);
          if (id < node(0, 0, k) || id >= node(0, 0, k + 1)) continue;
          auto& to = twin[id];
          if (to == 0) {
            auto place = at(id);
            place[2] += shift;
            to = add_node(place);
          }
          id = to;
        }
      }
    }
    // The tagged sides go with their cells.
    for (auto& block : c.mesh.faces) {
      const auto size = static_cast<std::size_t>(corners_of(block.kind));
      for (std::size_t f = 0; f < block.tags.size(); ++f) {
        const auto ids = std::span(block.corners).subspan(f * size, size);
        if (centre(ids)[2] <= at(node(0, 0, k))[2]) continue;
        for (std::int64_t& id : ids) {
          if (const auto to = twin.find(id); to != twin.end()) id = to->second;
        }
      }
    }
  }

 private:
  void name_sides() {
    for (std::size_t b = 0; b < c.mesh.faces.size(); ++b) {
      for (std::int64_t i = 0; i < c.mesh.faces[b].size(); ++i) {
        const auto middle = centre(corners(FaceAt{b, i}));
        std::int32_t& face_tag = tag(FaceAt{b, i});
        if (middle[0] < 1e-9) face_tag = xmin;
        if (middle[0] > n * 1e-3 - 1e-9) face_tag = xmax;
        if (middle[1] < 1e-9) face_tag = wave_port;
        if (middle[2] == 0) face_tag = ground;
      }
    }
    add_inner_faces(sheet, [](const std::array<double, 3>& p) {
      return p[2] == 1e-4 && p[0] > 0.5e-3 && p[0] < 4.5e-3 && p[1] > 0.5e-3 && p[1] < 4.5e-3;
    });
    add_inner_faces(
        port, [](const std::array<double, 3>& p) { return p[1] == 3e-3 && p[2] <= 1e-4 && p[0] > 0.5e-3 && p[0] < 3.5e-3; });
    describe_faces();
  }
  template <class Contains>
  void add_inner_faces(std::int32_t face_tag, Contains contains) {
    std::set<std::vector<std::int64_t>> seen;
    for (std::size_t b = 0; b < c.mesh.cells.size(); ++b) {
      for (std::int64_t i = 0; i < c.mesh.cells[b].size(); ++i) {
        for (const auto& face : faces_of_cell({b, i})) {
          if (!std::all_of(face.begin(), face.end(), [&](std::int64_t id) { return contains(at(id)); })) continue;
          auto key = face;
          std::sort(key.begin(), key.end());
          if (seen.insert(key).second) add_face(face, face_tag);
        }
      }
    }
  }
  void describe_faces() {
    const std::map<std::int32_t, std::array<const char*, 2>> names{{outer, {"outer", "outer"}},
                                                                   {port, {"port|P1", "port"}},
                                                                   {xmin, {"xmin", "outer"}},
                                                                   {xmax, {"xmax", "outer"}},
                                                                   {sheet, {"sheet|S", "sheet"}},
                                                                   {ground, {"pec|GND", "conductor"}},
                                                                   {wave_port, {"waveport|W", "wave_port"}}};
    std::erase_if(c.mesh.names, [](const mesh::GroupName& name) { return name.dimension == 2; });
    c.expectation.faces.clear();
    for (const auto& [face_tag, name] : names) {
      c.mesh.names.push_back({2, face_tag, name[0]});
      const bool is_outer = std::string(name[1]) == "outer" || std::string(name[1]) == "wave_port";
      c.expectation.faces.push_back({face_tag, name[0], is_outer, 0, 0, name[1]});
    }
    for (std::size_t b = 0; b < c.mesh.faces.size(); ++b) {
      for (std::int64_t i = 0; i < c.mesh.faces[b].size(); ++i) {
        auto& group = *std::find_if(c.expectation.faces.begin(), c.expectation.faces.end(), [&](const auto& face) {
          return face.tag == tag(FaceAt{b, i});
        });
        ++group.num_faces;
        group.area_m2 += area(corners(FaceAt{b, i}));
      }
    }
    c.expectation.periodic = {{"xmin", "xmax", std::nullopt}};
    link_sides();
  }
  /// What a file would say of them: xmax is xmin, moved along x.
  void link_sides() {
    mesh::PeriodicLink link{"xmax of xmin", {}, {}, {}, std::array<double, 12>{1, 0, 0, n * 1e-3, 0, 1, 0, 0, 0, 0, 1, 0}};
    for (int k = 0; k < num_levels; ++k) {
      for (int y = 0; y <= n; ++y) link.nodes.push_back({node(n, y, k), node(0, y, k)});
    }
    for (const auto& block : c.mesh.faces) {
      const auto size = static_cast<std::ptrdiff_t>(corners_of(block.kind));
      mesh::FaceBlock high{block.kind, {}, {}}, low = high;
      for (std::int64_t i = 0; i < block.size(); ++i) {
        const std::int32_t side = block.tags[static_cast<std::size_t>(i)];
        if (side != xmin && side != xmax) continue;
        auto& into = side == xmax ? high : low;
        into.corners.insert(into.corners.end(), block.corners.begin() + i * size, block.corners.begin() + (i + 1) * size);
        into.tags.push_back(0);
      }
      if (high.size() > 0) link.faces.push_back(high);
      if (low.size() > 0) link.partner_faces.push_back(low);
    }
    c.mesh.periodic = {link};
  }
  double area(const std::vector<std::int64_t>& ids) {
    double sum = 0;
    for (std::size_t i = 2; i < ids.size(); ++i) {
      const auto &a = at(ids[0]), &b = at(ids[i - 1]), &d = at(ids[i]);
      std::array<double, 3> u{}, v{};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        u[axis] = b[axis] - a[axis];
        v[axis] = d[axis] - a[axis];
      }
      sum += 0.5 * std::hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]);
    }
    return sum;
  }
};

/// A finding beside the one that must be made, and why such a mesh shows it by the definition of the check.
struct Consequence {
  const char* code;
  bool is_certain;  ///< follows wherever the damage is done, on every kind of cells; else it depends on the place or the kind
  const char* why;
};
inline Consequence always(const char* code, const char* why) {
  return {code, true, why};
}
inline Consequence perhaps(const char* code, const char* why) {
  return {code, false, why};
}

/// One kind of damage. `apply` returns the code that must be found, or nothing where this kind of cells can't be damaged so.
struct Fault {
  const char* name;
  std::function<std::string(Damage&)> apply;
  std::vector<Consequence> consequences;
};

}  // namespace pcbmesh::tests
