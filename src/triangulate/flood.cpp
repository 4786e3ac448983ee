// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/triangulate/flood.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "pcbmesh/base/error.hpp"

namespace pcbmesh::triangulate {
namespace {

struct Crossing {
  std::int32_t graph_edge;
  bool from_left;  // the face stands on the left of the graph edge u -> v
};

class Flood {
 public:
  Flood(Cdt& cdt, const mesh::PlanarGraph& graph, const GraphEdgeIndex& graph_edges)
      : cdt_(cdt), graph_(graph), graph_edges_(graph_edges), is_checked_(graph.edges().size(), 0) {}

  Regions run() {
    regions_.offsets.push_back(0);  // region 0: winding zero everywhere
    spread(cdt_.infinite_face(), 0);
    while (!frontier_.empty()) {
      const auto [face, i] = frontier_.back();
      frontier_.pop_back();
      cross(face, i);
    }
    return std::move(regions_);
  }

 private:
  using Edge = Cdt::Edge;

  void spread(Cdt::Face_handle seed, std::size_t region) {
    const auto ticket = static_cast<std::uint32_t>(region) + 1;
    seed->set_ticket(ticket);
    stack_.push_back(seed);
    while (!stack_.empty()) {
      const Cdt::Face_handle face = stack_.back();
      stack_.pop_back();
      for (int i = 0; i < 3; ++i) {
        const Cdt::Face_handle next = face->neighbor(i);
        if (face->is_constrained(i)) {
          if (next->ticket() != ticket) frontier_.emplace_back(face, i);
        } else if (next->ticket() == 0) {
          next->set_ticket(ticket);
          stack_.push_back(next);
        }
      }
    }
  }

  void cross(Cdt::Face_handle face, int i) {
    const Cdt::Face_handle next = face->neighbor(i);
    if (next->ticket() != 0) {
      check(face, i, next);
      return;
    }
    add_increments(face, i);
    regions_.winding.insert(regions_.winding.end(), sum_.begin(), sum_.end());
    regions_.offsets.push_back(static_cast<std::int32_t>(regions_.winding.size()));
    spread(next, regions_.size() - 1);
  }

  /// Both sides of a graph edge are one region each, so one of its mesh edges is enough.
  void check(Cdt::Face_handle face, int i, Cdt::Face_handle next) {
    const Crossing crossing = crossing_of(face, i);
    char& is_checked = is_checked_[static_cast<std::size_t>(crossing.graph_edge)];
    if (is_checked != 0) return;
    is_checked = 1;
    add_increments(face, i);
    const auto known = regions_.of(next->ticket() - 1);
    if (!std::equal(sum_.begin(), sum_.end(), known.begin(), known.end())) throw_conflict(crossing.graph_edge);
  }

  /// sum_ := winding beyond edge i of the face.
  void add_increments(Cdt::Face_handle face, int i) {
    const Crossing crossing = crossing_of(face, i);
    const auto here = regions_.of(face->ticket() - 1);
    const auto steps = graph_.increments(static_cast<std::size_t>(crossing.graph_edge));
    const std::int32_t sign = crossing.from_left ? -1 : 1;
    sum_.clear();
    std::size_t k = 0;
    for (const mesh::Increment& step : steps) {
      while (k < here.size() && here[k].body < step.body) sum_.push_back(here[k++]);
      std::int32_t winding = sign * step.delta;
      if (k < here.size() && here[k].body == step.body) winding += here[k++].delta;
      if (winding != 0) sum_.push_back({step.body, winding});
    }
    sum_.insert(sum_.end(), here.begin() + static_cast<std::ptrdiff_t>(k), here.end());
  }

  [[nodiscard]] Crossing crossing_of(Cdt::Face_handle face, int i) const {
    const auto a = face->vertex(Cdt::ccw(i)), b = face->vertex(Cdt::cw(i));  // the face is on the left of a -> b
    const std::int32_t edge = a->is_on_graph_edge()   ? a->graph_edge()
                              : b->is_on_graph_edge() ? b->graph_edge()
                                                      : graph_edges_.find(a->graph_vertex(), b->graph_vertex());
    PCBMESH_ASSERT(edge >= 0);
    const auto& [u, v] = graph_.edges()[static_cast<std::size_t>(edge)];
    const auto p = graph_.vertices()[static_cast<std::size_t>(u)], q = graph_.vertices()[static_cast<std::size_t>(v)];
    const double along = static_cast<double>(q.x - p.x) * (b->point().x() - a->point().x()) +
                         static_cast<double>(q.y - p.y) * (b->point().y() - a->point().y());
    return {edge, along > 0};
  }

  [[noreturn]] void throw_conflict(std::int32_t graph_edge) const {
    const auto& [u, v] = graph_.edges()[static_cast<std::size_t>(graph_edge)];
    const auto p = graph_.vertices()[static_cast<std::size_t>(u)], q = graph_.vertices()[static_cast<std::size_t>(v)];
    Spot spot;
    spot.at_mm = {0.5e-6 * static_cast<double>(p.x + q.x), 0.5e-6 * static_cast<double>(p.y + q.y)};
    throw Error(ErrorCode::internal,
                fmt::format("the two sides of graph edge {} disagree about the bodies present; please report this", graph_edge),
                spot, {graph_edge});
  }

  Cdt& cdt_;
  const mesh::PlanarGraph& graph_;
  const GraphEdgeIndex& graph_edges_;
  std::vector<char> is_checked_;
  Regions regions_;
  std::vector<Cdt::Face_handle> stack_;
  std::vector<Edge> frontier_;
  std::vector<mesh::Increment> sum_;
};

}  // namespace

Regions flood(Cdt& cdt, const mesh::PlanarGraph& graph, const GraphEdgeIndex& graph_edges) {
  for (auto face = cdt.all_faces_begin(); face != cdt.all_faces_end(); ++face) face->set_ticket(0);
  return Flood(cdt, graph, graph_edges).run();
}

}  // namespace pcbmesh::triangulate
