// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/mesh/prism_source.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/mesh/group_names.hpp"

namespace pcbmesh::mesh {
namespace {

constexpr std::size_t triangles_at_once = 512, triangles_ahead = 24;

void prefetch(const void* address) {
#ifdef __GNUC__
  __builtin_prefetch(address);
#endif
}

std::size_t index(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

template <class Items>
auto items_with_tag(const Items& items, std::int32_t tag_index) {
  return std::ranges::equal_range(items, tag_index, {}, [](const auto& item) { return item.tag; });
}

}  // namespace

/// Fixed buffer of rows that is handed on whenever it is full.
class PrismSource::Rows {
 public:
  Rows(int width, const VisitNodes& visit) : width_(static_cast<std::size_t>(width)), visit_(visit), buffer_(chunk * width_) {}
  /// Room for up to `wanted` rows; at least one.
  std::span<std::int64_t> room(std::size_t wanted) {
    if (used_ == chunk) flush();
    return std::span(buffer_).subspan(used_ * width_, std::min(wanted, chunk - used_) * width_);
  }
  void advance(std::size_t rows) {
    used_ += rows;
    total_ += static_cast<std::int64_t>(rows);
  }
  void flush() {
    if (used_ > 0) visit_(std::span<const std::int64_t>(buffer_).first(used_ * width_));
    used_ = 0;
  }
  [[nodiscard]] std::int64_t total() const { return total_; }

 private:
  std::size_t width_;
  const VisitNodes& visit_;
  std::vector<std::int64_t> buffer_;
  std::size_t used_ = 0;
  std::int64_t total_ = 0;
};

PrismSource::PrismSource(const PrismMesh& mesh, PrismQuality quality, std::size_t cache_bytes)
    : mesh_(mesh), quality_(std::move(quality)) {
  num_nodes_ = mesh.num_nodes();
  layers_.assign(mesh.layers().begin(), mesh.layers().end());
  nets_.assign(mesh.nets().begin(), mesh.nets().end());
  materials_.assign(mesh.materials().begin(), mesh.materials().end());
  survey_faces();
  survey_volumes();
  const auto triangles = static_cast<std::size_t>(mesh.planar().num_triangles());
  max_cached_ = std::max<std::size_t>(2, cache_bytes / (sizeof(std::int32_t) * std::max<std::size_t>(triangles, 1)));
}

std::int32_t PrismSource::tag_index_of(const ElementBlock& block) const {
  // Face groups stand before volume groups, each in the order of its tags.
  return dimension_of(block.kind) == 2 ? block.group : block.group - static_cast<std::int32_t>(mesh_.face_tags().size());
}

void PrismSource::survey_faces() {
  std::vector<std::string> names;
  for (const FaceTag& tag : mesh_.face_tags()) names.push_back(tag.name);
  names = group_names(names);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const FaceTag& tag = mesh_.face_tags()[i];
    const auto tag_index = static_cast<std::int32_t>(i), group = static_cast<std::int32_t>(groups_.size());
    const auto num_triangles = static_cast<std::int64_t>(items_with_tag(mesh_.caps(), tag_index).size());
    std::int64_t num_quads = 0;
    for (const Wall& wall : items_with_tag(mesh_.walls(), tag_index))
      num_quads += mesh_.plan().first_sublayer(wall.slab + 1) - mesh_.plan().first_sublayer(wall.slab);
    groups_.push_back({.dimension = 2,
                       .tag = tag.id,
                       .name = names[i],
                       .num_elements = num_triangles + num_quads,
                       .net = tag.net,
                       .is_inner = tag.is_inner});
    if (num_triangles > 0) blocks_.push_back({ElementKind::triangle, group, tag.id, num_triangles});
    if (num_quads > 0) blocks_.push_back({ElementKind::quadrangle, group, tag.id, num_quads});
  }
}

template <class Visit>
void PrismSource::visit_columns(Visit&& visit) const {
  for (std::int32_t slab = 0; slab < mesh_.plan().num_slabs(); ++slab)
    for (std::size_t region = 0; region < any_triangle_.size(); ++region) {
      const std::int32_t triangle = any_triangle_[region], tag = triangle < 0 ? -1 : mesh_.tag_of(slab, triangle);
      if (tag >= 0) visit(slab, region, tag);
    }
}

void PrismSource::survey_volumes() {
  const PlanarMesh& planar = mesh_.planar();
  any_triangle_.assign(index(planar.num_regions()), -1);
  for (std::int32_t t = 0; t < planar.num_triangles(); ++t) any_triangle_[index(planar.regions()[index(t)])] = t;
  slabs_of_tag_.resize(mesh_.volume_tags().size());
  visit_columns([&](std::int32_t slab, std::size_t, std::int32_t tag) {
    std::vector<std::int32_t>& slabs = slabs_of_tag_[index(tag)];
    if (slabs.empty() || slabs.back() != slab) slabs.push_back(slab);
  });
  std::vector<std::string> names;
  for (const VolumeTag& tag : mesh_.volume_tags()) names.push_back(tag.name);
  names = group_names(names);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const VolumeTag& tag = mesh_.volume_tags()[i];
    const auto group = static_cast<std::int32_t>(groups_.size());
    groups_.push_back({.dimension = 3,
                       .tag = tag.id,
                       .name = names[i],
                       .num_elements = tag.num_prisms,
                       .layer = tag.layer,
                       .material = tag.material,
                       .net = tag.net});
    if (tag.num_prisms > 0) blocks_.push_back({ElementKind::wedge, group, tag.id, tag.num_prisms});
  }
}

void PrismSource::survey_volume_boxes() {
  const PlanarMesh& planar = mesh_.planar();
  std::vector<Box> of_region(any_triangle_.size());
  for (std::int32_t t = 0; t < planar.num_triangles(); ++t)
    for (const std::int32_t v : planar.triangles()[index(t)])
      of_region[index(planar.regions()[index(t)])].add(planar.points_m()[index(v)]);
  volume_boxes_.assign(mesh_.volume_tags().size(), {});
  visit_columns([&](std::int32_t, std::size_t region, std::int32_t tag) {
    volume_boxes_[index(tag)].add(of_region[region].min);
    volume_boxes_[index(tag)].add(of_region[region].max);
  });
}

Extent PrismSource::extent_of(std::size_t group) {
  const auto points = mesh_.planar().points_m();
  const auto triangles = mesh_.planar().triangles();
  const LayerPlan& plan = mesh_.plan();
  Box box;
  std::int32_t lowest = plan.num_sublayers() + 1, highest = -1;  // levels
  const auto add_levels = [&](std::int32_t low, std::int32_t high) {
    lowest = std::min(lowest, low);
    highest = std::max(highest, high);
  };
  const std::size_t num_faces = mesh_.face_tags().size();
  if (group < num_faces) {
    for (const Cap& cap : items_with_tag(mesh_.caps(), static_cast<std::int32_t>(group))) {
      for (const std::int32_t v : triangles[index(cap.triangle)]) box.add(points[index(v)]);
      add_levels(cap.level, cap.level);
    }
    for (const Wall& wall : items_with_tag(mesh_.walls(), static_cast<std::int32_t>(group))) {
      box.add(points[index(wall.a)]);
      box.add(points[index(wall.b)]);
      add_levels(plan.first_sublayer(wall.slab), plan.first_sublayer(wall.slab + 1));
    }
  } else {
    if (volume_boxes_.empty()) survey_volume_boxes();
    box = volume_boxes_[group - num_faces];
    for (const std::int32_t slab : slabs_of_tag_[group - num_faces])
      add_levels(plan.first_sublayer(slab), plan.first_sublayer(slab + 1));
  }
  if (highest < 0) return {};
  return {{box.min[0], box.min[1], plan.z_m()[index(lowest)]}, {box.max[0], box.max[1], plan.z_m()[index(highest)]}};
}

void PrismSource::visit(std::size_t block, const VisitNodes& visit) {
  const ElementBlock& chosen = blocks_.at(block);
  Rows rows(nodes_of(chosen.kind), visit);
  const std::int32_t tag_index = tag_index_of(chosen);
  if (chosen.kind == ElementKind::triangle)
    visit_caps(tag_index, rows);
  else if (chosen.kind == ElementKind::quadrangle)
    visit_walls(tag_index, rows);
  else
    visit_wedges(tag_index, rows);
  rows.flush();
  // Counts went into the file before the rows: a mesh whose tag table lies must not become a file that lies.
  PCBMESH_ASSERT(rows.total() == chosen.count);
}

void PrismSource::visit_caps(std::int32_t tag_index, Rows& rows) {
  const auto corners = mesh_.planar().triangles();
  const auto caps = items_with_tag(mesh_.caps(), tag_index);
  for (auto cap = caps.begin(); cap != caps.end();) {
    const std::int32_t level = cap->level;
    const std::int64_t first = mesh_.first_node_of_level(level);
    const std::span<const std::int32_t> ranks = ranks_of(level);
    const auto id = [&](std::int32_t v) { return first + (ranks.empty() ? v : ranks[index(v)]); };
    for (; cap != caps.end() && cap->level == level; ++cap) {
      auto [a, b, c] = corners[index(cap->triangle)];
      if (!cap->up) std::swap(b, c);
      const auto out = rows.room(1);
      out[0] = id(a);
      out[1] = id(b);
      out[2] = id(c);
      rows.advance(1);
    }
  }
}

void PrismSource::visit_walls(std::int32_t tag_index, Rows& rows) const {
  for (const Wall& wall : items_with_tag(mesh_.walls(), tag_index)) {
    const std::int32_t last = mesh_.plan().first_sublayer(wall.slab + 1);
    for (std::int32_t k = mesh_.plan().first_sublayer(wall.slab); k < last; ++k) {
      const auto out = rows.room(1);
      out[0] = mesh_.node_id(k, wall.a);
      out[1] = mesh_.node_id(k, wall.b);
      out[2] = mesh_.node_id(k + 1, wall.b);
      out[3] = mesh_.node_id(k + 1, wall.a);
      rows.advance(1);
    }
  }
}

template <class Visit>
void PrismSource::visit_pieces(std::int32_t tag_index, Visit&& visit) {
  for (const std::int32_t slab : slabs_of_tag_[index(tag_index)]) {
    auto triangles = triangles_of(slab, tag_index);
    // A few triangles through all sub-layers, then the next few: the plane is fetched once per slab, not once per sub-layer.
    while (!triangles.empty()) {
      const auto few = triangles.first(std::min(triangles.size(), triangles_at_once));
      triangles = triangles.subspan(few.size());
      visit(slab, few);
    }
  }
}

void PrismSource::visit_wedges(std::int32_t tag_index, Rows& rows) {
  const auto corners = mesh_.planar().triangles();
  std::array<std::vector<std::int32_t>, 3> tables;
  visit_pieces(tag_index, [&](std::int32_t slab, std::span<const std::int32_t> few) {
    const std::int32_t begin = mesh_.plan().first_sublayer(slab), end = mesh_.plan().first_sublayer(slab + 1);
    // Corners are looked up once per slab; every sub-layer then adds its first ids to them. Levels strictly inside a slab hold
    // the same vertices, and levels without gaps number their nodes like the plane does.
    std::span<const std::int32_t> known_ranks, known;
    const auto look_up = [&](std::int32_t level, std::vector<std::int32_t>& out) {
      const std::span<const std::int32_t> ranks = ranks_of(level);
      if (!known.empty() && ranks.empty() && known_ranks.empty()) return known;
      out.resize(3 * few.size());
      std::int32_t* to = out.data();
      for (std::size_t i = 0; i < few.size(); ++i) {
        // A group's triangles lie scattered over the plane: without a word ahead every piece of it is waited for.
        prefetch(&corners[index(few[std::min(i + triangles_ahead, few.size() - 1)])]);
        for (const std::int32_t v : corners[index(few[i])]) *to++ = ranks.empty() ? v : ranks[index(v)];
      }
      known_ranks = ranks;
      return known = out;
    };
    const std::span<const std::int32_t> bottom = look_up(begin, tables[0]);
    const std::span<const std::int32_t> inside = end - begin > 1 ? look_up(begin + 1, tables[1]) : bottom;
    const std::span<const std::int32_t> top = look_up(end, tables[2]);
    for (std::int32_t k = begin; k < end; ++k)
      visit_sublayer(k, k == begin ? bottom : inside, k + 1 == end ? top : inside, rows);
  });
}

void PrismSource::visit_sublayer(std::int32_t sublayer, std::span<const std::int32_t> low, std::span<const std::int32_t> high,
                                 Rows& rows) const {
  const std::int64_t first_low = mesh_.first_node_of_level(sublayer), first_high = mesh_.first_node_of_level(sublayer + 1);
  for (std::size_t at = 0; at < low.size();) {
    const auto out = rows.room((low.size() - at) / 3);
    std::int64_t* to = out.data();
    const std::size_t count = out.size() / 6, end = at + 3 * count;
    for (; at < end; at += 3, to += 6)
      for (std::size_t i = 0; i < 3; ++i) {
        to[i] = first_low + low[at + i];
        to[3 + i] = first_high + high[at + i];
      }
    rows.advance(count);
  }
}

void PrismSource::survey_shapes() {
  const PlanarMesh& planar = mesh_.planar();
  shapes_.reserve(index(planar.num_triangles()));
  for (std::int32_t t = 0; t < planar.num_triangles(); ++t) {
    const std::array<double, 3> squared = planar.squared_edges_m2(t);
    shapes_.push_back({planar.area_m2(t), squared[0] + squared[1] + squared[2]});
  }
}

void PrismSource::visit_field(std::size_t block, CellField field, const VisitValues& visit) {
  PCBMESH_ASSERT(has_field(field) && dimension_of(blocks_.at(block).kind) == 3);
  const PlanarMesh& planar = mesh_.planar();
  std::vector<double> values;
  if (field == CellField::quality && shapes_.empty()) survey_shapes();
  std::vector<PrismBase> shapes;
  visit_pieces(tag_index_of(blocks_[block]), [&](std::int32_t slab, std::span<const std::int32_t> few) {
    values.resize(few.size());
    const auto ahead = [&](std::size_t i) { return index(few[std::min(i + triangles_ahead, few.size() - 1)]); };
    if (field == CellField::region)
      for (std::size_t i = 0; i < few.size(); ++i) {
        prefetch(&planar.regions()[ahead(i)]);
        values[i] = planar.regions()[index(few[i])];
      }
    shapes.resize(few.size());
    if (field == CellField::quality)
      for (std::size_t i = 0; i < few.size(); ++i) {
        prefetch(&shapes_[ahead(i)]);
        shapes[i] = shapes_[index(few[i])];
      }
    double last_height = -1;
    for (std::int32_t k = mesh_.plan().first_sublayer(slab); k < mesh_.plan().first_sublayer(slab + 1); ++k) {
      const double height = mesh_.plan().height_m(k);
      if (field == CellField::sublayer) std::ranges::fill(values, k);
      if (field == CellField::quality && height != last_height)  // most slabs are cut evenly
        quality_(shapes, height, values);
      last_height = height;
      for (std::span<const double> rest = values; !rest.empty(); rest = rest.subspan(std::min(chunk, rest.size())))
        visit(rest.first(std::min(chunk, rest.size())));
    }
  });
}

std::span<const std::int32_t> PrismSource::ranks_of(std::int32_t level) {
  const std::int32_t num_points = mesh_.planar().num_points();
  if (mesh_.num_nodes_of_level(level) == num_points) return {};
  auto entry = std::ranges::find(level_ranks_, level, &LevelRanks::level);
  if (entry == level_ranks_.end()) {
    entry = std::ranges::min_element(level_ranks_, {}, &LevelRanks::last_use);
    entry->level = level;
    entry->ranks.resize(index(num_points));
    // Ids ascend with the vertex: counting is cheaper than asking for each.
    std::int32_t rank = 0;
    for (std::int32_t v = 0; v < num_points; ++v) entry->ranks[index(v)] = mesh_.has_node(level, v) ? rank++ : -1;
  }
  entry->last_use = ++clock_;
  return entry->ranks;
}

std::span<const std::int32_t> PrismSource::triangles_of(std::int32_t slab, std::int32_t tag_index) {
  auto entry = std::ranges::find(cache_, slab, &SlabGroups::slab);
  if (entry == cache_.end()) {
    if (cache_.size() < max_cached_) {
      entry = cache_.insert(cache_.end(), SlabGroups{});
    } else {
      entry = std::ranges::min_element(cache_, {}, &SlabGroups::last_use);
    }
    entry->slab = slab;
    mesh_.group_triangles(slab, entry->offsets, entry->triangles);
  }
  entry->last_use = ++clock_;
  const auto first = index(entry->offsets[index(tag_index)]), last = index(entry->offsets[index(tag_index) + 1]);
  return std::span<const std::int32_t>(entry->triangles).subspan(first, last - first);
}

}  // namespace pcbmesh::mesh
