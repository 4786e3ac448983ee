// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/triangulate/triangulate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "pcbmesh/base/error.hpp"
#include "test_data.hpp"

namespace pcbmesh::triangulate {
namespace {

using geometry::Point;
using mesh::PlanarMesh;
using model::BodyKind;

constexpr std::int32_t domain = 0, board = 1, copper = 2, second = 3;

/// Closed rings of bodies, as they come from the overlay: no crossings, shared edges merged.
class Drawing {
 public:
  Drawing& ring(std::int32_t body, const std::vector<Point>& points) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::int32_t p = vertex(points[i]), q = vertex(points[(i + 1) % points.size()]);
      edges_[{std::min(p, q), std::max(p, q)}][body] += p < q ? 1 : -1;
    }
    return *this;
  }
  Drawing& ring(std::initializer_list<std::int32_t> bodies, const std::vector<Point>& points) {
    for (const std::int32_t body : bodies) ring(body, points);
    return *this;
  }
  [[nodiscard]] mesh::PlanarGraph graph() const {
    mesh::PlanarGraphParts parts;
    parts.vertices = vertices_;
    parts.increment_offsets.push_back(0);
    for (const auto& [edge, increments] : edges_) {
      parts.edges.push_back(edge);
      for (const auto& [body, delta] : increments) {
        if (delta != 0) parts.increments.push_back({body, delta});
      }
      parts.increment_offsets.push_back(static_cast<std::int32_t>(parts.increments.size()));
    }
    return mesh::PlanarGraph::from_parts(std::move(parts));
  }

 private:
  std::int32_t vertex(Point p) {
    const auto [at, is_new] = ids_.try_emplace(p, static_cast<std::int32_t>(vertices_.size()));
    if (is_new) vertices_.push_back(p);
    return at->second;
  }
  std::vector<Point> vertices_;
  std::map<Point, std::int32_t> ids_;
  std::map<std::array<std::int32_t, 2>, std::map<std::int32_t, std::int32_t>> edges_;
};

model::Model plain_model() {
  model::ModelParts parts;
  parts.materials.resize(1);
  parts.slabs.push_back({"L1", model::SlabKind::dielectric, 0, 100'000, 0, -1});
  for (const auto kind : {BodyKind::domain, BodyKind::board, BodyKind::copper, BodyKind::hole}) {
    model::Body body;
    body.kind = kind;
    body.material = 0;
    parts.bodies.push_back(body);
  }
  return model::Model::from_parts(std::move(parts));
}

std::vector<Point> rectangle(Nm x0, Nm y0, Nm x1, Nm y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

std::vector<Point> circle(Point centre, double radius, int sides) {
  std::vector<Point> ring;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * std::numbers::pi * i / sides;
    ring.push_back({centre.x + std::llround(radius * std::cos(angle)), centre.y + std::llround(radius * std::sin(angle))});
  }
  return ring;
}

TriangulateResult run(const Drawing& drawing, const TriangulateOptions& options = {}) {
  Diagnostics diagnostics;
  return triangulate(drawing.graph(), plain_model(), options, diagnostics);
}

double longest_edge_nm(const PlanarMesh& mesh) {
  double longest2 = 0;
  for (std::int32_t t = 0; t < mesh.num_triangles(); ++t) {
    for (const double edge2 : mesh.squared_edges_m2(t)) longest2 = std::max(longest2, edge2);
  }
  return std::sqrt(longest2) * 1e9;
}

/// Smallest angle by the law of cosines: on purpose not the sine formula of the code under test.
double smallest_angle_deg(const PlanarMesh& mesh) {
  double largest_cosine = -1;
  for (std::int32_t t = 0; t < mesh.num_triangles(); ++t) {
    const auto [a, b, c] = mesh.squared_edges_m2(t);
    largest_cosine = std::max({largest_cosine, (b + c - a) / (2 * std::sqrt(b * c)), (c + a - b) / (2 * std::sqrt(c * a)),
                               (a + b - c) / (2 * std::sqrt(a * b))});
  }
  return std::acos(largest_cosine) * 180 / std::numbers::pi;
}

double area_mm2(const PlanarMesh& mesh, std::int32_t with_body) {
  double sum = 0;
  for (std::int32_t t = 0; t < mesh.num_triangles(); ++t) {
    const auto bodies = mesh.bodies_of_region(mesh.regions()[static_cast<std::size_t>(t)]);
    if (std::find(bodies.begin(), bodies.end(), with_body) != bodies.end()) sum += mesh.area_m2(t) * 1e6;
  }
  return sum;
}

std::array<double, 2> point_nm(const PlanarMesh& mesh, std::int32_t id) {
  const auto& p = mesh.points_m()[static_cast<std::size_t>(id)];
  return {p[0] * 1e9, p[1] * 1e9};
}

/// Total length of constrained edges that lie on the segment a-b.
double constrained_length_on(const PlanarMesh& mesh, Point a, Point b) {
  const double ux = static_cast<double>(b.x - a.x), uy = static_cast<double>(b.y - a.y), length = std::hypot(ux, uy);
  const auto lies_on = [&](std::array<double, 2> p) {
    const double px = p[0] - static_cast<double>(a.x), py = p[1] - static_cast<double>(a.y);
    const double along = (px * ux + py * uy) / length, across = (px * uy - py * ux) / length;
    return std::abs(across) < 1e-3 && along > -1e-3 && along < length + 1e-3;
  };
  double sum = 0;
  for (const auto& [p, q] : mesh.constrained()) {
    const auto from = point_nm(mesh, p), to = point_nm(mesh, q);
    if (lies_on(from) && lies_on(to)) sum += std::hypot(to[0] - from[0], to[1] - from[1]);
  }
  return sum;
}

std::string bytes_of(const PlanarMesh& mesh) {
  std::string bytes;
  const auto append = [&](const auto& values) {
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
  };
  append(mesh.points_m());
  append(mesh.triangles());
  append(mesh.regions());
  append(mesh.constrained());
  for (std::int32_t r = 0; r < mesh.num_regions(); ++r) append(mesh.bodies_of_region(r));
  return bytes;
}

Drawing board_with_pads() {
  Drawing drawing;
  drawing.ring({domain, board}, rectangle(0, 0, 10'000'000, 8'000'000));
  for (int i = 0; i < 4; ++i) {
    for (int k = 0; k < 3; ++k) {
      const Point centre{1'500'000 + i * 2'300'000, 1'500'000 + k * 2'500'000};
      drawing.ring(copper, circle(centre, 400'000, 24)).ring(second, circle(centre, 200'000, 24));
    }
  }
  return drawing;
}

TEST(Triangulate, P1_T1_EveryGraphEdgeIsAUnionOfMeshEdges) {
  const Drawing drawing = board_with_pads();
  const mesh::PlanarGraph graph = drawing.graph();
  const auto result = run(drawing, {.longest_edge_nm = 3e5});
  ASSERT_GT(result.statistics.num_steiner, 1000);
  double total = 0;
  for (const auto& [u, v] : graph.edges()) {
    const Point a = graph.vertices()[static_cast<std::size_t>(u)], b = graph.vertices()[static_cast<std::size_t>(v)];
    const double length = std::hypot(static_cast<double>(b.x - a.x), static_cast<double>(b.y - a.y));
    EXPECT_NEAR(constrained_length_on(result.mesh, a, b), length, 0.01);
    total += length;
  }
  double constrained = 0;  // and no edge is constrained without being one of the graph's
  for (const auto& [p, q] : result.mesh.constrained()) {
    const auto from = point_nm(result.mesh, p), to = point_nm(result.mesh, q);
    constrained += std::hypot(to[0] - from[0], to[1] - from[1]);
  }
  EXPECT_NEAR(constrained / total, 1, 1e-9);
}

TEST(Triangulate, T2_EachTriangleLiesInOneFaceOfTheGraph) {
  const auto result = run(board_with_pads(), {.longest_edge_nm = 3e5});
  const PlanarMesh& mesh = result.mesh;
  EXPECT_EQ(mesh.num_regions(), 1 + 2 * 12);
  const auto polygon_mm2 = [](double radius_mm) {
    return 12 * 12 * radius_mm * radius_mm * std::sin(2 * std::numbers::pi / 24);
  };
  EXPECT_NEAR(area_mm2(mesh, domain), 80, 1e-9);
  EXPECT_NEAR(area_mm2(mesh, copper), polygon_mm2(0.4), 1e-4);  // vertices are rounded to 1 nm
  EXPECT_NEAR(area_mm2(mesh, second), polygon_mm2(0.2), 1e-4);
  for (std::int32_t t = 0; t < mesh.num_triangles(); ++t) {
    double nearest = 1e30, x = 0, y = 0;
    for (const std::int32_t v : mesh.triangles()[static_cast<std::size_t>(t)]) {
      x += point_nm(mesh, v)[0] / 3;
      y += point_nm(mesh, v)[1] / 3;
    }
    for (int i = 0; i < 4; ++i) {
      for (int k = 0; k < 3; ++k) nearest = std::min(nearest, std::hypot(x - 1.5e6 - i * 2.3e6, y - 1.5e6 - k * 2.5e6));
    }
    const auto bodies = mesh.bodies_of_region(mesh.regions()[static_cast<std::size_t>(t)]);
    const std::size_t expected = nearest < 0.198e6                      ? 4
                                 : nearest < 0.396e6 && nearest > 0.2e6 ? 3
                                 : nearest > 0.4e6                      ? 2
                                                                        : bodies.size();
    ASSERT_EQ(bodies.size(), expected) << "at " << x << ", " << y;
    ASSERT_TRUE(std::is_sorted(bodies.begin(), bodies.end()));
  }
}

TEST(Triangulate, P3_RegionsEndAtConstrainedEdgesOnly) {
  const auto result = run(board_with_pads(), {.longest_edge_nm = 3e5});
  const PlanarMesh& mesh = result.mesh;
  const std::set<std::array<std::int32_t, 2>> constrained(mesh.constrained().begin(), mesh.constrained().end());
  EXPECT_TRUE(std::is_sorted(mesh.constrained().begin(), mesh.constrained().end()));
  EXPECT_EQ(constrained.size(), mesh.constrained().size());
  std::map<std::array<std::int32_t, 2>, std::vector<std::int32_t>> sides;
  for (std::int32_t t = 0; t < mesh.num_triangles(); ++t) {
    const auto& corners = mesh.triangles()[static_cast<std::size_t>(t)];
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(corners[i], corners[(i + 1) % 3]);
      sides[{low, high}].push_back(mesh.regions()[static_cast<std::size_t>(t)]);
    }
  }
  for (const auto& [edge, regions] : sides) {
    const bool is_border = regions.size() == 1 || regions[0] != regions[1];
    ASSERT_LE(regions.size(), 2U);
    ASSERT_EQ(is_border, constrained.contains(edge));
  }
}

TEST(Triangulate, T3_SameInputGivesTheSameBytes) {
  const Drawing drawing = board_with_pads();
  const TriangulateOptions options{.longest_edge_nm = 2e5, .grading = Grading{.edge_at_copper_nm = 5e4, .growth = 0.5}};
  const std::string first = bytes_of(run(drawing, options).mesh);
  std::vector<std::string> heap(2000, std::string(100, 'x'));  // other addresses, same mesh
  for (std::size_t i = 0; i < heap.size(); i += 2) heap[i] = std::string();
  EXPECT_EQ(bytes_of(run(drawing, options).mesh), first);
}

TEST(Triangulate, T4_WedgeOfFiveDegreesEndsAndIsReported) {
  Drawing drawing;
  drawing.ring({domain, board}, rectangle(0, 0, 10'000'000, 8'000'000));
  drawing.ring(copper, {{1'000'000, 1'000'000}, {9'000'000, 1'000'000}, {9'000'000, 1'700'000}});  // 5.0 degrees
  Diagnostics diagnostics;
  const auto result = triangulate(drawing.graph(), plain_model(), {}, diagnostics);
  EXPECT_LT(result.mesh.num_triangles(), 1000);
  EXPECT_NEAR(result.statistics.min_angle_deg, std::atan2(0.7, 8.0) * 180 / std::numbers::pi, 0.01);
  EXPECT_NEAR(smallest_angle_deg(result.mesh), result.statistics.min_angle_deg, 1e-6);
  EXPECT_GT(result.statistics.num_below_bound, 0);
  EXPECT_LT(result.statistics.num_below_bound, 20);
  EXPECT_EQ(diagnostics.count("triangulate.angle_below_bound"), 1);
}

TEST(Triangulate, T4_NearlyTouchingEdgesEnd) {
  for (const Nm gap : {1, 3, 30, 300}) {
    Drawing drawing;
    drawing.ring({domain, board}, rectangle(0, 0, 1'000'000, 1'000'000));
    drawing.ring(copper, rectangle(200'000, 200'000, 800'000, 500'000));
    drawing.ring(second, {{230'011, 500'000 + gap}, {770'007, 500'000 + gap}, {770'007, 800'000}, {230'011, 800'000}});
    const auto result = run(drawing, {.longest_edge_nm = 1e5});
    EXPECT_NEAR(area_mm2(result.mesh, domain), 1, 1e-9) << gap;
    EXPECT_LT(result.mesh.num_triangles(), 200'000) << gap;
  }
}

TEST(Triangulate, T4_VertexLimitIsAnError) {
  try {
    run(board_with_pads(), {.longest_edge_nm = 1e4, .max_vertices = 5000});
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::triangulation_limit);
    EXPECT_TRUE(error.spot().at_mm.has_value());
  }
}

TEST(Triangulate, SquareWithAHoleIsMeshedRoundTheHole) {
  Drawing drawing;
  drawing.ring(domain, rectangle(0, 0, 4'000'000, 4'000'000)).ring(board, rectangle(0, 0, 4'000'000, 4'000'000));
  std::vector<Point> hole = rectangle(1'000'000, 1'000'000, 3'000'000, 3'000'000);
  std::reverse(hole.begin(), hole.end());
  drawing.ring({domain, board}, hole);
  const auto result = run(drawing, {.longest_edge_nm = 5e5});
  EXPECT_NEAR(area_mm2(result.mesh, domain), 12, 1e-12);
  EXPECT_EQ(result.mesh.num_regions(), 1);
  for (const auto& [x, y] : result.mesh.points_m()) {
    EXPECT_FALSE(std::abs(x - 0.002) < 0.00099 && std::abs(y - 0.002) < 0.00099) << x << " " << y;
  }
}

TEST(Triangulate, TrianglesOutsideTheDomainAreDropped) {
  Drawing drawing;
  drawing.ring(domain, rectangle(0, 0, 2'000'000, 2'000'000));
  drawing.ring(copper, rectangle(5'000'000, 0, 6'000'000, 1'000'000));  // copper beyond the region of interest
  const auto result = run(drawing, {.longest_edge_nm = 1e5});
  EXPECT_NEAR(area_mm2(result.mesh, domain), 4, 1e-12);
  EXPECT_EQ(area_mm2(result.mesh, copper), 0);
  EXPECT_EQ(result.mesh.num_regions(), 1);
  EXPECT_EQ(result.mesh.bodies_of_region(0).size(), 1U);
}

TEST(Triangulate, ADomainWithNegativeWindingIsAbsent) {
  std::vector<Point> clockwise = rectangle(0, 0, 1'000'000, 1'000'000);
  std::reverse(clockwise.begin(), clockwise.end());
  Drawing drawing;
  drawing.ring(domain, clockwise);
  EXPECT_EQ(run(drawing).mesh.num_triangles(), 0);
}

TEST(Triangulate, WindingTwoOrMinusOneIsPresenceByThePositiveRule) {
  Drawing drawing;
  drawing.ring(domain, rectangle(0, 0, 9'000'000, 9'000'000));
  drawing.ring(copper, rectangle(1'000'000, 1'000'000, 5'000'000, 5'000'000));
  drawing.ring(copper, rectangle(2'000'000, 2'000'000, 3'000'000, 3'000'000));  // winding 2
  std::vector<Point> clockwise = rectangle(6'000'000, 6'000'000, 7'000'000, 7'000'000);
  std::reverse(clockwise.begin(), clockwise.end());
  drawing.ring(copper, clockwise);  // winding -1: absent
  const auto result = run(drawing);
  EXPECT_NEAR(area_mm2(result.mesh, copper), 16, 1e-12);
  EXPECT_EQ(result.mesh.num_regions(), 4);
}

TEST(Triangulate, AngleBoundIsHeldOnGoodInput) {
  for (const double angle : {15.0, 20.7, 25.0, 28.6}) {
    const auto result = run(board_with_pads(), {.min_angle_deg = angle});
    EXPECT_GE(smallest_angle_deg(result.mesh), angle - 1e-9);
    EXPECT_NEAR(smallest_angle_deg(result.mesh), result.statistics.min_angle_deg, 1e-6);
    EXPECT_EQ(result.statistics.num_below_bound, 0) << angle;
  }
}

TEST(Triangulate, AngleBoundIsHeldWhereOutlinesCrossNearEachOther) {
  // Three outlines of three layers cross within 36 um, at 45 degrees: the small triangle between them is cut in shells on all
  // sides. CGAL's own rule leaves triangles of four degrees there.
  constexpr Nm um = 1'000;
  for (const Nm side : {36 * um, 23 * um, 11 * um}) {
    const Point a{4'000 * um, 4'000 * um}, b{a.x + side, a.y}, c{b.x, b.y + side};
    Drawing drawing;
    drawing.ring({domain, board}, rectangle(0, 0, 10'000'000, 8'000'000));
    drawing.ring(copper, {{500 * um, a.y}, {500 * um, 500 * um}, {9'500 * um, 500 * um}, {9'500 * um, a.y}, b, a});
    drawing.ring(second, {a, b, c});
    drawing.ring(copper, {c, {c.x + 3'000 * um, c.y + 3'000 * um}, {c.x, c.y + 3'000 * um}});
    const auto result = run(drawing, {});
    EXPECT_GE(smallest_angle_deg(result.mesh), 20.7 - 0.01) << side;
    EXPECT_EQ(result.statistics.num_below_bound, 0) << side;
  }
}

TEST(Triangulate, EdgeBoundIsHeld) {
  for (const double longest : {1e6, 2.5e5, 1.234567e5}) {
    const auto result = run(board_with_pads(), {.longest_edge_nm = longest});
    EXPECT_LE(longest_edge_nm(result.mesh), longest * (1 + 1e-9));
    EXPECT_GT(longest_edge_nm(result.mesh), longest * 0.9);
  }
}

TEST(Triangulate, AnEdgeOfExactlyTheLongestLengthStays) {
  Drawing drawing;
  drawing.ring(domain, rectangle(0, 0, 200'000, 200'000));
  const double diagonal = std::sqrt(8e10);
  for (const double longest : {diagonal, diagonal * (1 - 2e-16), diagonal * (1 + 2e-16)}) {
    EXPECT_EQ(run(drawing, {.longest_edge_nm = longest}).mesh.num_triangles(), 2);
  }
  EXPECT_GT(run(drawing, {.longest_edge_nm = diagonal * (1 - 1e-9)}).mesh.num_triangles(), 2);
}

TEST(Triangulate, GradingIsFineAtCopperAndCoarseAway) {
  Drawing drawing;
  drawing.ring({domain, board}, rectangle(0, 0, 20'000'000, 20'000'000));
  drawing.ring(copper, rectangle(1'000'000, 1'000'000, 3'000'000, 3'000'000));
  drawing.ring(second, rectangle(15'000'000, 15'000'000, 16'000'000, 16'000'000));  // a hole: not copper
  const Grading grading{.edge_at_copper_nm = 1e5, .growth = 0.3};
  const auto graded = run(drawing, {.grading = grading});
  const auto fine = run(drawing, {.longest_edge_nm = 1e5});
  EXPECT_LT(graded.mesh.num_triangles() * 10, fine.mesh.num_triangles());
  const PlanarMesh& mesh = graded.mesh;
  double longest_far_nm = 0;
  std::int32_t num_in_hole = 0;
  for (std::int32_t t = 0; t < mesh.num_triangles(); ++t) {
    const auto bodies = mesh.bodies_of_region(mesh.regions()[static_cast<std::size_t>(t)]);
    if (bodies.back() == second) ++num_in_hole;
    double nearest = 1e30;
    for (const std::int32_t v : mesh.triangles()[static_cast<std::size_t>(t)]) {
      const auto [x, y] = point_nm(mesh, v);
      const double out = std::hypot(std::max({1e6 - x, 0.0, x - 3e6}), std::max({1e6 - y, 0.0, y - 3e6}));
      const double in = std::max(0.0, std::min({x - 1e6, 3e6 - x, y - 1e6, 3e6 - y}));
      nearest = std::min(nearest, std::max(out, in));
    }
    double longest2 = 0;
    for (const double edge2 : mesh.squared_edges_m2(t)) longest2 = std::max(longest2, edge2);
    const double longest_nm = std::sqrt(longest2) * 1e9;
    ASSERT_LE(longest_nm, (1e5 + 0.3 * nearest) * (1 + 1e-5));
    if (nearest > 8e6) longest_far_nm = std::max(longest_far_nm, longest_nm);
  }
  EXPECT_GT(longest_far_nm, 1.2e6);
  EXPECT_LT(num_in_hole, 20);
}

TEST(Triangulate, G2_CrossingEdgesAreRefusedWithThePlace) {
  mesh::PlanarGraphParts parts;  // two rings that cross at (2, 1) and (1, 2) mm without a vertex there
  Drawing drawing;
  drawing.ring(domain, rectangle(0, 0, 2'000'000, 2'000'000))
      .ring(copper, rectangle(1'000'000, 1'000'000, 3'000'000, 3'000'000));
  try {
    run(drawing);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::planar_crossing_edges);
    ASSERT_TRUE(error.spot().at_mm.has_value());
    const auto [x, y] = *error.spot().at_mm;
    EXPECT_TRUE((std::abs(x - 2) < 1e-9 && std::abs(y - 1) < 1e-9) || (std::abs(x - 1) < 1e-9 && std::abs(y - 2) < 1e-9));
    EXPECT_EQ(error.ids().size(), 2U);
  }
}

TEST(Triangulate, AVertexInsideAnEdgeIsRefused) {
  Drawing drawing;
  drawing.ring(domain, rectangle(0, 0, 2'000'000, 2'000'000))
      .ring(copper, {{1'000'000, 0}, {1'500'000, 500'000}, {500'000, 500'000}});
  try {
    run(drawing);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::planar_crossing_edges);
    EXPECT_EQ(*error.spot().at_mm, (std::array<double, 2>{1, 0}));
  }
}

TEST(Triangulate, NeighboursOnTheBoardAreNeighboursInMemory) {
  const auto result = run(board_with_pads(), {.longest_edge_nm = 1e5});
  double sum = 0;
  for (const auto& corners : result.mesh.triangles()) {
    const auto [low, high] = std::minmax({corners[0], corners[1], corners[2]});
    sum += high - low;
  }
  // A row-by-row numbering would give about sqrt(points); the Hilbert order stays far below.
  const double mean = sum / result.mesh.num_triangles();
  EXPECT_LT(mean, 0.05 * result.mesh.num_points());
}

TEST(Triangulate, CancelsBetweenVertices) {
  const std::atomic<bool> cancel{true};
  Diagnostics diagnostics;
  try {
    const auto result = triangulate(board_with_pads().graph(), plain_model(), {}, diagnostics, Progress({}, &cancel));
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::cancelled);
  }
}

Drawing board_with_features() {
  Drawing drawing;
  drawing.ring({domain, board}, rectangle(0, 0, 10'000'000, 6'000'000));
  drawing.ring(copper, rectangle(1'000'000, 2'000'000, 8'000'000, 2'200'000));
  drawing.ring(copper, circle({5'000'000, 4'000'000}, 700'000, 24));
  drawing.ring(second, circle({5'000'000, 4'000'000}, 300'000, 16));
  return drawing;
}

double mean_quality(const PlanarMesh& mesh) {
  double sum = 0;
  for (std::int32_t t = 0; t < mesh.num_triangles(); ++t) {
    const auto [a, b, c] = mesh.squared_edges_m2(t);
    sum += 4 * std::numbers::sqrt3 * mesh.area_m2(t) / (a + b + c);
  }
  return sum / mesh.num_triangles();
}

/// Length of all constrained edges and area by set of bodies: what no vertex move may change.
std::pair<double, std::map<std::vector<std::int32_t>, double>> invariants(const PlanarMesh& mesh) {
  double length = 0;
  for (const auto& [a, b] : mesh.constrained()) {
    const auto &p = mesh.points_m()[static_cast<std::size_t>(a)], &q = mesh.points_m()[static_cast<std::size_t>(b)];
    length += std::hypot(p[0] - q[0], p[1] - q[1]);
  }
  std::map<std::vector<std::int32_t>, double> areas;
  for (std::int32_t t = 0; t < mesh.num_triangles(); ++t) {
    const auto bodies = mesh.bodies_of_region(mesh.regions()[static_cast<std::size_t>(t)]);
    areas[{bodies.begin(), bodies.end()}] += mesh.area_m2(t);
  }
  return {length, areas};
}

TEST(Triangulate, SeedAndSmoothingKeepBoundsOutlinesAndRegions) {
  const TriangulateOptions plain{.longest_edge_nm = 300'000};
  const auto reference = invariants(run(board_with_features(), plain).mesh);
  for (const Seed seed : {Seed::delaunay, Seed::hexagonal}) {
    for (const bool smoothed : {false, true}) {
      TriangulateOptions options = plain;
      options.seed = seed;
      options.smooth = smoothed;
      const auto result = run(board_with_features(), options);
      EXPECT_GE(smallest_angle_deg(result.mesh), 20.7 - 5e-3);
      EXPECT_LE(longest_edge_nm(result.mesh), 300'000 * (1 + 1e-12));
      const auto found = invariants(result.mesh);
      EXPECT_NEAR(found.first, reference.first, 1e-12 * reference.first);
      ASSERT_EQ(found.second.size(), reference.second.size());
      for (const auto& [bodies, area] : reference.second) EXPECT_NEAR(found.second.at(bodies), area, 1e-12 * area);
    }
  }
}

TEST(Triangulate, SeedAndSmoothingMakeBetterTriangles) {
  TriangulateOptions options{.longest_edge_nm = 300'000};
  const auto plain = run(board_with_features(), options).mesh;
  options.smooth = true;
  const auto smoothed = run(board_with_features(), options).mesh;
  EXPECT_GT(mean_quality(smoothed), mean_quality(plain) + 0.02);
  options.seed = Seed::hexagonal;
  const auto both = run(board_with_features(), options).mesh;
  EXPECT_GT(mean_quality(both), 0.95);
  EXPECT_EQ(both.num_triangles(), run(board_with_features(), options).mesh.num_triangles()) << "the same every time";
}

TEST(Triangulate, HexagonalSeedOfAnEmptyBoardIsNearlyEquilateral) {
  Drawing drawing;
  drawing.ring({domain, board}, rectangle(0, 0, 10'000'000, 10'000'000));
  const auto mesh = run(drawing, {.longest_edge_nm = 320'000, .seed = Seed::hexagonal, .smooth = true}).mesh;
  EXPECT_GT(mean_quality(mesh), 0.98);
  // Equilateral triangles of the lattice's edge, 0.625 of the bound.
  EXPECT_NEAR(mesh.num_triangles(), 1e14 / (std::numbers::sqrt3 / 4 * 200'000.0 * 200'000.0), 0.06 * 5773);
}

TEST(Triangulate, NonsenseOptionsAreRefused) {
  for (const TriangulateOptions& options :
       {TriangulateOptions{.longest_edge_nm = 0}, TriangulateOptions{.longest_edge_nm = NAN},
        TriangulateOptions{.min_angle_deg = 0}, TriangulateOptions{.min_angle_deg = 33},
        TriangulateOptions{.grading = Grading{.edge_at_copper_nm = -1}},
        TriangulateOptions{.grading = Grading{.edge_at_copper_nm = 1e5}, .as_in_paper = true}}) {
    EXPECT_THROW(run(board_with_pads(), options), Error);
  }
}

TEST(Triangulate, AnEmptyGraphGivesAnEmptyMesh) {
  const auto result = run(Drawing());
  EXPECT_EQ(result.mesh.num_triangles(), 0);
  EXPECT_EQ(result.mesh.num_regions(), 0);
}

/// The paper's serpentine as reconstructed: 382 triangles at 2 mm.
TEST(Triangulate, PaperSerpentineHasItsTriangles) {
  PCBMESH_NEEDS_TEST_DATA();
  std::ifstream file(tests::test_data() / ".." / "paper" / "serpentine.json");
  if (!file) GTEST_SKIP() << "no paper/serpentine.json beside the test data";
  const auto json = nlohmann::json::parse(file);
  Drawing drawing;
  for (const auto& feature : json.at("features")) {
    std::vector<Point> ring;
    for (const auto& p : feature.at("points")) ring.push_back({nm_from_mm(p[0].get<double>()), nm_from_mm(p[1].get<double>())});
    geometry::make_counter_clockwise(ring);
    if (feature.at("role") == "board") {
      drawing.ring({domain, board}, ring);
    } else {
      drawing.ring(copper, ring);
    }
  }
  const auto result = run(drawing, {.as_in_paper = true});
  double quality = 0, shortest_h = 1e30, sum_h = 0, longest_h = 0;
  for (std::int32_t t = 0; t < result.mesh.num_triangles(); ++t) {
    const auto [a, b, c] = result.mesh.squared_edges_m2(t);
    quality += 4 * std::numbers::sqrt3 * result.mesh.area_m2(t) / (a + b + c);
    const double h = std::sqrt((a + b + c) / 2) * 1e3;
    shortest_h = std::min(shortest_h, h);
    longest_h = std::max(longest_h, h);
    sum_h += h;
  }
  const double count = result.mesh.num_triangles();
  EXPECT_NEAR(count, 382, 3.82);
  EXPECT_NEAR(quality / count, 0.847, 0.005);
  EXPECT_NEAR(shortest_h, 0.282843, 1e-6);
  EXPECT_NEAR(sum_h / count, 0.6594, 0.006594);
  EXPECT_NEAR(longest_h, 2.28, 0.0456);
  const auto count_at = [&](double longest_nm) {
    return static_cast<double>(run(drawing, {.longest_edge_nm = longest_nm, .as_in_paper = true}).mesh.num_triangles());
  };
  EXPECT_NEAR(count_at(659'400), 717, 7.17);
  EXPECT_NEAR(count_at(std::sqrt(8e10)), 3372, 33.72);
  EXPECT_NEAR(count_at(100'000), 27152, 271.52);
}

}  // namespace
}  // namespace pcbmesh::triangulate
