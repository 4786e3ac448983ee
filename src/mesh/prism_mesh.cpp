// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/mesh/prism_mesh.hpp"

#include <algorithm>
#include <bit>
#include <map>
#include <utility>

#include "pcbmesh/base/error.hpp"
#include "src/mesh/prism_mesh_checks.hpp"

namespace pcbmesh::mesh {
namespace {

constexpr std::int64_t bits_per_word = 64;

std::size_t index(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

/// std::popcount is a library call on a baseline x86-64; this is a dozen instructions that inline everywhere.
std::int32_t count_bits(std::uint64_t x) {
  x -= (x >> 1) & 0x5555555555555555U;
  x = (x & 0x3333333333333333U) + ((x >> 2) & 0x3333333333333333U);
  x = (x + (x >> 4)) & 0x0f0f0f0f0f0f0f0fU;
  return static_cast<std::int32_t>((x * 0x0101010101010101U) >> 56);
}

/// Last of the ascending block starts that is <= id, as a block index: empty blocks are passed over.
std::int32_t block_of(const std::vector<std::int64_t>& starts, std::int64_t id) {
  return static_cast<std::int32_t>(std::upper_bound(starts.begin(), starts.end(), id) - starts.begin()) - 1;
}

}  // namespace

std::string_view name_of(FaceTagKind kind) {
  constexpr std::string_view names[] = {"outer", "conductor", "sheet", "port", "wave_port", "interface"};
  return names[static_cast<std::size_t>(kind)];
}

std::string_view name_of(PortKind kind) {
  constexpr std::string_view names[] = {"lumped", "wave", "coaxial"};
  return names[static_cast<std::size_t>(kind)];
}

std::string_view name_of(BoundaryCondition condition) {
  constexpr std::string_view names[] = {"none", "absorbing", "pec", "pmc", "impedance", "conductor", "port", "periodic"};
  return names[static_cast<std::size_t>(condition)];
}

std::string axes_text(std::uint8_t stretched) {
  std::string text;
  for (int axis = 0; axis < 3; ++axis)
    if (((stretched >> axis) & 1) != 0) text += static_cast<char>('x' + axis);
  return text;
}

inline bool PrismMesh::Mask::has(std::int32_t i) const {
  return is_full() || ((words[index(i) / 64] >> (index(i) % 64)) & 1U) != 0;
}

inline std::int32_t PrismMesh::Mask::rank(std::int32_t i) const {
  if (is_full()) return i;
  const std::uint64_t before = (std::uint64_t{1} << (index(i) % 64)) - 1;
  return ranks[index(i) / 64] + count_bits(words[index(i) / 64] & before);
}

template <class Visit>
void PrismMesh::Mask::visit(std::int64_t first, std::int64_t count, Visit&& visit) const {
  if (is_full()) {
    const auto last = static_cast<std::int32_t>(first + count);
    for (auto i = static_cast<std::int32_t>(first); i < last; ++i) visit(i);
    return;
  }
  auto word = static_cast<std::size_t>(std::upper_bound(ranks.begin(), ranks.end(), first) - ranks.begin()) - 1;
  std::uint64_t bits = words[word];
  for (std::int64_t skip = first - ranks[word]; skip > 0; --skip) bits &= bits - 1;
  while (count > 0) {
    const auto offset = static_cast<std::int32_t>(static_cast<std::int64_t>(word) * bits_per_word);
    for (; bits != 0 && count > 0; bits &= bits - 1, --count) visit(offset + std::countr_zero(bits));
    if (count > 0) bits = words[++word];
  }
}

PrismMesh::Mask PrismMesh::mask_of(std::span<const char> members) {
  Mask mask;
  mask.size = static_cast<std::int32_t>(std::count_if(members.begin(), members.end(), [](char is_in) { return is_in != 0; }));
  if (static_cast<std::size_t>(mask.size) == members.size()) return mask;
  const std::size_t num_words = (members.size() + 63) / 64;
  mask.words.assign(num_words, 0);
  mask.ranks.assign(num_words, 0);
  for (std::size_t i = 0; i < members.size(); ++i) {
    if (members[i] != 0) mask.words[i / 64] |= std::uint64_t{1} << (i % 64);
  }
  for (std::size_t w = 1; w < num_words; ++w) mask.ranks[w] = mask.ranks[w - 1] + count_bits(mask.words[w - 1]);
  return mask;
}

void PrismMesh::make_masks() {
  const PlanarMesh& planar = parts_->planar;
  const LayerPlan& plan = parts_->plan;
  const auto num_slabs = index(plan.num_slabs()), num_regions = index(planar.num_regions());
  // Slabs with the same void regions share one pattern, and with it their masks. Pattern 0: nothing, as outside the stack.
  std::map<std::vector<char>, std::int32_t> pattern_ids{{std::vector<char>(num_regions, 0), 0}};
  std::vector<std::vector<char>> patterns{std::vector<char>(num_regions, 0)};
  std::vector<std::int32_t> pattern_of_slab(num_slabs);
  for (std::size_t s = 0; s < num_slabs; ++s) {
    std::vector<char> pattern(num_regions);
    for (std::size_t r = 0; r < num_regions; ++r) pattern[r] = parts_->column_tags[r * num_slabs + s] >= 0 ? 1 : 0;
    const auto [found, is_new] = pattern_ids.try_emplace(pattern, static_cast<std::int32_t>(patterns.size()));
    if (is_new) patterns.push_back(std::move(pattern));
    pattern_of_slab[s] = found->second;
  }
  auto masks = std::make_shared<std::vector<Mask>>();
  std::vector<char> members;
  std::map<std::int32_t, std::int32_t> triangle_masks;
  const auto triangle_mask = [&](std::int32_t pattern) {
    const auto [found, is_new] = triangle_masks.try_emplace(pattern, static_cast<std::int32_t>(masks->size()));
    if (is_new) {
      members.assign(planar.triangles().size(), 0);
      for (std::size_t t = 0; t < members.size(); ++t) members[t] = patterns[index(pattern)][index(planar.regions()[t])];
      masks->push_back(mask_of(members));
    }
    return found->second;
  };
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> vertex_masks;
  const auto vertex_mask = [&](std::int32_t below, std::int32_t above) {
    const std::pair<std::int32_t, std::int32_t> pair = std::minmax(below, above);
    const auto [found, is_new] = vertex_masks.try_emplace(pair, static_cast<std::int32_t>(masks->size()));
    if (is_new) {
      members.assign(planar.points_m().size(), 0);
      for (std::size_t t = 0; t < planar.triangles().size(); ++t) {
        const auto region = index(planar.regions()[t]);
        if (patterns[index(below)][region] == 0 && patterns[index(above)][region] == 0) continue;
        for (std::int32_t v : planar.triangles()[t]) members[index(v)] = 1;
      }
      masks->push_back(mask_of(members));
    }
    return found->second;
  };
  const auto slab_of = plan.slab_of_sublayer();
  for (std::int32_t k = 0; k < plan.num_levels(); ++k) {
    const std::int32_t below = k == 0 ? 0 : pattern_of_slab[index(slab_of[index(k - 1)])];
    const std::int32_t above = k == plan.num_sublayers() ? 0 : pattern_of_slab[index(slab_of[index(k)])];
    mask_of_level_.push_back(vertex_mask(below, above));
    if (k < plan.num_sublayers()) mask_of_sublayer_.push_back(triangle_mask(above));
  }
  masks_ = std::move(masks);
}

PrismMesh PrismMesh::from_parts(PrismMeshParts parts) {
  check_tables(parts);
  check_boundary(parts);
  if (parts.net_pieces.empty()) parts.net_pieces.assign(parts.nets.size(), -1);
  PrismMesh mesh;
  mesh.parts_ = std::make_shared<const PrismMeshParts>(std::move(parts));
  mesh.make_masks();
  mesh.first_node_.push_back(0);
  for (std::int32_t mask : mesh.mask_of_level_) {
    mesh.first_node_.push_back(mesh.first_node_.back() + (*mesh.masks_)[index(mask)].size);
  }
  mesh.first_prism_.push_back(0);
  for (std::int32_t mask : mesh.mask_of_sublayer_) {
    mesh.first_prism_.push_back(mesh.first_prism_.back() + (*mesh.masks_)[index(mask)].size);
  }
  mesh.num_nodes_ = mesh.first_node_.back();
  mesh.num_prisms_ = mesh.first_prism_.back();
  return mesh;
}

const PrismMesh::Mask& PrismMesh::level_mask(std::int32_t level) const {
  return (*masks_)[index(mask_of_level_[index(level)])];
}

const PrismMesh::Mask& PrismMesh::sublayer_mask(std::int32_t sublayer) const {
  return (*masks_)[index(mask_of_sublayer_[index(sublayer)])];
}

std::int64_t PrismMesh::num_tagged_triangles() const {
  return static_cast<std::int64_t>(parts_->caps.size());
}

std::int64_t PrismMesh::num_tagged_quads() const {
  std::int64_t quads = 0;
  for (const Wall& wall : parts_->walls) {
    quads += parts_->plan.first_sublayer(wall.slab + 1) - parts_->plan.first_sublayer(wall.slab);
  }
  return quads;
}

std::int32_t PrismMesh::tag_of(std::int32_t slab, std::int32_t triangle) const {
  const auto region = index(parts_->planar.regions()[index(triangle)]);
  return parts_->column_tags[region * index(parts_->plan.num_slabs()) + index(slab)];
}

std::int64_t PrismMesh::node_id(std::int32_t level, std::int32_t vertex) const {
  return first_node_[index(level)] + level_mask(level).rank(vertex);
}

std::int64_t PrismMesh::prism_id(std::int32_t sublayer, std::int32_t triangle) const {
  return first_prism_[index(sublayer)] + sublayer_mask(sublayer).rank(triangle);
}

bool PrismMesh::has_node(std::int32_t level, std::int32_t vertex) const {
  return level_mask(level).has(vertex);
}

std::int64_t PrismMesh::num_nodes_of_level(std::int32_t level) const {
  return first_node_[index(level) + 1] - first_node_[index(level)];
}

std::int64_t PrismMesh::first_node_of_level(std::int32_t level) const {
  return first_node_[index(level)];
}

std::int64_t PrismMesh::num_prisms_of_sublayer(std::int32_t sublayer) const {
  return first_prism_[index(sublayer) + 1] - first_prism_[index(sublayer)];
}

std::int64_t PrismMesh::first_prism_of_sublayer(std::int32_t sublayer) const {
  return first_prism_[index(sublayer)];
}

void PrismMesh::fill_nodes(std::int64_t first, std::span<std::array<double, 3>> out) const {
  const auto size = static_cast<std::int64_t>(out.size());
  PCBMESH_ASSERT(first >= 0 && size <= num_nodes_ - first);
  const auto points = parts_->planar.points_m();
  const auto z = parts_->plan.z_m();
  std::array<double, 3>* to = out.data();
  for (std::int64_t done = 0; done < size;) {
    const std::int32_t level = block_of(first_node_, first + done);
    const std::int64_t rank = first + done - first_node_[index(level)];
    const std::int64_t count = std::min(size - done, num_nodes_of_level(level) - rank);
    const double height = z[index(level)];
    level_mask(level).visit(rank, count, [&](std::int32_t v) { *to++ = {points[index(v)][0], points[index(v)][1], height}; });
    done += count;
  }
}

void PrismMesh::fill_sublayer(std::int32_t sublayer, std::int64_t rank, std::span<std::array<std::int64_t, 6>> out) const {
  const auto triangles = parts_->planar.triangles();
  const Mask &present = sublayer_mask(sublayer), &lower = level_mask(sublayer), &upper = level_mask(sublayer + 1);
  const std::int64_t low = first_node_[index(sublayer)], high = first_node_[index(sublayer) + 1];
  std::array<std::int64_t, 6>* to = out.data();
  const auto count = static_cast<std::int64_t>(out.size());
  if (&lower == &upper) {  // inside a slab, or nothing void: one rank serves both levels
    const std::int64_t step = high - low;
    const auto write = [&](std::int64_t a, std::int64_t b, std::int64_t c) { *to++ = {a, b, c, a + step, b + step, c + step}; };
    if (lower.is_full()) {
      present.visit(rank, count, [&](std::int32_t t) {
        const auto& [a, b, c] = triangles[index(t)];
        write(low + a, low + b, low + c);
      });
    } else {
      present.visit(rank, count, [&](std::int32_t t) {
        const auto& [a, b, c] = triangles[index(t)];
        write(low + lower.rank(a), low + lower.rank(b), low + lower.rank(c));
      });
    }
    return;
  }
  present.visit(rank, count, [&](std::int32_t t) {
    const auto& [a, b, c] = triangles[index(t)];
    *to++ = {low + lower.rank(a),  low + lower.rank(b),  low + lower.rank(c),
             high + upper.rank(a), high + upper.rank(b), high + upper.rank(c)};
  });
}

void PrismMesh::fill_prisms(std::int64_t first, std::span<std::array<std::int64_t, 6>> out,
                            std::span<std::int32_t> tags) const {
  const auto size = static_cast<std::int64_t>(out.size());
  PCBMESH_ASSERT(first >= 0 && size <= num_prisms_ - first && (tags.empty() || tags.size() == out.size()));
  const auto num_slabs = index(parts_->plan.num_slabs());
  const auto regions = parts_->planar.regions();
  std::int32_t* tag = tags.data();
  for (std::int64_t done = 0; done < size;) {
    const std::int32_t sublayer = block_of(first_prism_, first + done);
    const std::int64_t rank = first + done - first_prism_[index(sublayer)];
    const std::int64_t count = std::min(size - done, num_prisms_of_sublayer(sublayer) - rank);
    fill_sublayer(sublayer, rank, out.subspan(static_cast<std::size_t>(done), static_cast<std::size_t>(count)));
    if (!tags.empty()) {
      const std::int32_t* column = parts_->column_tags.data() + parts_->plan.slab_of_sublayer()[index(sublayer)];
      sublayer_mask(sublayer).visit(rank, count,
                                    [&](std::int32_t t) { *tag++ = column[index(regions[index(t)]) * num_slabs]; });
    }
    done += count;
  }
}

void PrismMesh::group_triangles(std::int32_t slab, std::vector<std::int32_t>& offsets,
                                std::vector<std::int32_t>& triangles) const {
  offsets.assign(parts_->volume_tags.size() + 1, 0);
  const auto regions = parts_->planar.regions();
  const std::size_t num_slabs = index(parts_->plan.num_slabs());
  std::vector<std::int32_t> tags(index(parts_->planar.num_regions()));
  for (std::size_t region = 0; region < tags.size(); ++region)
    tags[region] = parts_->column_tags[region * num_slabs + index(slab)];
  for (const std::int32_t region : regions) {
    if (const std::int32_t tag = tags[index(region)]; tag >= 0) ++offsets[index(tag) + 1];
  }
  for (std::size_t i = 1; i < offsets.size(); ++i) offsets[i] += offsets[i - 1];
  triangles.resize(index(offsets.back()));
  // Filling moves each start to its end; shifting by one afterwards saves a second array.
  for (std::int32_t t = 0; t < parts_->planar.num_triangles(); ++t) {
    const std::int32_t tag = tags[index(regions[index(t)])];
    if (tag >= 0) triangles[index(offsets[index(tag)]++)] = t;
  }
  for (std::size_t i = offsets.size() - 1; i > 0; --i) offsets[i] = offsets[i - 1];
  offsets[0] = 0;
}

}  // namespace pcbmesh::mesh
