// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/view/packing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>

namespace pcbmesh::view {
namespace {

std::size_t index(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

void put_points(PackedMesh& out, const mesh::PlanarMesh& planar) {
  double min_x = std::numeric_limits<double>::max(), min_y = min_x, max_x = -min_x, max_y = -min_x;
  for (const auto& p : planar.points_m()) {
    min_x = std::min(min_x, p[0]);
    max_x = std::max(max_x, p[0]);
    min_y = std::min(min_y, p[1]);
    max_y = std::max(max_y, p[1]);
  }
  out.x0_m = min_x;
  out.y0_m = min_y;
  out.step_m = std::max({max_x - min_x, max_y - min_y, 1e-12}) / grid_steps;
  std::vector<std::int32_t> x, y;
  for (const auto& p : planar.points_m()) {
    x.push_back(static_cast<std::int32_t>(std::lround((p[0] - min_x) / out.step_m)));
    y.push_back(static_cast<std::int32_t>(std::lround((p[1] - min_y) / out.step_m)));
  }
  out.put_differences("x", x);
  out.put_differences("y", y);
}

void put_triangles(PackedMesh& out, const mesh::PlanarMesh& planar) {
  std::vector<std::int32_t> first;
  std::vector<std::uint32_t> second, third;
  for (const auto& t : planar.triangles()) {
    first.push_back(t[0]);
    second.push_back(zigzag(t[1] - t[0]));
    third.push_back(zigzag(t[2] - t[0]));
  }
  out.put_differences("corner0", first);
  out.put("corner1", second);
  out.put("corner2", third);
}

void put_columns(PackedMesh& out, const mesh::PrismMesh& mesh) {
  const std::int32_t num_slabs = mesh.plan().num_slabs();
  std::map<std::vector<std::int32_t>, std::int32_t> ids;
  std::vector<std::int32_t> column_of_region(index(mesh.planar().num_regions()), -1);
  std::vector<std::uint32_t> columns;
  std::vector<std::int32_t> column(index(num_slabs));
  for (std::int32_t t = 0; t < mesh.planar().num_triangles(); ++t) {
    std::int32_t& id = column_of_region[index(mesh.planar().regions()[index(t)])];
    if (id < 0) {
      for (std::int32_t s = 0; s < num_slabs; ++s) column[index(s)] = mesh.tag_of(s, t);
      const auto [found, is_new] = ids.try_emplace(column, static_cast<std::int32_t>(out.columns.size()));
      if (is_new) out.columns.push_back(column);
      id = found->second;
    }
    columns.push_back(static_cast<std::uint32_t>(id));
  }
  out.put("column", columns);
}

void put_boundary(PackedMesh& out, const mesh::PrismMesh& mesh) {
  std::vector<std::uint32_t> tags, places;
  std::vector<std::int32_t> items;
  for (const mesh::Cap& cap : mesh.caps()) {
    tags.push_back(static_cast<std::uint32_t>(cap.tag));
    places.push_back(static_cast<std::uint32_t>(cap.level) * 2 + (cap.up ? 1 : 0));
    items.push_back(cap.triangle);
  }
  out.put("cap_tag", tags);
  out.put("cap_place", places);
  out.put_differences("cap_triangle", items);
  tags.clear();
  places.clear();
  items.clear();
  std::vector<std::uint32_t> ends;
  for (const mesh::Wall& wall : mesh.walls()) {
    tags.push_back(static_cast<std::uint32_t>(wall.tag));
    places.push_back(static_cast<std::uint32_t>(wall.slab));
    items.push_back(wall.a);
    ends.push_back(zigzag(wall.b - wall.a));
  }
  out.put("wall_tag", tags);
  out.put("wall_slab", places);
  out.put_differences("wall_a", items);
  out.put("wall_b", ends);
}

}  // namespace

/// Byte planes: equal high bytes lie side by side and pack to nearly nothing.
void PackedArrays::put(std::string name, std::span<const std::uint32_t> values) {
  std::uint32_t all = 0;
  for (const std::uint32_t v : values) all |= v;
  const int width = all > 0xffffff ? 4 : all > 0xffff ? 3 : all > 0xff ? 2 : 1;
  arrays.push_back({std::move(name), values.size(), width});
  for (int b = 0; b < width; ++b) {
    const std::size_t first = bytes.size();
    bytes.resize(first + values.size());
    char* to = bytes.data() + first;
    for (const std::uint32_t v : values) *to++ = static_cast<char>(v >> (8 * b) & 0xff);
  }
}

void PackedArrays::put_differences(std::string name, std::span<const std::int32_t> values) {
  std::vector<std::uint32_t> differences(values.size());
  std::int32_t last = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    differences[i] = zigzag(values[i] - last);
    last = values[i];
  }
  put(std::move(name) + "+", differences);
}

std::uint32_t zigzag(std::int32_t n) {
  return (static_cast<std::uint32_t>(n) << 1) ^ static_cast<std::uint32_t>(n >> 31);
}

PackedMesh pack(const mesh::PrismMesh& mesh) {
  PackedMesh out;
  put_points(out, mesh.planar());
  put_triangles(out, mesh.planar());
  put_columns(out, mesh);
  put_boundary(out, mesh);
  return out;
}

}  // namespace pcbmesh::view
