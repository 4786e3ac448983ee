// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// The visitor's header does not include what it uses, so it comes last.
// clang-format off
#include <CGAL/Delaunay_mesh_size_criteria_2.h>
#include <CGAL/Mesh_2/Clusters.h>
#include <CGAL/Mesh_2/Refine_edges_with_clusters.h>
#include <CGAL/Mesh_2/Refine_faces.h>
#include <CGAL/Mesh_2/Refine_edges_visitor.h>
// clang-format on

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "pcbmesh/base/error.hpp"
#include "src/triangulate/cdt.hpp"
#include "src/triangulate/graph_edges.hpp"
#include "src/triangulate/mesh_bounds.hpp"

namespace pcbmesh::triangulate {

using Zone = CGAL::Triangulation_mesher_level_traits_2<Cdt>::Zone;

/// Does every edge round the zone see p on its inner side? Then joining p to them makes proper triangles only.
[[nodiscard]] inline bool is_star_shaped(const Cdt& cdt, const Kernel::Point_2& p, const Zone& zone) {
  for (const auto& [outer, i] : zone.boundary_edges) {
    const auto a = outer->vertex(Cdt::cw(i)), b = outer->vertex(Cdt::ccw(i));
    if (cdt.is_infinite(a) || cdt.is_infinite(b)) continue;
    if (cdt.orientation(a->point(), b->point(), p) != CGAL::LEFT_TURN) return false;
  }
  return true;
}

/// Gabriel property of constrained edges: no visible vertex inside their diametral circle. Two differences to CGAL's:
/// a vertex on the circle itself is allowed (boards are full of right angles, and closed circles cost 5 % more triangles),
/// and edges below a floor always conform (near-coincident edges would split each other for ever).
struct ConformsAboveFloor {
  double floor2 = 0;
  bool is_circle_closed = false;  // CGAL's and the paper's way

  bool operator()(const Cdt& cdt, Cdt::Face_handle face, int i) const {
    const auto a = face->vertex(Cdt::cw(i)), b = face->vertex(Cdt::ccw(i));
    const auto near = face->vertex(i), far = cdt.tds().mirror_vertex(face, i);
    return ((cdt.is_infinite(near) || is_clear(a, b, near->point())) &&
            (cdt.is_infinite(far) || is_clear(a, b, far->point()))) ||
           is_below_floor(a, b);
  }
  bool operator()(const Cdt& cdt, Cdt::Vertex_handle a, Cdt::Vertex_handle b) const {
    Cdt::Face_handle face;
    int i = 0;
    return !cdt.is_edge(a, b, face, i) || operator()(cdt, face, i);
  }
  bool operator()(const Cdt&, Cdt::Face_handle face, int i, const Kernel::Point_2& p) const {
    const auto a = face->vertex(Cdt::cw(i)), b = face->vertex(Cdt::ccw(i));
    return is_clear(a, b, p) || is_below_floor(a, b);
  }

 private:
  [[nodiscard]] bool is_clear(Cdt::Vertex_handle a, Cdt::Vertex_handle b, const Kernel::Point_2& p) const {
    const double x = (a->point().x() - p.x()) * (b->point().x() - p.x());
    const double y = (a->point().y() - p.y()) * (b->point().y() - p.y());
    const double dot = x + y, error_bound = 1e-15 * (std::abs(x) + std::abs(y));  // 4 roundings of 2^-53, doubled
    if (dot > error_bound) return true;
    if (dot < -error_bound) return false;
    const CGAL::Angle angle = CGAL::angle(a->point(), p, b->point());  // exact
    return angle == CGAL::ACUTE || (angle == CGAL::RIGHT && !is_circle_closed);
  }
  [[nodiscard]] bool is_below_floor(Cdt::Vertex_handle a, Cdt::Vertex_handle b) const {
    return CGAL::squared_distance(a->point(), b->point()) < floor2;
  }
};

struct EdgeSplittingSetup {
  const GraphEdgeIndex* graph_edges = nullptr;
  double floor = 0;
  double unit_nm = 1;
  bool is_circle_closed = false;
};

/// CGAL's edge level; it also writes down on which graph edge each new vertex lies.
class EdgeSplitting : public CGAL::Mesh_2::Refine_edges_base_with_clusters<Cdt, ConformsAboveFloor> {
  using Base = CGAL::Mesh_2::Refine_edges_base_with_clusters<Cdt, ConformsAboveFloor>;

 public:
  using Base::Base;

  void configure(const EdgeSplittingSetup& setup) {
    this->is_locally_conform.floor2 = setup.floor * setup.floor;
    this->is_locally_conform.is_circle_closed = setup.is_circle_closed;
    setup_ = setup;
  }

  void after_insertion_impl(const Cdt::Vertex_handle& v) {
    const Cdt::Vertex_handle a = this->va, b = this->vb;
    v->set_graph_edge(a->is_on_graph_edge()   ? a->graph_edge()
                      : b->is_on_graph_edge() ? b->graph_edge()
                                              : setup_.graph_edges->find(a->graph_vertex(), b->graph_vertex()));
    Base::after_insertion_impl(v);
  }

  CGAL::Mesher_level_conflict_status private_test_point_conflict_impl(const Kernel::Point_2& p, triangulate::Zone& zone) const {
    if (is_star_shaped(this->tr, p, zone)) return CGAL::NO_CONFLICT;
    Spot spot;
    spot.at_mm = {p.x() * setup_.unit_nm * 1e-6, p.y() * setup_.unit_nm * 1e-6};
    throw Error(ErrorCode::triangulation_limit,
                "an edge can't be split: another edge is nearer than double precision can tell. Use a larger --tolerance",
                spot);
  }

 private:
  EdgeSplittingSetup setup_;
};

/// Bad faces, last in, first out: the youngest are in cache. CGAL's own queue keeps faces sorted in two maps, which is two
/// thirds of its time. An entry whose face has changed since is skipped when met: its ticket is no longer the face's.
class YoungestFirst {
 public:
  void clear() { entries_.clear(); }
  void push(Cdt::Face_handle face) { entries_.emplace_back(face, face->ticket()); }
  void pop() { entries_.pop_back(); }
  [[nodiscard]] Cdt::Face_handle top() const { return entries_.back().first; }
  /// Drops what is out of date, then tells whether anything is left.
  [[nodiscard]] bool is_empty() {
    while (!entries_.empty() && entries_.back().first->ticket() != entries_.back().second) entries_.pop_back();
    return entries_.empty();
  }

 private:
  std::vector<std::pair<Cdt::Face_handle, std::uint32_t>> entries_;
};

/// Face level of Delaunay refinement with that queue.
template <class Triangulation, class Bounds, class EdgeLevel>
class FaceSplitting : public CGAL::Triangulation_mesher_level_traits_2<Triangulation>, public CGAL::No_after_no_insertion {
 public:
  using FaceHandle = typename Triangulation::Face_handle;
  using VertexHandle = typename Triangulation::Vertex_handle;
  using Point = typename Triangulation::Point;

  /// Names that CGAL's Refine_faces asks of its base.
  struct Bad_faces {
    using Direct_entry = std::pair<FaceHandle, std::uint32_t>;
    using const_iterator = typename std::vector<Direct_entry>::const_iterator;
  };

  FaceSplitting(Triangulation& triangulation, Bounds& bounds, EdgeLevel& edges)
      : CGAL::Triangulation_mesher_level_traits_2<Triangulation>(triangulation), bounds_(bounds), edges_(edges) {}

  void scan_triangulation_impl() {
    queue_.clear();
    auto& cdt = this->triangulation_ref_impl();
    for (auto face = cdt.finite_faces_begin(); face != cdt.finite_faces_end(); ++face) enqueue_if_bad(face);
  }

  bool no_longer_element_to_refine_impl() { return queue_.is_empty(); }
  FaceHandle get_next_element_impl() const { return queue_.top(); }
  void pop_next_element_impl() {
    queue_.top()->set_ticket(0);
    queue_.pop();
  }

  Point refinement_point_impl(const FaceHandle& face) const { return this->triangulation_ref_impl().circumcenter(face); }

  void before_conflicts_impl(const FaceHandle& face, const Point&) {
    // Outlines that meet at less than 60 degrees are split in equal shells, and CGAL gives up a bad triangle whose centre would
    // split such a shell once more: hundreds of triangles below the bound on a real board. The overlay leaves no corner sharper
    // than 30 degrees, where splitting ends well; sharper ones meet the floor.
    const auto shape = Bounds::measure(face);
    edges_.set_imperative_refinement(bounds_.is_worth_a_shell(shape) ||
                                     bounds_.judge(face, shape) == Bounds::Verdict::too_long);
  }

  /// Faces whose circle holds p, reached from `face` without passing a constrained edge: no point location is needed.
  Zone conflicts_zone_impl(const Point& p, FaceHandle face) const {
    const auto& cdt = this->triangulation_ref_impl();
    Zone zone;
    zone.fh = zone.parent_face = face;
    zone.faces.push_back(face);
    boost::container::small_vector<std::pair<FaceHandle, int>, 64> doors{{face, 2}, {face, 1}, {face, 0}};
    while (!doors.empty()) {
      const auto [from, i] = doors.back();
      doors.pop_back();
      const FaceHandle next = from->neighbor(i);
      const int back = next->index(from);
      if (from->is_constrained(i) || !cdt.test_conflict(p, next)) {
        zone.boundary_edges.emplace_back(next, back);
      } else {
        zone.faces.push_back(next);
        doors.emplace_back(next, Triangulation::cw(back));  // counter-clockwise round the zone
        doors.emplace_back(next, Triangulation::ccw(back));
      }
    }
    return zone;
  }

  CGAL::Mesher_level_conflict_status private_test_point_conflict_impl(const Point& p, const Zone& zone) const {
    return is_star_shaped(this->triangulation_ref_impl(), p, zone) ? CGAL::NO_CONFLICT
                                                                   : CGAL::CONFLICT_AND_ELEMENT_SHOULD_BE_DROPPED;
  }

  void before_insertion_impl(const FaceHandle&, const Point&, Zone& zone) {
    for (const FaceHandle& face : zone.faces) {
      face->set_ticket(0);
      face->set_in_domain(false);
    }
  }

  void after_insertion_impl(const VertexHandle& v) {
    auto face = this->triangulation_ref_impl().incident_faces(v);
    const auto first = face;
    do {
      face->set_in_domain(true);
      enqueue_if_bad(face);
    } while (++face != first);
  }

  /// Called by CGAL's visitor after an edge was split at v.
  void compute_new_bad_faces(VertexHandle v) {
    auto face = this->triangulation_ref_impl().incident_faces(v);
    const auto first = face;
    do {
      enqueue_if_bad(face);
    } while (++face != first);
  }

 private:
  void enqueue_if_bad(FaceHandle face) {
    if (!face->is_in_domain() || bounds_.judge(face, Bounds::measure(face)) == Bounds::Verdict::good) return;
    if (++ticket_ == 0) ++ticket_;
    face->set_ticket(ticket_);
    queue_.push(face);
  }

  Bounds& bounds_;
  EdgeLevel& edges_;
  YoungestFirst queue_;
  std::uint32_t ticket_ = 0;
};

using EdgeLevel = CGAL::Mesh_2::Refine_edges_with_clusters<Cdt, ConformsAboveFloor, EdgeSplitting>;
using FaceLevel = CGAL::Mesh_2::Refine_faces<Cdt, const MeshBounds, EdgeLevel, FaceSplitting<Cdt, const MeshBounds, EdgeLevel>>;

/// The paper's: all CGAL. Its queue takes the worst first, and equals in an order that no simpler queue repeats.
using PaperCriteria = CGAL::Delaunay_mesh_size_criteria_2<Cdt>;
using PaperFaceLevel = CGAL::Mesh_2::Refine_faces<Cdt, PaperCriteria, EdgeLevel>;

}  // namespace pcbmesh::triangulate
