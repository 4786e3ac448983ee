// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/mesh/planar_edges.hpp"
#include "pcbmesh/view/render.hpp"
#include "src/view/svg.hpp"

namespace pcbmesh::view {
namespace {

constexpr int margin = 24;
constexpr double mm_per_m = 1e3;
/// Corners nearer than this to the line through their neighbours are left out, mm.
constexpr double straight_mm = 1e-5;

std::size_t index(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

bool is_shown(const PlanOptions& options, std::int32_t group) {
  const std::vector<char>& hidden = options.visibility.hidden_groups;
  return group >= 0 && (hidden.empty() || hidden[index(group)] == 0);
}

/// Slabs that are drawn: those of one layer, or all.
std::vector<char> drawn_slabs(const mesh::PrismMesh& mesh, const PlanOptions& options) {
  std::vector<char> drawn(index(mesh.plan().num_slabs()), 1);
  if (!options.layer) return drawn;
  const auto found = std::find(mesh.layers().begin(), mesh.layers().end(), *options.layer);
  if (found == mesh.layers().end())
    throw Error(ErrorCode::name_unknown,
                fmt::format("no layer '{}' in the mesh; it has {}", *options.layer, fmt::join(mesh.layers(), ", ")));
  const auto layer = static_cast<std::int32_t>(std::distance(mesh.layers().begin(), found));
  std::fill(drawn.begin(), drawn.end(), 0);
  for (std::int32_t t = 0; t < mesh.planar().num_triangles(); ++t)
    for (std::int32_t s = 0; s < mesh.plan().num_slabs(); ++s)
      if (const std::int32_t group = mesh.tag_of(s, t); group >= 0 && mesh.volume_tags()[index(group)].layer == layer)
        drawn[index(s)] = 1;
  return drawn;
}

/// Colour class of every triangle as seen from above; -1 = nothing there.
struct Plan {
  std::vector<std::int32_t> class_of;
  std::vector<Rgb> colours;
};

Plan look_down(const mesh::PrismMesh& mesh, const PlanOptions& options, const Paint& paint) {
  const mesh::PlanarMesh& planar = mesh.planar();
  const std::vector<char> drawn = drawn_slabs(mesh, options);
  Plan plan;
  std::map<std::array<std::uint8_t, 3>, std::int32_t> classes;
  for (std::int32_t t = 0; t < planar.num_triangles(); ++t) {
    plan.class_of.push_back(-1);
    if (options.visibility.box_m) {
      const auto& box = *options.visibility.box_m;
      double x = 0, y = 0;
      for (const std::int32_t v : planar.triangles()[index(t)]) {
        x += planar.points_m()[index(v)][0] / 3;
        y += planar.points_m()[index(v)][1] / 3;
      }
      if (x < box[0] || y < box[1] || x > box[2] || y > box[3]) continue;
    }
    for (std::int32_t s = mesh.plan().num_slabs() - 1; s >= 0; --s) {
      const std::int32_t group = mesh.tag_of(s, t);
      if (drawn[index(s)] == 0 || !is_shown(options, group)) continue;
      Rgb c = paint.of({SkinFaceKind::up, s, t, -1, -1, group, -1});
      // A ramp is drawn in steps no eye can tell apart, so that neighbours join into few outlines.
      if (is_continuous(options.colour))
        c = {static_cast<std::uint8_t>(c.r & 0xf8), static_cast<std::uint8_t>(c.g & 0xf8),
             static_cast<std::uint8_t>(c.b & 0xf8)};
      const auto [found, is_new] = classes.try_emplace({c.r, c.g, c.b}, static_cast<std::int32_t>(plan.colours.size()));
      if (is_new) plan.colours.push_back(c);
      plan.class_of.back() = found->second;
      break;
    }
  }
  return plan;
}

struct Side {
  std::int32_t cls = 0, a = 0, b = 0;
  bool operator<(const Side& o) const { return cls != o.cls ? cls < o.cls : a != o.a ? a < o.a : b < o.b; }
};

/// "M0 0L1 0L1 1Z" of one loop in millimetres, straight runs joined.
void put_loop(std::string& path, const std::vector<std::int32_t>& loop, const mesh::PlanarMesh& planar) {
  const auto at = [&](std::size_t i) {
    const auto& p = planar.points_m()[index(loop[i % loop.size()])];
    return std::array<double, 2>{p[0] * mm_per_m, p[1] * mm_per_m};
  };
  std::vector<std::array<double, 2>> corners;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const auto p = corners.empty() ? at(i + loop.size() - 1) : corners.back(), q = at(i), r = at(i + 1);
    const double x = r[0] - p[0], y = r[1] - p[1], length = std::hypot(x, y);
    const double off = length > 0 ? std::abs(x * (q[1] - p[1]) - y * (q[0] - p[0])) / length : straight_mm;
    const bool is_between = x * (q[0] - p[0]) + y * (q[1] - p[1]) > 0 && x * (r[0] - q[0]) + y * (r[1] - q[1]) > 0;
    if (off >= straight_mm || !is_between) corners.push_back(q);
  }
  if (corners.size() < 3) return;
  for (std::size_t i = 0; i < corners.size(); ++i)
    path += fmt::format("{}{:.7g} {:.7g}", i == 0 ? "M" : "L", std::round(corners[i][0] * 1e4) / 1e4 + 0.0,
                        std::round(corners[i][1] * 1e4) / 1e4 + 0.0);
  path += "Z";
}

/// Outlines of every class, one path each.
std::vector<std::string> outlines(const mesh::PlanarMesh& planar, const Plan& plan) {
  std::vector<Side> sides;
  mesh::visit_planar_edges(planar, [&](const mesh::PlanarEdge& edge) {
    const std::int32_t left = plan.class_of[index(edge.left)], right = edge.right < 0 ? -1 : plan.class_of[index(edge.right)];
    if (left == right) return;
    if (left >= 0) sides.push_back({left, edge.a, edge.b});
    if (right >= 0) sides.push_back({right, edge.b, edge.a});
  });
  std::sort(sides.begin(), sides.end());
  std::vector<char> used(sides.size(), 0);
  std::vector<std::string> paths(plan.colours.size());
  std::vector<std::int32_t> loop;
  for (std::size_t first = 0; first < sides.size(); ++first) {
    if (used[first] != 0) continue;
    loop.clear();
    // Every corner has as many sides in as out, so a walk always comes home; at a touching point any way on will do, because
    // paths are filled by the even-odd rule.
    for (std::size_t here = first; used[here] == 0;) {
      used[here] = 1;
      loop.push_back(sides[here].a);
      auto next = std::lower_bound(sides.begin(), sides.end(), Side{sides[here].cls, sides[here].b, -1});
      while (next != sides.end() && next->cls == sides[here].cls && next->a == sides[here].b &&
             used[static_cast<std::size_t>(next - sides.begin())] != 0)
        ++next;
      if (next == sides.end() || next->cls != sides[here].cls || next->a != sides[here].b) break;
      here = static_cast<std::size_t>(next - sides.begin());
    }
    put_loop(paths[index(sides[first].cls)], loop, planar);
  }
  return paths;
}

std::string edge_path(const mesh::PlanarMesh& planar, const Plan& plan) {
  std::string path;
  mesh::visit_planar_edges(planar, [&](const mesh::PlanarEdge& edge) {
    if (plan.class_of[index(edge.left)] < 0 && (edge.right < 0 || plan.class_of[index(edge.right)] < 0)) return;
    const auto &a = planar.points_m()[index(edge.a)], &b = planar.points_m()[index(edge.b)];
    path += fmt::format("M{:.6g} {:.6g}L{:.6g} {:.6g}", a[0] * mm_per_m, a[1] * mm_per_m, b[0] * mm_per_m, b[1] * mm_per_m);
  });
  return path;
}

/// A length of 1, 2 or 5 times a power of ten, about a fifth of the width.
void put_scale_bar(SvgPage& page, double pixels_per_mm, int x, int y, int width) {
  const double want = width / 5.0 / pixels_per_mm, power = std::pow(10.0, std::floor(std::log10(want)));
  const double bar = want >= 5 * power ? 5 * power : want >= 2 * power ? 2 * power : power;
  page.put(
      fmt::format("<g transform=\"translate({} {})\"><path d=\"M0 -5V0H{:.2f}V-5\" fill=\"none\" stroke=\"{}\" "
                  "stroke-width=\"1.5\"/><text x=\"{:.2f}\" y=\"5\" font-size=\"13\">{} mm</text></g>\n",
                  x, y, bar * pixels_per_mm, page.ink(), bar * pixels_per_mm + 8, bar));
}

}  // namespace

std::string render_plan_svg(const mesh::PrismMesh& mesh, const PlanOptions& options, std::string_view title) {
  const mesh::PlanarMesh& planar = mesh.planar();
  const Paint paint(mesh, options.colour);
  const Plan plan = look_down(mesh, options, paint);
  if (plan.colours.empty()) throw Error(ErrorCode::region_empty, "nothing is left to draw; hide fewer layers or nets");
  double min_x = std::numeric_limits<double>::max(), min_y = min_x, max_x = -min_x, max_y = -min_x;
  for (std::int32_t t = 0; t < planar.num_triangles(); ++t) {
    if (plan.class_of[index(t)] < 0) continue;
    for (const std::int32_t v : planar.triangles()[index(t)]) {
      const auto& p = planar.points_m()[index(v)];
      min_x = std::min(min_x, p[0] * mm_per_m);
      max_x = std::max(max_x, p[0] * mm_per_m);
      min_y = std::min(min_y, p[1] * mm_per_m);
      max_y = std::max(max_y, p[1] * mm_per_m);
    }
  }
  const Legend legend = legend_of(paint, options.visibility.hidden_groups);
  const int top = title.empty() ? margin : svg_title_height, bottom = 48;
  // A tall board is drawn narrower rather than metres high.
  const double scale = std::min((options.width - 2 * margin) / (max_x - min_x), 1.2 * options.width / (max_y - min_y));
  const int width = static_cast<int>(std::ceil(scale * (max_x - min_x))) + 2 * margin,
            height = static_cast<int>(std::ceil(scale * (max_y - min_y)));
  SvgPage page(width + legend_width(legend), top + height + bottom, options.background);
  page.title(title);
  page.put(
      fmt::format("<g transform=\"matrix({0:.6g} 0 0 {1:.6g} {2:.6g} {3:.6g})\" fill-rule=\"evenodd\" "
                  "stroke-linejoin=\"round\">\n",
                  scale, -scale, margin - scale * min_x, top + scale * max_y));
  const std::vector<std::string> paths = outlines(planar, plan);
  for (std::size_t i = 0; i < paths.size(); ++i)
    // A hair of stroke closes the seams that antialiasing leaves between neighbours.
    page.put(fmt::format("<path fill=\"{0}\" stroke=\"{0}\" stroke-width=\"{1:.4g}\" d=\"{2}\"/>\n", hex(plan.colours[i]),
                         0.4 / scale, paths[i]));
  if (options.edges)
    page.put(fmt::format("<path fill=\"none\" stroke=\"#16202c\" stroke-opacity=\".45\" stroke-width=\"{:.4g}\" d=\"{}\"/>\n",
                         0.6 / scale, edge_path(planar, plan)));
  page.put("</g>\n");
  put_scale_bar(page, scale, margin, top + height + 30, width);
  page.legend(legend, width, top);
  return page.finish();
}

}  // namespace pcbmesh::view
