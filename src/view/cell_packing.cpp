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
  constexpr const char* names[] = {"x", "y", "z"};
  for (std::size_t k = 0; k < 3; ++k) {
    std::vector<std::int32_t> values;
    for (const std::int64_t node : used)
      values.push_back(static_cast<std::int32_t>(std::lround((mesh.node_m(node)[k] - low[k]) / out.step_m[k == 2 ? 1 : 0])));
    out.put_differences(names[k], values);
  }
}

void put_cells(PackedCells& out, const CellMesh& mesh) {
  const Films films(mesh);
  std::map<std::array<std::int32_t, 5>, std::uint32_t> ids;
  std::vector<std::uint32_t> sides, quality, other_quality;
  std::vector<std::int32_t> cells, others;
  const auto coded = [&](std::int64_t cell) -> std::uint32_t {
    const std::optional<double> q = cell < 0 ? std::nullopt : mesh.quality_of(cell);
    return q ? 1 + static_cast<std::uint32_t>(std::lround(std::clamp(*q / out.quality_step, 0.0, quality_steps))) : 0;
  };
  for (const CellFace& face : mesh.faces()) {
    const std::array<std::int32_t, 5> side{face.group, face.neighbour_group, face.tag, films.behind(face.cell),
                                           face.neighbour < 0 ? -1 : films.behind(face.neighbour)};
    const auto [found, is_new] = ids.try_emplace(side, static_cast<std::uint32_t>(out.sides.size()));
    if (is_new) out.sides.push_back(side);
    sides.push_back(found->second);
    cells.push_back(static_cast<std::int32_t>(face.cell));
    quality.push_back(coded(face.cell));
    if (face.neighbour < 0) continue;
    others.push_back(static_cast<std::int32_t>(face.neighbour));
    other_quality.push_back(coded(face.neighbour));
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
