// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "pcbmesh/geometry/path.hpp"
#include "pcbmesh/model/model.hpp"
#include "pcbmesh/overlay/overlay.hpp"

namespace pcbmesh::overlay {

struct Vector2 {
  double x, y;
};

namespace test {

using geometry::Point;
using geometry::Ring;

/// A model in the making: nine slabs, copper on the odd ones.
class Layout {
 public:
  Layout(Nm width, Nm height) : domain{{0, 0}, {width, 0}, {width, height}, {0, height}}, board(domain) {}

  Ring domain, board;
  Nm narrowest = 0, narrowest_of_interest = 0;
  std::vector<std::int32_t> nets_of_interest;
  double turn_deg = 0;
  Point shift;

  std::int32_t copper(const std::string& net, std::int32_t slab) { return add(model::BodyKind::copper, net, slab, slab); }
  std::int32_t barrel(const std::string& net, std::int32_t first, std::int32_t last) {
    return add(model::BodyKind::barrel, net, first, last);
  }
  void ring(std::int32_t body, Ring ring, bool simple = true) {
    if (simple) geometry::make_counter_clockwise(ring);
    shapes_.push_back({body, {std::move(ring)}, simple, 0});
  }
  void box(std::int32_t body, Nm x0, Nm y0, Nm x1, Nm y1) { ring(body, {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}); }
  void disc(std::int32_t body, Point centre, Nm radius, Nm sagitta = 5 * nm_per_um) {
    ring(body, geometry::circle(centre, radius, {.sagitta_nm = sagitta}));
  }
  void track(std::int32_t body, Point a, Point b, Nm width) {
    bool simple = true;
    auto rings = geometry::outline(geometry::segment(a, b, width), {}, simple);
    shapes_.push_back({body, std::move(rings), simple, 0});
  }

  [[nodiscard]] model::Model model() const {
    model::ModelParts parts;
    parts.materials = {{.name = "FR4", .eps_r = 4.3}, {.name = "copper", .sigma_s_per_m = 5.8e7}};
    parts.nets = nets_;
    for (std::int32_t s = 0; s < 9; ++s)
      parts.slabs.push_back({"L" + std::to_string(s), s % 2 == 1 ? model::SlabKind::copper : model::SlabKind::dielectric,
                             s * 100'000, (s + 1) * 100'000, 0, -1});
    parts.bodies = {{.name = "domain", .kind = model::BodyKind::domain, .last_slab = 8},
                    {.name = "board", .kind = model::BodyKind::board, .last_slab = 8}};
    parts.bodies.insert(parts.bodies.end(), bodies_.begin(), bodies_.end());
    parts.shapes = {{0, {domain}, true, 0}, {1, {board}, true, 0}};
    parts.shapes.insert(parts.shapes.end(), shapes_.begin(), shapes_.end());
    const double c = std::cos(turn_deg * std::numbers::pi / 180), s = std::sin(turn_deg * std::numbers::pi / 180);
    for (auto& shape : parts.shapes) {
      for (auto& ring : shape.rings) {
        for (Point& p : ring) {
          const double x = static_cast<double>(p.x), y = static_cast<double>(p.y);
          if (turn_deg != 0) p = {std::llround(x * c - y * s), std::llround(x * s + y * c)};
          p = {p.x + shift.x, p.y + shift.y};
        }
      }
    }
    parts.narrowest_feature_nm = narrowest;
    parts.narrowest_of_interest_nm = narrowest_of_interest;
    parts.nets_of_interest = nets_of_interest;
    return model::Model::from_parts(std::move(parts));
  }

 private:
  std::int32_t add(model::BodyKind kind, const std::string& net, std::int32_t first, std::int32_t last) {
    auto at = std::find(nets_.begin(), nets_.end(), net);
    if (at == nets_.end()) at = nets_.insert(nets_.end(), net);
    bodies_.push_back({.name = "copper " + net,
                       .kind = kind,
                       .material = 1,
                       .net = static_cast<std::int32_t>(at - nets_.begin()),
                       .first_slab = first,
                       .last_slab = last});
    return static_cast<std::int32_t>(bodies_.size()) + 1;
  }
  std::vector<std::string> nets_;
  std::vector<model::Body> bodies_;
  std::vector<model::BodyShape> shapes_;
};

inline Vector2 unit_normal(Point a, Point b) {
  const double dx = static_cast<double>(b.x - a.x), dy = static_cast<double>(b.y - a.y), length = std::hypot(dx, dy);
  return {-dy / length, dx / length};
}

/// Tracks, discs, zones and vias of several nets on four layers. Nets keep to their own strips, so that none touch.
inline Layout random_layout(unsigned seed) {
  std::mt19937 random(seed);
  const auto between = [&](Nm low, Nm high) { return low + static_cast<Nm>(random() % static_cast<unsigned>(high - low + 1)); };
  constexpr Nm um = nm_per_um, mm = nm_per_mm;
  Layout layout(12 * mm, 12 * mm);
  for (int n = 0; n < 4; ++n) {
    const std::string net(1, static_cast<char>('A' + n));
    const auto via = layout.barrel(net, 1, 7);
    for (const std::int32_t slab : {1, 3, 5, 7}) {
      const auto copper = layout.copper(net, slab);
      // The strips of one layer do not overlap; those of different layers do.
      const Nm low = 1 * mm + n * 2600 * um + slab * 70 * um, high = low + 2000 * um;
      for (int k = 0; k < 6; ++k) {
        const Point a{between(1 * mm, 11 * mm), between(low + 200 * um, high - 200 * um)},
            b{between(1 * mm, 11 * mm), between(low + 200 * um, high - 200 * um)};
        layout.track(copper, a, b, between(100, 300) * um);
        layout.disc(copper, b, between(60, 200) * um, k % 2 == 0 ? 5 * um : 1 * um);
      }
      if (slab == 3) {
        // A comb that crosses itself at its hasty corners.
        Ring zone;
        for (int k = 0; k < 12; ++k) zone.push_back({between(1 * mm, 11 * mm), between(low, high)});
        layout.ring(copper, zone, false);
      }
    }
    for (int k = 0; k < 4; ++k) {
      const Point p{between(1 * mm, 11 * mm), 1 * mm + n * 2600 * um + 700 * um + between(0, 800) * um};
      layout.disc(via, p, 150 * um);
      layout.disc(static_cast<std::int32_t>(via + 1 + k), p, 250 * um);
    }
  }
  return layout;
}

/// Slow and simple checks that share no code with the overlay.
class Oracle {
 public:
  Oracle(const model::Model& model, const OverlayResult& result)
      : model_(model), graph_(result.graph), tolerance_(static_cast<double>(result.statistics.tolerance_nm)) {}

  [[nodiscard]] int crossing_edges() const {
    int count = 0;
    const auto edges = graph_.edges();
    for (std::size_t i = 0; i < edges.size(); ++i) {
      for (std::size_t j = i + 1; j < edges.size(); ++j) {
        const auto [a, b] = ends(i);
        const auto [c, d] = ends(j);
        if (std::max(a.x, b.x) < std::min(c.x, d.x) || std::max(c.x, d.x) < std::min(a.x, b.x)) continue;
        const int p = geometry::orientation(a, b, c), q = geometry::orientation(a, b, d);
        const int r = geometry::orientation(c, d, a), s = geometry::orientation(c, d, b);
        if (p * q < 0 && r * s < 0) ++count;
      }
    }
    return count;
  }
  [[nodiscard]] double least_vertex_distance() const {
    double least = std::numeric_limits<double>::infinity();
    const auto vertices = graph_.vertices();
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      for (std::size_t j = i + 1; j < vertices.size(); ++j) least = std::min(least, apart(vertices[i], vertices[j]));
    }
    return least;
  }
  /// Vertex to foreign edge.
  [[nodiscard]] double least_edge_distance() const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t e = 0; e < graph_.edges().size(); ++e) {
      const auto [a, b] = ends(e);
      for (std::size_t v = 0; v < graph_.vertices().size(); ++v) {
        if (static_cast<std::int32_t>(v) != graph_.edges()[e][0] && static_cast<std::int32_t>(v) != graph_.edges()[e][1])
          least = std::min(least, to_segment(graph_.vertices()[v], a, b));
      }
    }
    return least;
  }
  [[nodiscard]] double least_angle_deg() const {
    std::map<std::int32_t, std::vector<double>> directions;
    for (const auto& [u, v] : graph_.edges()) {
      const Point a = graph_.vertices()[static_cast<std::size_t>(u)], b = graph_.vertices()[static_cast<std::size_t>(v)];
      const double angle = std::atan2(static_cast<double>(b.y - a.y), static_cast<double>(b.x - a.x)) * 180 / std::numbers::pi;
      directions[u].push_back(angle);
      directions[v].push_back(angle > 0 ? angle - 180 : angle + 180);
    }
    double least = 360;
    for (auto& [v, angles] : directions) {
      std::sort(angles.begin(), angles.end());
      for (std::size_t i = 0; i < angles.size(); ++i)
        least = std::min(least, i + 1 < angles.size() ? angles[i + 1] - angles[i] : angles[0] + 360 - angles[i]);
    }
    return least;
  }
  /// Random points whose bodies differ from the layout's though they lie well away from every outline of it.
  [[nodiscard]] int wrong_memberships(int num_points) const {
    int wrong = 0;
    for (const Point p : sample(num_points)) {
      const auto got = windings(p);
      const double near = 5 * tolerance_;
      const bool in_domain = inside(0, p), on_board = in_domain && inside(1, p);
      for (std::int32_t body = 0; body < static_cast<std::int32_t>(model_.bodies().size()); ++body) {
        if (outline_distance(body, p) < near || outline_distance(0, p) < near || outline_distance(1, p) < near) continue;
        const bool expected = body == 0 ? in_domain : body == 1 ? on_board : on_board && inside(body, p);
        const auto at = got.find(body);
        if (expected != (at != got.end() && at->second > 0)) ++wrong;
      }
    }
    return wrong;
  }
  /// Random points with a winding other than 0 and 1.
  [[nodiscard]] int windings_beyond_one(int num_points) const {
    int odd = 0;
    for (const Point p : sample(num_points)) {
      for (const auto& [body, winding] : windings(p)) odd += winding != 0 && winding != 1;
    }
    return odd;
  }

 private:
  [[nodiscard]] std::pair<Point, Point> ends(std::size_t e) const {
    return {graph_.vertices()[static_cast<std::size_t>(graph_.edges()[e][0])],
            graph_.vertices()[static_cast<std::size_t>(graph_.edges()[e][1])]};
  }
  static double apart(Point a, Point b) { return std::hypot(static_cast<double>(b.x - a.x), static_cast<double>(b.y - a.y)); }
  static double to_segment(Point p, Point a, Point b) {
    const double dx = static_cast<double>(b.x - a.x), dy = static_cast<double>(b.y - a.y);
    const double px = static_cast<double>(p.x - a.x), py = static_cast<double>(p.y - a.y);
    const double share = dx == 0 && dy == 0 ? 0 : std::clamp((px * dx + py * dy) / (dx * dx + dy * dy), 0.0, 1.0);
    return std::hypot(px - share * dx, py - share * dy);
  }
  [[nodiscard]] std::vector<Point> sample(int num_points) const {
    geometry::Box box;
    for (const auto& shape : model_.shapes()) {
      for (const auto& ring : shape.rings) {
        for (const Point p : ring) box.add(p);
      }
    }
    std::mt19937_64 random(99);
    std::vector<Point> points;
    for (int k = 0; k < num_points; ++k) {
      const auto span = [&](Nm low, Nm high) {
        return low + static_cast<Nm>(random() % static_cast<std::uint64_t>(high - low + 1));
      };
      points.push_back({span(box.min.x, box.max.x), span(box.min.y, box.max.y)});
    }
    return points;
  }
  /// Ray to the left, along y + 1/2 nm so that it meets no vertex.
  static int crossing_of(Point p, Point a, Point b) {
    if ((a.y <= p.y) == (b.y <= p.y)) return 0;
    const bool up = b.y > a.y;
    const double x = static_cast<double>(a.x) +
                     static_cast<double>(b.x - a.x) * ((static_cast<double>(p.y - a.y) + 0.5) / static_cast<double>(b.y - a.y));
    return x < static_cast<double>(p.x) ? (up ? 1 : -1) : 0;
  }
  [[nodiscard]] std::map<std::int32_t, int> windings(Point p) const {
    std::map<std::int32_t, int> sum;
    for (std::size_t e = 0; e < graph_.edges().size(); ++e) {
      const auto [a, b] = ends(e);
      // Crossing an upward edge from left to right adds winding(right) - winding(left) = -delta.
      if (const int crossing = crossing_of(p, a, b); crossing != 0) {
        for (const auto& inc : graph_.increments(e)) sum[inc.body] -= crossing * inc.delta;
      }
    }
    return sum;
  }
  [[nodiscard]] bool inside(std::int32_t body, Point p) const {
    for (const auto& shape : model_.shapes()) {
      if (shape.body != body) continue;
      int winding = 0;
      for (const auto& ring : shape.rings) {
        for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) winding += crossing_of(p, ring[j], ring[i]);
      }
      if (winding != 0) return true;
    }
    return false;
  }
  [[nodiscard]] double outline_distance(std::int32_t body, Point p) const {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& shape : model_.shapes()) {
      if (shape.body != body) continue;
      for (const auto& ring : shape.rings) {
        for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++)
          least = std::min(least, to_segment(p, ring[j], ring[i]));
      }
    }
    return least;
  }
  const model::Model model_;
  const mesh::PlanarGraph graph_;
  double tolerance_;
};

/// All that holds for every result: O1 by brute force, membership away from outlines, areas, parts.
inline void expect_sound(const Layout& layout, const OverlayResult& result) {
  const Oracle oracle(layout.model(), result);
  EXPECT_EQ(oracle.crossing_edges(), 0);
  EXPECT_GT(oracle.least_vertex_distance(), static_cast<double>(result.statistics.tolerance_nm));
  EXPECT_GT(oracle.least_edge_distance(), 0.5 * static_cast<double>(result.statistics.tolerance_nm));
  EXPECT_EQ(oracle.wrong_memberships(400), 0);
  EXPECT_EQ(oracle.windings_beyond_one(400), 0);
}

/// Random board: sound, the same bytes twice, areas near the exact ones.
inline void expect_sound_random_board(unsigned seed) {
  const Layout layout = random_layout(seed);
  Diagnostics diagnostics;
  const OverlayOptions options{.tolerance_nm = 15 * nm_per_um};
  const OverlayResult result = overlay(layout.model(), options, diagnostics),
                      again = overlay(layout.model(), options, diagnostics);
  expect_sound(layout, result);
  EXPECT_TRUE(std::ranges::equal(result.graph.vertices(), again.graph.vertices()));
  EXPECT_TRUE(std::ranges::equal(result.graph.edges(), again.graph.edges()));
  for (const SnapRecord& record : result.ledger) {
    if (record.area_before_mm2 < 0.5) continue;
    EXPECT_NEAR(record.area_after_mm2 / record.area_before_mm2, 1.0, 0.06) << "body " << record.body;
  }
  EXPECT_LT(std::abs(result.statistics.total_area_error), 0.02);
}

}  // namespace test
}  // namespace pcbmesh::overlay
