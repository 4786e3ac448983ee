// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/checks/face_matching.hpp"

#include <algorithm>
#include <limits>
#include <tuple>

#include "validation/checks/cell_shapes.hpp"
#include "validation/checks/height_growth.hpp"
#include "validation/checks/net_contacts.hpp"
#include "validation/checks/parallel.hpp"

namespace pcbmesh::validation::checks {
namespace {

/// A face as its owner sees it from outside, turned so that the smallest node comes first.
/// Exact: the whole key is compared, nothing is hashed.
template <class Index>
struct Entry {
  static constexpr Index no_node = std::numeric_limits<Index>::max();  ///< `opposite` of a triangle
  Index lowest, next, opposite, previous;
  Index id;  ///< cell << 3 | local face, or (num_cells + tagged face) << 3

  [[nodiscard]] bool is_same_face(const Entry& other) const {
    return opposite == other.opposite &&
           ((next == other.previous && previous == other.next) || (next == other.next && previous == other.previous));
  }
  [[nodiscard]] bool is_same_side(const Entry& other) const { return next == other.next && previous == other.previous; }
  [[nodiscard]] auto order() const { return std::tuple(std::min(next, previous), std::max(next, previous), opposite, id); }
};

template <class Index>
Entry<Index> triangle_entry(std::int64_t a, std::int64_t b, std::int64_t c, std::int64_t id) {
  const auto make = [&](std::int64_t x, std::int64_t y, std::int64_t z) {
    return Entry<Index>{static_cast<Index>(x), static_cast<Index>(y), Entry<Index>::no_node, static_cast<Index>(z),
                        static_cast<Index>(id)};
  };
  if (a <= b && a <= c) return make(a, b, c);
  return b <= c ? make(b, c, a) : make(c, a, b);
}

template <class Index>
Entry<Index> quadrangle_entry(std::int64_t a, std::int64_t b, std::int64_t c, std::int64_t d, std::int64_t id) {
  const auto make = [&](std::int64_t x, std::int64_t y, std::int64_t z, std::int64_t w) {
    return Entry<Index>{static_cast<Index>(x), static_cast<Index>(y), static_cast<Index>(z), static_cast<Index>(w),
                        static_cast<Index>(id)};
  };
  if (a <= b) {
    if (c <= d) return a <= c ? make(a, b, c, d) : make(c, d, a, b);
    return a <= d ? make(a, b, c, d) : make(d, a, b, c);
  }
  if (c <= d) return b <= c ? make(b, c, d, a) : make(c, d, a, b);
  return b <= d ? make(b, c, d, a) : make(d, a, b, c);
}

/// Calls use(entry) for the faces of cells [begin, end) of one block.
template <class Index, mesh::CellKind kind, class Use>
void scan_cells(const mesh::CellBlock& block, std::int64_t first_id, std::int64_t begin, std::int64_t end, Use&& use) {
  constexpr auto n = static_cast<std::size_t>(mesh::corners_of(kind));
  for (std::int64_t i = begin; i < end; ++i) {
    const std::int64_t* corners = block.corners.data() + static_cast<std::size_t>(i) * n;
    std::int64_t id = (first_id + i) << 3;
    for (const LocalFace& face : faces_of<kind>()) {
      const auto at = [&](std::size_t k) { return corners[face.corners[k]]; };
      use(face.num_corners == 3 ? triangle_entry<Index>(at(0), at(1), at(2), id)
                                : quadrangle_entry<Index>(at(0), at(1), at(2), at(3), id));
      ++id;
    }
  }
}

template <class Index, class Use>
void scan_faces(const mesh::FaceBlock& block, std::int64_t first_id, std::int64_t begin, std::int64_t end, Use&& use) {
  const bool triangle = block.kind == mesh::FaceKind::triangle;
  for (std::int64_t i = begin; i < end; ++i) {
    const std::int64_t* at = block.corners.data() + i * corners_of(block.kind);
    const std::int64_t id = (first_id + i) << 3;
    use(triangle ? triangle_entry<Index>(at[0], at[1], at[2], id) : quadrangle_entry<Index>(at[0], at[1], at[2], at[3], id));
  }
}

/// Matches the faces of one run of nodes after the other; one object serves all threads.
template <class Index>
class Matcher {
 public:
  Matcher(const Context& context, NetContacts* nets, HeightGrowth* growth) : context_(context), nets_(nets), growth_(growth) {
    const auto num_slots = static_cast<std::size_t>(context.face_tags.size());
    is_outer_slot_.assign(num_slots, 0);
    if (context.expectation != nullptr) {
      for (const auto& face : context.expectation->faces) {
        const int slot = context.face_tags.slot(face.tag);
        if (slot >= 0 && face.outer) is_outer_slot_[static_cast<std::size_t>(slot)] = 1;
      }
    }
    FaceMatch empty;
    empty.outer_of_tag.assign(num_slots, 0);
    empty.inner_of_tag.assign(num_slots, 0);
    of_worker_.assign(static_cast<std::size_t>(context.num_threads), empty);
    scratch_.resize(of_worker_.size());
  }

  FaceMatch run(const MatchOptions& options) {
    const std::int64_t num_cells = context_.num_cells(), num_items = num_cells + context_.num_faces();
    PartitionPlan plan;
    plan.num_threads = context_.num_threads;
    plan.num_items = num_items;
    // About ten faces start at a node: 4096 nodes keep a partition near a megabyte, the size of a core's own cache.
    shift_ = 12;
    plan.num_partitions = (context_.num_nodes() >> shift_) + 1;
    plan.max_entries_at_once = std::max(options.min_entries_at_once,
                                        options.bytes_per_cell * num_cells / static_cast<std::int64_t>(sizeof(Entry<Index>)));
    boundary_of_partition_.resize(static_cast<std::size_t>(plan.num_partitions));
    partition_entries<Entry<Index>>(
        plan,
        [&](std::int64_t first, std::int64_t last, auto&& emit) {
          scan(first, last, [&](const Entry<Index>& entry) { emit(static_cast<std::int64_t>(entry.lowest) >> shift_, entry); });
        },
        [&](int worker, std::int64_t partition, std::span<Entry<Index>> entries) { match(worker, partition, entries); });
    return gather();
  }

 private:
  template <class Use>
  void scan(std::int64_t first, std::int64_t last, Use&& use) const {
    for (std::size_t b = 0; b < context_.mesh.cells.size(); ++b) {
      const std::int64_t start = context_.first_cell[b];
      const std::int64_t begin = std::max(first, start), end = std::min(last, context_.first_cell[b + 1]);
      if (begin >= end) continue;
      with_kind(context_.mesh.cells[b].kind, [&]<mesh::CellKind kind>() {
        scan_cells<Index, kind>(context_.mesh.cells[b], start, begin - start, end - start, use);
      });
    }
    const std::int64_t num_cells = context_.num_cells();
    for (std::size_t b = 0; b < context_.mesh.faces.size(); ++b) {
      const std::int64_t start = num_cells + context_.first_face[b];
      const std::int64_t begin = std::max(first, start), end = std::min(last, num_cells + context_.first_face[b + 1]);
      if (begin < end) scan_faces<Index>(context_.mesh.faces[b], start, begin - start, end - start, use);
    }
  }

  /// Counting sort by smallest node, then the few faces of each node against each other.
  void match(int worker, std::int64_t partition, std::span<Entry<Index>> entries) {
    Scratch& scratch = scratch_[static_cast<std::size_t>(worker)];
    const std::int64_t first_node = partition << shift_;
    scratch.ends.assign((std::size_t{1} << shift_) + 1, 0);
    const auto node_of = [&](const Entry<Index>& entry) {
      return static_cast<std::size_t>(static_cast<std::int64_t>(entry.lowest) - first_node);
    };
    for (const Entry<Index>& entry : entries) ++scratch.ends[node_of(entry) + 1];
    for (std::size_t i = 1; i < scratch.ends.size(); ++i) scratch.ends[i] += scratch.ends[i - 1];
    if (scratch.sorted.size() < entries.size()) scratch.sorted.resize(entries.size());
    // Filling moves each start to the end of its node's entries.
    for (const Entry<Index>& entry : entries) scratch.sorted[scratch.ends[node_of(entry)]++] = entry;
    std::vector<std::int64_t>& boundary = boundary_of_partition_[static_cast<std::size_t>(partition)];
    std::size_t begin = 0;
    for (std::size_t node = 0; begin < entries.size(); ++node) {
      const std::size_t end = scratch.ends[node];
      const std::span<Entry<Index>> of_node(scratch.sorted.data() + begin, end - begin);
      if (of_node.size() <= 64) {
        match_few(worker, of_node, boundary);
      } else {
        match_many(worker, of_node, boundary);
      }
      begin = end;
    }
    boundary.shrink_to_fit();
  }

  void match_few(int worker, std::span<Entry<Index>> entries, std::vector<std::int64_t>& boundary) {
    std::uint64_t done = 0;
    std::array<Entry<Index>, 64> group;
    for (std::size_t i = 0; i < entries.size(); ++i) {
      if ((done >> i & 1) != 0) continue;
      std::size_t size = 0;
      group[size++] = entries[i];
      for (std::size_t j = i + 1; j < entries.size(); ++j) {
        if (!entries[i].is_same_face(entries[j])) continue;
        group[size++] = entries[j];
        done |= std::uint64_t{1} << j;
      }
      judge(worker, std::span(group.data(), size), boundary);
    }
  }

  /// A node with a great many faces: sorting keeps the cost from growing with the square.
  void match_many(int worker, std::span<Entry<Index>> entries, std::vector<std::int64_t>& boundary) {
    std::sort(entries.begin(), entries.end(),
              [](const Entry<Index>& a, const Entry<Index>& b) { return a.order() < b.order(); });
    for (std::size_t begin = 0; begin < entries.size();) {
      std::size_t end = begin + 1;
      while (end < entries.size() && entries[begin].is_same_face(entries[end])) ++end;
      judge(worker, entries.subspan(begin, end - begin), boundary);
      begin = end;
    }
  }

  /// One face with all who claim it: cells first, then tagged faces, each ascending.
  void judge(int worker, std::span<const Entry<Index>> group, std::vector<std::int64_t>& boundary) {
    FaceMatch& result = of_worker_[static_cast<std::size_t>(worker)];
    const std::int64_t num_cells = context_.num_cells();
    const auto id_of = [](const Entry<Index>& entry) { return static_cast<std::int64_t>(entry.id); };
    std::size_t owners = 0;
    while (owners < group.size() && id_of(group[owners]) >> 3 < num_cells) ++owners;
    const auto tagged = group.subspan(owners);
    if (owners == 1) {
      boundary.push_back(id_of(group[0]));
      if (tagged.empty()) result.untagged.add(id_of(group[0]));
    } else if (owners == 2 && !group[0].is_same_side(group[1])) {
      ++result.num_inner;
      if (nets_ != nullptr) nets_->meet(worker, id_of(group[0]) >> 3, id_of(group[1]) >> 3, id_of(group[0]));
      if (growth_ != nullptr) growth_->meet(worker, id_of(group[0]), id_of(group[1]));
    } else if (owners >= 2) {
      (owners == 2 ? result.same_orientation : result.many_owners).add(id_of(group[0]));
      find_duplicates(group.first(owners), result);
    }
    for (std::size_t i = 0; i < tagged.size(); ++i) judge_tagged(tagged[i], i, group.first(owners), result);
  }

  void judge_tagged(const Entry<Index>& face, std::size_t rank, std::span<const Entry<Index>> owners, FaceMatch& result) const {
    const std::int64_t index = (static_cast<std::int64_t>(face.id) >> 3) - context_.num_cells();
    if (rank > 0) result.tagged_twice.add(index);
    if (owners.empty()) {
      result.tagged_no_cell.add(index);
      return;
    }
    const auto slot = static_cast<std::size_t>(context_.face_tags.slot(context_.tag_of_face(index)));
    if (owners.size() > 1) {
      ++result.inner_of_tag[slot];
      if (is_outer_slot_[slot] != 0) result.outer_inside.add(index);
      return;
    }
    ++result.outer_of_tag[slot];
    if (!face.is_same_side(owners[0])) result.tagged_inward.add(index);
  }

  /// Twins share all faces, so a cell is compared only where its first face lies.
  void find_duplicates(std::span<const Entry<Index>> owners, FaceMatch& result) const {
    // Beyond this many owners of one face the mesh is garbage, and comparing all would cost the square.
    constexpr std::size_t max_compared = 64;
    for (std::size_t i = 1; i < owners.size(); ++i) {
      if ((owners[i].id & 7) != 0) continue;
      const std::int64_t cell = static_cast<std::int64_t>(owners[i].id) >> 3;
      const auto corners = sorted_corners(cell);
      for (std::size_t j = i > max_compared ? i - max_compared : 0; j < i; ++j) {
        const std::int64_t earlier = static_cast<std::int64_t>(owners[j].id) >> 3;
        if (earlier == cell || sorted_corners(earlier) != corners) continue;
        result.duplicate_cells.add(cell);
        break;
      }
    }
  }

  [[nodiscard]] std::array<std::int64_t, 8> sorted_corners(std::int64_t cell) const {
    std::array<std::int64_t, 8> corners;
    corners.fill(-1);
    const auto given = context_.corners_of_cell(cell);
    std::copy(given.begin(), given.end(), corners.begin());
    std::sort(corners.begin(), corners.end());
    return corners;
  }

  FaceMatch gather() {
    FaceMatch all;
    for (const FaceMatch& mine : of_worker_) all.merge(mine);
    std::size_t size = 0;
    for (const auto& part : boundary_of_partition_) size += part.size();
    all.boundary.reserve(size);
    for (auto& part : boundary_of_partition_) {
      all.boundary.insert(all.boundary.end(), part.begin(), part.end());
      std::vector<std::int64_t>().swap(part);
    }
    return all;
  }

  struct Scratch {
    std::vector<std::size_t> ends;
    std::vector<Entry<Index>> sorted;
  };
  const Context& context_;
  NetContacts* nets_;
  HeightGrowth* growth_;
  int shift_ = 12;
  std::vector<std::uint8_t> is_outer_slot_;
  std::vector<FaceMatch> of_worker_;
  std::vector<Scratch> scratch_;
  std::vector<std::vector<std::int64_t>> boundary_of_partition_;
};

}  // namespace

void FaceMatch::merge(const FaceMatch& other) {
  boundary.insert(boundary.end(), other.boundary.begin(), other.boundary.end());
  num_inner += other.num_inner;
  many_owners.merge(other.many_owners);
  same_orientation.merge(other.same_orientation);
  untagged.merge(other.untagged);
  tagged_twice.merge(other.tagged_twice);
  tagged_no_cell.merge(other.tagged_no_cell);
  tagged_inward.merge(other.tagged_inward);
  outer_inside.merge(other.outer_inside);
  duplicate_cells.merge(other.duplicate_cells);
  outer_of_tag.resize(std::max(outer_of_tag.size(), other.outer_of_tag.size()), 0);
  inner_of_tag.resize(outer_of_tag.size(), 0);
  for (std::size_t i = 0; i < other.outer_of_tag.size(); ++i) {
    outer_of_tag[i] += other.outer_of_tag[i];
    inner_of_tag[i] += other.inner_of_tag[i];
  }
}

FaceMatch match_faces(const Context& context, NetContacts* nets, HeightGrowth* growth, const MatchOptions& options) {
  // 32-bit entries take half the memory and suffice for half a thousand million cells.
  constexpr std::int64_t max_small = std::numeric_limits<std::uint32_t>::max() - 1;
  const bool small = context.num_nodes() < max_small && context.num_cells() + context.num_faces() < (max_small >> 3);
  if (small && !options.wide_ids) return Matcher<std::uint32_t>(context, nets, growth).run(options);
  return Matcher<std::int64_t>(context, nets, growth).run(options);
}

}  // namespace pcbmesh::validation::checks
