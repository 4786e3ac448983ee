// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/extrude/second_order_source.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "pcbmesh/base/error.hpp"
#include "src/extrude/arc_edges.hpp"
#include "src/extrude/ranked_set.hpp"

namespace pcbmesh::extrude {
namespace {

using mesh::ElementKind;

std::size_t index(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

}  // namespace

SecondOrderSource::SecondOrderSource(const mesh::PrismMesh& mesh, SecondOrderOptions options, mesh::PrismQuality quality)
    : mesh_(mesh), prisms_(mesh, std::move(quality)), with_face_nodes_(options.with_face_nodes) {
  announce_as(prisms_);
  find_edges();
  curve_edges(options);
  make_sets();
  number_nodes(options.with_face_nodes);
  announce_kinds();
}

SecondOrderSource::~SecondOrderSource() = default;

void SecondOrderSource::find_edges() {
  const mesh::PlanarMesh& planar = mesh_.planar();
  edges_.reserve(planar.triangles().size() * 3);
  for (const auto& [a, b, c] : planar.triangles())
    for (const auto& [u, v] : {std::pair{a, b}, {a, c}, {b, c}}) edges_.push_back({std::min(u, v), std::max(u, v)});
  std::sort(edges_.begin(), edges_.end());
  edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
  edges_.shrink_to_fit();
  first_edge_.assign(index(planar.num_points()) + 1, 0);
  for (const Edge& edge : edges_) ++first_edge_[index(edge[0]) + 1];
  for (std::size_t v = 1; v < first_edge_.size(); ++v) first_edge_[v] += first_edge_[v - 1];
}

std::int32_t SecondOrderSource::edge_between(std::int32_t a, std::int32_t b) const {
  const auto [u, v] = std::minmax(a, b);
  for (std::int32_t e = first_edge_[index(u)]; e < first_edge_[index(u) + 1]; ++e)
    if (edges_[index(e)][1] == v) return e;
  report_bug("corners of an element are joined by an edge", __FILE__, __LINE__);
}

void SecondOrderSource::curve_edges(const SecondOrderOptions& options) {
  const auto points = mesh_.planar().points_m();
  middles_m_.reserve(edges_.size());
  for (const auto& [u, v] : edges_)
    middles_m_.push_back({(points[index(u)][0] + points[index(v)][0]) / 2, (points[index(u)][1] + points[index(v)][1]) / 2});
  if (options.circles.empty()) return;
  std::vector<std::array<std::int32_t, 3>> edges_of_triangle;
  edges_of_triangle.reserve(mesh_.planar().triangles().size());
  for (const auto& [a, b, c] : mesh_.planar().triangles())
    edges_of_triangle.push_back({edge_between(a, b), edge_between(a, c), edge_between(b, c)});
  statistics_ = curve(mesh_.planar(), options, {edges_, edges_of_triangle, middles_m_});
}

/// Which edges and vertices exist on each level and in each sub-layer. Slabs with the same voids share everything.
void SecondOrderSource::make_sets() {
  const mesh::PlanarMesh& planar = mesh_.planar();
  const mesh::LayerPlan& plan = mesh_.plan();
  std::vector<std::int32_t> triangle_of_region(index(planar.num_regions()), -1);
  for (std::int32_t t = 0; t < planar.num_triangles(); ++t) triangle_of_region[index(planar.regions()[index(t)])] = t;
  // Pattern 0: nothing, as outside the stack.
  std::vector<std::vector<char>> patterns{std::vector<char>(triangle_of_region.size(), 0)};
  for (std::int32_t slab = 0; slab < plan.num_slabs(); ++slab) {
    std::vector<char> pattern;
    for (const std::int32_t t : triangle_of_region) pattern.push_back(t >= 0 && mesh_.tag_of(slab, t) >= 0 ? 1 : 0);
    const auto found = std::ranges::find(patterns, pattern);
    pattern_of_slab_.push_back(static_cast<std::int32_t>(found - patterns.begin()));
    if (found == patterns.end()) patterns.push_back(std::move(pattern));
  }
  struct Sets {
    const RankedSet* vertices = nullptr;
    const RankedSet* edges = nullptr;
  };
  std::map<std::pair<std::int32_t, std::int32_t>, Sets> made;
  const auto sets_of = [&](std::int32_t below, std::int32_t above) {
    const auto [found, is_new] = made.try_emplace(std::minmax(below, above));
    if (is_new) {
      std::vector<char> vertices(index(planar.num_points()), 0), edges(edges_.size(), 0);
      for (std::size_t t = 0; t < planar.triangles().size(); ++t) {
        const std::size_t region = index(planar.regions()[t]);
        if (patterns[index(below)][region] == 0 && patterns[index(above)][region] == 0) continue;
        const auto& [a, b, c] = planar.triangles()[t];
        for (const std::int32_t v : {a, b, c}) vertices[index(v)] = 1;
        for (const std::int32_t e : {edge_between(a, b), edge_between(a, c), edge_between(b, c)}) edges[index(e)] = 1;
      }
      sets_.push_back(std::make_unique<RankedSet>(vertices));
      found->second.vertices = sets_.back().get();
      sets_.push_back(std::make_unique<RankedSet>(edges));
      found->second.edges = sets_.back().get();
    }
    return found->second;
  };
  for (std::int32_t k = 0; k < plan.num_levels(); ++k) {
    const std::int32_t below = k == 0 ? 0 : pattern_of_slab_[index(plan.slab_of_sublayer()[index(k - 1)])];
    const std::int32_t above = k == plan.num_sublayers() ? 0 : pattern_of_slab_[index(plan.slab_of_sublayer()[index(k)])];
    const Sets level = sets_of(below, above);
    vertices_of_level_.push_back(level.vertices);
    edges_of_level_.push_back(level.edges);
    if (k == plan.num_sublayers()) break;
    const Sets sublayer = sets_of(above, above);
    vertices_of_sublayer_.push_back(sublayer.vertices);
    edges_of_sublayer_.push_back(sublayer.edges);
  }
}

void SecondOrderSource::number_nodes(bool with_face_nodes) {
  std::int64_t next = mesh_.num_nodes();
  const auto add = [&](Strip::Kind kind, const std::vector<const RankedSet*>& sets, std::vector<std::int64_t>& firsts) {
    for (std::size_t i = 0; i < sets.size(); ++i) {
      firsts.push_back(next);
      strips_.push_back({kind, static_cast<std::int32_t>(i), next, sets[i]});
      next += sets[i]->size();
    }
  };
  add(Strip::Kind::horizontal, edges_of_level_, first_on_edge_);
  add(Strip::Kind::vertical, vertices_of_sublayer_, first_on_vertical_);
  if (with_face_nodes) add(Strip::Kind::face, edges_of_sublayer_, first_on_face_);
  num_nodes_ = next;
}

void SecondOrderSource::announce_kinds() {
  for (mesh::ElementBlock& block : blocks_)
    block.kind = block.kind == ElementKind::triangle ? ElementKind::triangle6
                 : block.kind == ElementKind::quadrangle
                     ? with_face_nodes_ ? ElementKind::quadrangle9 : ElementKind::quadrangle8
                 : with_face_nodes_ ? ElementKind::wedge18
                                    : ElementKind::wedge15;
}

mesh::Extent SecondOrderSource::extent_of(std::size_t group) {
  double farthest = 0;  // of a middle from its chord: so much may stand out of a group's corners
  const auto points = mesh_.planar().points_m();
  for (std::size_t e = 0; e < edges_.size(); ++e)
    for (std::size_t i = 0; i < 2; ++i)
      farthest = std::max(farthest,
                          std::abs(middles_m_[e][i] - (points[index(edges_[e][0])][i] + points[index(edges_[e][1])][i]) / 2));
  mesh::Extent extent = prisms_.extent_of(group);
  for (std::size_t i = 0; i < 2 && groups_[group].num_elements > 0; ++i) {
    extent.min[i] -= farthest;
    extent.max[i] += farthest;
  }
  return extent;
}

void SecondOrderSource::fill_nodes(std::int64_t first, std::span<std::array<double, 3>> out) {
  PCBMESH_ASSERT(first >= 0 && static_cast<std::int64_t>(out.size()) <= num_nodes_ - first);
  if (first < mesh_.num_nodes()) {
    const auto corners = std::min(out.size(), static_cast<std::size_t>(mesh_.num_nodes() - first));
    mesh_.fill_nodes(first, out.first(corners));
    out = out.subspan(corners);
    first += static_cast<std::int64_t>(corners);
  }
  const auto points = mesh_.planar().points_m();
  const auto z = mesh_.plan().z_m();
  auto strip =
      std::upper_bound(strips_.begin(), strips_.end(), first, [](std::int64_t id, const Strip& s) { return id < s.first; });
  for (auto to = out.begin(); to != out.end(); ++strip) {
    const Strip& s = *(strip - 1);
    const std::int64_t rank = std::max<std::int64_t>(0, first - s.first);
    const std::int64_t count = std::min<std::int64_t>(s.members->size() - rank, out.end() - to);
    const double height =
        s.kind == Strip::Kind::horizontal ? z[index(s.index)] : (z[index(s.index)] + z[index(s.index) + 1]) / 2;
    const std::span<const std::array<double, 2>> plane = s.kind == Strip::Kind::vertical ? points : middles_m_;
    s.members->visit(static_cast<std::int32_t>(rank), static_cast<std::int32_t>(count), [&](std::int32_t i) {
      *to++ = {plane[index(i)][0], plane[index(i)][1], height};
    });
  }
}

SecondOrderSource::Corner SecondOrderSource::corner_of(std::int64_t node) {
  const auto holds = [&](std::int32_t level) {
    const std::int64_t rank = node - mesh_.first_node_of_level(level);
    return rank >= 0 && rank < mesh_.num_nodes_of_level(level);
  };
  if (!holds(last_level_)) {
    std::int32_t low = 0, high = mesh_.plan().num_levels();  // the last level that starts at or before the node
    while (high - low > 1) {
      const std::int32_t middle = (low + high) / 2;
      (mesh_.first_node_of_level(middle) <= node ? low : high) = middle;
    }
    last_level_ = low;
    while (!holds(last_level_)) --last_level_;  // levels without nodes share their start with the next
  }
  return {last_level_, vertices_of_level_[index(last_level_)]->member(
                           static_cast<std::int32_t>(node - mesh_.first_node_of_level(last_level_)))};
}

std::int64_t SecondOrderSource::on_edge(std::int32_t level, std::int32_t edge) const {
  return first_on_edge_[index(level)] + edges_of_level_[index(level)]->rank(edge);
}

std::int64_t SecondOrderSource::on_vertical(std::int32_t sublayer, std::int32_t vertex) const {
  return first_on_vertical_[index(sublayer)] + vertices_of_sublayer_[index(sublayer)]->rank(vertex);
}

std::int64_t SecondOrderSource::on_face(std::int32_t sublayer, std::int32_t edge) const {
  return first_on_face_[index(sublayer)] + edges_of_sublayer_[index(sublayer)]->rank(edge);
}

void SecondOrderSource::complete(ElementKind kind, std::span<const std::int64_t> corners, std::int64_t* row) {
  row = std::copy(corners.begin(), corners.end(), row);
  const auto [k, a] = corner_of(corners[0]);
  const std::int32_t b = corner_of(corners[1]).vertex;
  if (kind == ElementKind::quadrangle8 || kind == ElementKind::quadrangle9) {  // a and b below, then b and a above
    const std::int32_t ab = edge_between(a, b);
    for (const std::int64_t node : {on_edge(k, ab), on_vertical(k, b), on_edge(k + 1, ab), on_vertical(k, a)}) *row++ = node;
    if (with_face_nodes_) *row = on_face(k, ab);
    return;
  }
  const std::int32_t c = corner_of(corners[2]).vertex;
  const std::int32_t ab = edge_between(a, b), ac = edge_between(a, c), bc = edge_between(b, c);
  if (kind == ElementKind::triangle6) {
    for (const std::int32_t edge : {ab, bc, ac}) *row++ = on_edge(k, edge);
    return;
  }
  for (const std::int64_t node : {on_edge(k, ab), on_edge(k, ac), on_vertical(k, a), on_edge(k, bc), on_vertical(k, b),
                                  on_vertical(k, c), on_edge(k + 1, ab), on_edge(k + 1, ac), on_edge(k + 1, bc)})
    *row++ = node;
  if (with_face_nodes_)
    for (const std::int32_t edge : {ab, ac, bc}) *row++ = on_face(k, edge);
}

void SecondOrderSource::visit(std::size_t block, const VisitNodes& visit) {
  const ElementKind kind = blocks_.at(block).kind;
  const auto num_corners = static_cast<std::size_t>(mesh::corners_of(kind)),
             width = static_cast<std::size_t>(mesh::nodes_of(kind));
  std::vector<std::int64_t> rows(chunk * width);
  prisms_.visit(block, [&](std::span<const std::int64_t> corners) {
    const std::size_t count = corners.size() / num_corners;
    for (std::size_t i = 0; i < count; ++i) complete(kind, corners.subspan(i * num_corners, num_corners), &rows[i * width]);
    visit(std::span<const std::int64_t>(rows).first(count * width));
  });
}

}  // namespace pcbmesh::extrude
