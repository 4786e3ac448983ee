// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/triangulate/smooth.hpp"

#include <algorithm>
#include <boost/container/small_vector.hpp>
#include <cmath>
#include <cstdint>
#include <vector>

#include "src/triangulate/delaunay_flips.hpp"

namespace pcbmesh::triangulate {
namespace {

using Point2 = Kernel::Point_2;
using Vertex = Cdt::Vertex_handle;

/// Moves below this share of the mean edge are not worth the flips.
constexpr double least_move = 0.01;
constexpr int most_halvings = 2;

/// The triangles at one vertex, as the link round it.
struct Star {
  boost::container::small_vector<Point2, 16> link;  // counter-clockwise
  double worst_sine2 = 1, longest2 = 0, mean2 = 0;
};

Star star_of(const Cdt& cdt, Vertex v) {
  Star star;
  auto face = cdt.incident_faces(v);
  const auto first = face;
  do {
    star.link.push_back(face->vertex(Cdt::ccw(face->index(v)))->point());
    const auto shape = MeshBounds::measure(face);
    star.worst_sine2 = std::min(star.worst_sine2, shape.sine2);
    star.longest2 = std::max(star.longest2, shape.longest2);
    star.mean2 += shape.middle2;
  } while (++face != first);
  star.mean2 /= static_cast<double>(star.link.size());
  return star;
}

/// Mean of the circumcentres weighted by area, seen from p.
std::array<double, 2> pull(const Star& star, const Point2& p) {
  double area = 0, x = 0, y = 0;
  for (std::size_t k = 0; k < star.link.size(); ++k) {
    const Point2 &q = star.link[k], &r = star.link[k + 1 < star.link.size() ? k + 1 : 0];
    const double ax = q.x() - p.x(), ay = q.y() - p.y(), bx = r.x() - p.x(), by = r.y() - p.y();
    const double a2 = ax * ax + ay * ay, b2 = bx * bx + by * by;
    // Circumcentre times twice the doubled area: the division by the area cancels against the weight.
    x += by * a2 - ay * b2;
    y += ax * b2 - bx * a2;
    area += ax * by - ay * bx;
  }
  return {0.5 * x / area, 0.5 * y / area};
}

class Smoother {
 public:
  Smoother(Cdt& cdt, const MeshBounds& bounds, const SmoothSetup& setup) : cdt_(cdt), bounds_(bounds), setup_(setup) {
    for (auto v = cdt.finite_vertices_begin(); v != cdt.finite_vertices_end(); ++v) {
      if (v->is_graph_vertex() || v->is_on_graph_edge() || !v->face()->is_in_domain()) continue;
      free_.push_back(v);
    }
    std::size_t last_stamp = 0;
    for (const Vertex v : free_) last_stamp = std::max(last_stamp, v->time_stamp());
    is_stale_.assign(last_stamp + 1, 1);
  }

  /// Number of vertices moved.
  std::int64_t sweep() {
    std::int64_t num_moved = 0;
    for (const Vertex v : free_) {
      std::uint8_t& is_stale = is_stale_[v->time_stamp()];
      if (is_stale == 0) continue;
      is_stale = 0;
      if (move(v)) ++num_moved;
    }
    return num_moved;
  }

 private:
  bool move(Vertex v) {
    const Star star = star_of(cdt_, v);
    auto [dx, dy] = pull(star, v->point());
    if (!(dx * dx + dy * dy > least_move * least_move * star.mean2)) return false;
    for (int halving = 0; halving <= most_halvings; ++halving, dx *= 0.5, dy *= 0.5) {
      const Point2 p(v->point().x() + dx, v->point().y() + dy);
      if (!is_allowed(star, p)) continue;
      v->set_point(p);
      v->set_wanted_edge(-1);
      make_delaunay_round(cdt_, v);
      mark_round(v);
      return true;
    }
    return false;
  }

  [[nodiscard]] bool is_allowed(const Star& star, const Point2& p) const {
    const double least_sine2 = std::min(setup_.guarded_sine2, star.worst_sine2);
    const double most2 = std::max(bounds_.longest2(), star.longest2);
    for (std::size_t k = 0; k < star.link.size(); ++k) {
      const Point2 &q = star.link[k], &r = star.link[k + 1 < star.link.size() ? k + 1 : 0];
      if (CGAL::orientation(p, q, r) != CGAL::LEFT_TURN) return false;
      const auto shape = MeshBounds::measure(p, q, r);
      if (shape.sine2 < least_sine2 || shape.longest2 > most2) return false;
    }
    return true;
  }

  void mark_round(Vertex v) {
    const auto mark = [&](Vertex u) {
      if (u->time_stamp() < is_stale_.size()) is_stale_[u->time_stamp()] = 1;
    };
    mark(v);
    auto u = cdt_.incident_vertices(v);
    const auto first = u;
    do {
      if (!cdt_.is_infinite(u)) mark(u);
    } while (++u != first);
  }

  Cdt& cdt_;
  const MeshBounds& bounds_;
  SmoothSetup setup_;
  std::vector<Vertex> free_;
  std::vector<std::uint8_t> is_stale_;  // by time stamp: something moved near it since it was last looked at
};

}  // namespace

void smooth(Cdt& cdt, const MeshBounds& bounds, const SmoothSetup& setup, const Progress& progress) {
  Smoother smoother(cdt, bounds, setup);
  for (int i = 0; i < setup.num_sweeps; ++i) {
    progress.check();
    if (smoother.sweep() == 0) return;
  }
}

}  // namespace pcbmesh::triangulate
