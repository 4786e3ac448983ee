// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/layering/prism_quality.hpp"
#include "pcbmesh/view/cell_render.hpp"
#include "src/view/packing.hpp"

namespace pcbmesh::view {
namespace {

constexpr double quality_steps = 65534;
constexpr std::uint32_t num_explicit_codes = 65536;

std::size_t index(std::int64_t i) {
  return static_cast<std::size_t>(i);
}

void require_room(const CellMesh& mesh) {
  constexpr std::int64_t most = std::numeric_limits<std::int32_t>::max();
  if (mesh.num_cells() > most || static_cast<std::int64_t>(mesh.mesh().nodes.size()) > most)
    throw Error(ErrorCode::usage,
                fmt::format("{} cells are more than a page can number ({}); draw them with render, or view a part",
                            mesh.num_cells(), most),
                {.file = mesh.mesh().source});
}

/// Nodes that faces use, numbered as they come.
std::vector<std::int64_t> put_corners(PackedCells& out, const CellMesh& mesh) {
  std::vector<std::int32_t> number(mesh.mesh().nodes.size(), -1);
  std::vector<std::int64_t> used;
  std::vector<std::int32_t> first;
  std::vector<std::uint32_t> second, third, fourth;
  for (const CellFace& face : mesh.faces()) {
    std::array<std::int32_t, 4> n{};
    for (int i = 0; i < face.size(); ++i) {
      std::int32_t& known = number[index(face.nodes[index(i)])];
      if (known < 0) {
        known = static_cast<std::int32_t>(used.size());
        used.push_back(face.nodes[index(i)]);
      }
      n[index(i)] = known;
    }
    first.push_back(n[0]);
    second.push_back(zigzag(n[1] - n[0]));
    third.push_back(zigzag(n[2] - n[0]));
    fourth.push_back(face.size() == 4 ? 1 + zigzag(n[3] - n[0]) : 0);
  }
  out.put_differences("corner0", first);
  out.put("corner1", second);
  out.put("corner2", third);
  out.put("corner3", fourth);
  return used;
}

void put_nodes(PackedCells& out, const CellMesh& mesh, const std::vector<std::int64_t>& used) {
  std::array<double, 3> low, high;
  low.fill(std::numeric_limits<double>::max());
  high.fill(std::numeric_limits<double>::lowest());
  for (const std::int64_t node : used) {
    const auto p = mesh.node_m(node);
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
  }
  out.origin_m = low;
  out.step_m = {std::max({high[0] - low[0], high[1] - low[1], 1e-12}) / grid_steps,
                std::max(high[2] - low[2], 1e-12) / grid_steps};
  const auto steps = [&](const std::array<double, 3>& p, std::size_t k) {
    return static_cast<std::int32_t>(std::lround((p[k] - low[k]) / out.step_m[k == 2 ? 1 : 0]));
  };
  // Meshes of boards have their nodes above one another: places in the plane are told once.
  std::map<std::array<std::int32_t, 2>, std::int32_t> places;
  std::vector<std::int32_t> x, y, z, place;
  for (const std::int64_t node : used) {
    const std::array<double, 3> p = mesh.node_m(node);
    const std::array<std::int32_t, 2> here{steps(p, 0), steps(p, 1)};
    const auto [found, is_new] = places.try_emplace(here, static_cast<std::int32_t>(places.size()));
    if (is_new) {
      x.push_back(here[0]);
      y.push_back(here[1]);
    }
    place.push_back(found->second);
    z.push_back(steps(p, 2));
  }
  out.put_differences("x", x);
  out.put_differences("y", y);
  out.put_differences("place", place);
  out.put_differences("z", z);
}

double distance(const std::array<double, 3>& p, const std::array<double, 3>& q) {
  return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
}

/// Quality of a cell as one number. Of a right prism seen at one of its triangles it is the number of its height: the triangle
/// tells the rest, and heights are few where qualities are many.
class QualityCode {
 public:
  QualityCode(const CellMesh& mesh, PackedCells& out) : mesh_(mesh), out_(out) {}
  std::uint32_t operator()(const CellFace& face, std::int64_t cell) {
    const std::optional<double> q = cell < 0 ? std::nullopt : mesh_.quality_of(cell);
    if (!q) return 0;
    if (const std::optional<double> height = height_of_right_prism(face, cell, *q)) {
      // Heights that differ by rounding alone are one.
      const double known = std::round(*height / out_.height_step_m) * out_.height_step_m;
      const auto [found, is_new] = heights_.try_emplace(known, static_cast<std::uint32_t>(out_.heights_m.size()));
      if (is_new) out_.heights_m.push_back(*height);
      return num_explicit_codes + found->second;
    }
    return 1 + static_cast<std::uint32_t>(std::lround(std::clamp(*q / out_.quality_step, 0.0, quality_steps)));
  }

 private:
  [[nodiscard]] std::optional<double> height_of_right_prism(const CellFace& face, std::int64_t c, double quality) const {
    const CellMesh::Cell cell = mesh_.cell(c);
    if (face.size() != 3 || cell.kind != mesh::CellKind::wedge) return {};
    std::array<double, 3> sides{};
    double height = 0, beta = 0, half = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      sides[i] = distance(mesh_.node_m(face.nodes[i]), mesh_.node_m(face.nodes[(i + 1) % 3]));
      height += distance(mesh_.node_m(cell.corners[i]), mesh_.node_m(cell.corners[i + 3])) / 3;
      beta += sides[i] * sides[i];
      half += sides[i] / 2;
    }
    const double squared = half * (half - sides[0]) * (half - sides[1]) * (half - sides[2]);
    constexpr double good_enough = 1e-6;
    const bool is_right =
        std::abs(layering::prism_quality(std::sqrt(std::max(0.0, squared)), beta, height) - quality) < good_enough;
    return is_right ? std::optional(height) : std::nullopt;
  }
  const CellMesh& mesh_;
  PackedCells& out_;
  std::map<double, std::uint32_t> heights_;
};

void put_cells(PackedCells& out, const CellMesh& mesh) {
  const Films films(mesh);
  std::map<std::array<std::int32_t, 5>, std::uint32_t> ids;
  std::vector<std::uint32_t> sides, quality, other_quality;
  std::vector<std::int32_t> cells, others;
  QualityCode coded(mesh, out);
  for (const CellFace& face : mesh.faces()) {
    const std::array<std::int32_t, 5> side{face.group, face.neighbour_group, face.tag, films.behind(face.cell),
                                           face.neighbour < 0 ? -1 : films.behind(face.neighbour)};
    const auto [found, is_new] = ids.try_emplace(side, static_cast<std::uint32_t>(out.sides.size()));
    if (is_new) out.sides.push_back(side);
    sides.push_back(found->second);
    cells.push_back(static_cast<std::int32_t>(face.cell));
    quality.push_back(coded(face, face.cell));
    if (face.neighbour < 0) continue;
    others.push_back(static_cast<std::int32_t>(face.neighbour));
    other_quality.push_back(coded(face, face.neighbour));
  }
  out.put("side", sides);
  out.put_differences("cell", cells);
  out.put_differences("other", others);
  out.put("quality", quality);
  out.put("other_quality", other_quality);
}

}  // namespace

PackedCells pack(const CellMesh& mesh) {
  require_room(mesh);
  PackedCells out;
  out.quality_step = layering::max_prism_quality / quality_steps;
  put_nodes(out, mesh, put_corners(out, mesh));
  put_cells(out, mesh);
  return out;
}

}  // namespace pcbmesh::view
