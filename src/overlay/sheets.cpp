// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/overlay/sheets.hpp"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "src/overlay/collapse.hpp"
#include "src/overlay/match_sides.hpp"
#include "src/overlay/noding.hpp"

namespace pcbmesh::overlay {
namespace {

/// Parts thinner than this on the average cannot be meshed at any tolerance offered; they come from clipping and rounding.
constexpr double thinnest_part_nm = 1000;

constexpr std::int32_t domain_body = 0;
constexpr std::int32_t board_body = 1;

/// Directed rings of a sheet; tags beyond the bodies stand for single shapes.
struct RawSheet {
  EdgeGraph graph;
  std::vector<std::int32_t> body_of_tag;  ///< for tags >= number of bodies
  std::int64_t num_vertices = 0;
};

void add_ring(const geometry::Ring& ring, std::int32_t forward, std::int32_t backward, EdgeGraph& graph) {
  if (ring.size() < 3) return;
  const auto first = static_cast<std::int32_t>(graph.points.size());
  const auto count = static_cast<std::int32_t>(ring.size());
  graph.points.insert(graph.points.end(), ring.begin(), ring.end());
  for (std::int32_t i = 0; i < count; ++i) {
    const std::int32_t j = i + 1 == count ? 0 : i + 1;
    const bool up = ring[ix(i)] < ring[ix(j)];
    if (ring[ix(i)] == ring[ix(j)]) continue;
    graph.edges.push_back(up ? Edge{first + i, first + j, forward} : Edge{first + j, first + i, backward});
  }
}

RawSheet collect(const model::Model& model, const std::vector<std::vector<std::int32_t>>& shapes_of_body,
                 const std::vector<std::int32_t>& bodies, LabelPool& raw) {
  RawSheet sheet;
  std::vector<std::int32_t> wanted = bodies;
  if (bodies.front() != domain_body) wanted.insert(wanted.begin(), {domain_body, board_body});
  const auto num_bodies = static_cast<std::int32_t>(model.bodies().size());
  for (const std::int32_t body : wanted) {
    for (const std::int32_t s : shapes_of_body[ix(body)]) {
      const model::BodyShape& shape = model.shapes()[ix(s)];
      std::int32_t tag = body;
      if (!shape.simple) {
        tag = num_bodies + static_cast<std::int32_t>(sheet.body_of_tag.size());
        sheet.body_of_tag.push_back(body);
      }
      const std::int32_t forward = raw.single(tag, 1), backward = raw.single(tag, -1);
      for (const geometry::Ring& ring : shape.rings) {
        add_ring(ring, forward, backward, sheet.graph);
        if (body == bodies.front() || body > board_body) sheet.num_vertices += static_cast<std::int64_t>(ring.size());
      }
    }
  }
  return sheet;
}

/// Windings of a face -> bodies present, as a label of {body, 1}. Memoised per winding state.
class Membership {
 public:
  Membership(const std::vector<std::int32_t>& bodies, const RawSheet& sheet, const model::Model& model, const LabelPool& raw,
             LabelPool& labels)
      : has_domain_(bodies.front() == domain_body),
        sheet_(sheet),
        num_bodies_(static_cast<std::int32_t>(model.bodies().size())),
        first_guide_(model.first_guide_body()),
        raw_(raw),
        labels_(labels) {}

  std::int32_t of(std::int32_t state) {
    if (memo_.size() <= ix(state)) memo_.resize(ix(raw_.size()), -1);
    if (memo_[ix(state)] >= 0) return memo_[ix(state)];
    present_.clear();
    for (const Increment& in : raw_.entries(state))
      present_.push_back(in.body < num_bodies_ ? in.body : sheet_.body_of_tag[ix(in.body - num_bodies_)]);
    std::sort(present_.begin(), present_.end());
    present_.erase(std::unique(present_.begin(), present_.end()), present_.end());
    const bool in_domain = !present_.empty() && present_[0] == domain_body;
    const bool on_board = in_domain && present_.size() > 1 && present_[1] == board_body;
    increments_.clear();
    for (const std::int32_t body : present_) {
      const bool kept = body == domain_body    ? has_domain_
                        : body == board_body   ? has_domain_ && in_domain
                        : body >= first_guide_ ? in_domain
                                               : on_board;
      if (kept) increments_.push_back({body, 1});
    }
    return memo_[ix(state)] = labels_.intern(increments_);
  }
  /// Whether two states differ in domain or board.
  bool differ_in_frame(std::int32_t a, std::int32_t b) { return frame(a) != frame(b); }

 private:
  int frame(std::int32_t state) {
    bool domain = false, board = false;
    for (const Increment& in : raw_.entries(state)) {
      const std::int32_t body = in.body < num_bodies_ ? in.body : sheet_.body_of_tag[ix(in.body - num_bodies_)];
      domain = domain || body == domain_body;
      board = board || body == board_body;
    }
    return (domain ? 1 : 0) + (board && !has_domain_ ? 2 : 0);
  }
  bool has_domain_;
  const RawSheet& sheet_;
  std::int32_t num_bodies_, first_guide_;
  const LabelPool& raw_;
  LabelPool& labels_;
  std::vector<std::int32_t> memo_, present_;
  std::vector<Increment> increments_;
};

/// Takes bodies' specks out of the faces' states. Returns how many.
std::int64_t drop_specks(const EdgeGraph& graph, Faces& faces, LabelPool& labels, Diagnostics* diagnostics,
                         const model::Model& model) {
  BodyParts parts(graph, faces, labels);
  struct Extent {
    double twice_area = 0, perimeter = 0;
    Point at;
  };
  std::vector<Extent> extent(ix(parts.num_elements()));
  const auto outline = [&](std::int32_t inside, std::int32_t outside, Point a, Point b) {
    const auto in = labels.entries(faces.state[ix(inside)]), out = labels.entries(faces.state[ix(outside)]);
    std::size_t j = 0;
    for (std::size_t i = 0; i < in.size(); ++i) {
      while (j < out.size() && out[j].body < in[i].body) ++j;
      if (j < out.size() && out[j].body == in[i].body) continue;
      Extent& e = extent[ix(parts.part(parts.first(inside) + static_cast<std::int32_t>(i)))];
      // Relative to a point of the part, so that doubles keep nanometres.
      if (e.perimeter == 0) e.at = a;
      e.twice_area += cross(between(e.at, a), between(e.at, b));
      e.perimeter += distance(a, b);
    }
  };
  for (std::size_t k = 0; k < graph.edges.size(); ++k) {
    const Point a = graph.points[ix(graph.edges[k].u)], b = graph.points[ix(graph.edges[k].v)];
    if (faces.state[ix(faces.left[k])] == faces.state[ix(faces.right[k])]) continue;
    outline(faces.left[k], faces.right[k], a, b);
    outline(faces.right[k], faces.left[k], b, a);
  }
  std::int64_t num_specks = 0;
  std::vector<Increment> kept;
  for (std::size_t f = 0; f < faces.state.size(); ++f) {
    const auto state = labels.entries(faces.state[f]);
    kept.clear();
    bool changed = false;
    for (std::size_t i = 0; i < state.size(); ++i) {
      const std::int32_t element = parts.first(static_cast<std::int32_t>(f)) + static_cast<std::int32_t>(i);
      const Extent& e = extent[ix(parts.part(element))];
      const bool speck = state[i].body != domain_body && state[i].body < model.first_guide_body() &&
                         e.twice_area < thinnest_part_nm * e.perimeter;
      changed = changed || speck;
      if (!speck) kept.push_back(state[i]);
      if (!speck || parts.part(element) != element) continue;
      ++num_specks;
      if (diagnostics == nullptr) continue;
      const model::Body& body = model.bodies()[ix(state[i].body)];
      Spot spot;
      spot.net = body.net >= 0 ? std::string(model.net_name(body.net)) : std::string();
      spot.at_mm = {static_cast<double>(e.at.x) * 1e-6, static_cast<double>(e.at.y) * 1e-6};
      diagnostics->note("overlay.speck", "a part of " + body.name + " thinner than 1 um is left out", spot);
    }
    if (changed) faces.state[f] = labels.intern(kept);
  }
  return num_specks;
}

struct SheetCensus {
  Sheet sheet;
  Census census;
  std::int64_t num_vertices = 0, num_specks = 0;
};

SheetCensus make_sheet(const model::Model& model, const std::vector<std::vector<std::int32_t>>& shapes_of_body,
                       const std::vector<std::int32_t>& bodies, LabelPool& labels, const Conductors& conductors,
                       Diagnostics& diagnostics, const Progress& progress) {
  SheetCensus made;
  made.sheet.bodies = bodies;
  LabelPool raw;
  RawSheet rings = collect(model, shapes_of_body, bodies, raw);
  made.num_vertices = rings.num_vertices;
  compact(rings.graph, raw);
  Noder noder(std::move(rings.graph), raw, 0, progress);
  noder.settle();
  EdgeGraph graph = noder.take();
  Faces faces = flood(graph, raw, progress);
  Membership membership(bodies, rings, model, raw, labels);
  const std::vector<std::int32_t> windings = faces.state;
  for (std::int32_t& state : faces.state) state = membership.of(state);
  made.num_specks = drop_specks(graph, faces, labels, &diagnostics, model);
  made.census = take_census(graph, faces, labels, conductors);
  const bool are_guides = bodies.front() >= model.first_guide_body();  // their corners stay where they are
  std::vector<std::uint8_t> marks(graph.points.size(), 0);
  const PeriodicSides periodic(model);  // what crosses them does so at the same places
  for (std::size_t v = 0; v < graph.points.size(); ++v)
    if (periodic.hold(graph.points[v])) marks[v] = fixed_point;
  std::size_t kept = 0;
  for (std::size_t e = 0; e < graph.edges.size(); ++e) {
    Edge edge = graph.edges[e];
    edge.label = labels.subtract(faces.state[ix(faces.left[e])], faces.state[ix(faces.right[e])]);
    if (edge.label == 0) continue;
    if (are_guides || membership.differ_in_frame(windings[ix(faces.left[e])], windings[ix(faces.right[e])]))
      marks[ix(edge.u)] = marks[ix(edge.v)] = fixed_point;
    graph.edges[kept++] = edge;
  }
  graph.edges.resize(kept);
  compact(graph, labels, &marks);
  made.sheet.outlines = std::move(graph);
  made.sheet.marks = std::move(marks);
  return made;
}

/// Finds where outlines that sheets have in common begin and end: points of two sheets with different neighbours.
void mark_run_ends(std::vector<Sheet>& sheets) {
  struct Star {
    Point at, low, high;  ///< point and its two neighbours; both are the point itself if it has not two edges
    std::int32_t sheet, vertex;
  };
  std::vector<Star> stars;
  for (std::size_t s = 0; s < sheets.size(); ++s) {
    const EdgeGraph& graph = sheets[s].outlines;
    const std::size_t first = stars.size();
    std::vector<std::uint8_t> degree(graph.points.size(), 0);
    for (std::size_t v = 0; v < graph.points.size(); ++v)
      stars.push_back(
          {graph.points[v], graph.points[v], graph.points[v], static_cast<std::int32_t>(s), static_cast<std::int32_t>(v)});
    const auto join = [&](std::int32_t v, Point other) {
      Star& star = stars[first + ix(v)];
      if (degree[ix(v)] < 3) ++degree[ix(v)];
      if (degree[ix(v)] == 1) star.low = other;
      if (degree[ix(v)] == 2) star.high = std::max(star.low, other), star.low = std::min(star.low, other);
      if (degree[ix(v)] == 3) star.low = star.high = star.at;
    };
    for (const Edge& e : graph.edges) join(e.u, graph.points[ix(e.v)]), join(e.v, graph.points[ix(e.u)]);
  }
  std::sort(stars.begin(), stars.end(),
            [](const Star& a, const Star& b) { return a.at != b.at ? a.at < b.at : a.sheet < b.sheet; });
  for (std::size_t i = 0; i < stars.size();) {
    std::size_t j = i;
    bool differ = false;
    for (; j < stars.size() && stars[j].at == stars[i].at; ++j)
      differ = differ || stars[j].low != stars[i].low || stars[j].high != stars[i].high;
    for (; i < j; ++i) {
      std::uint8_t& mark = sheets[ix(stars[i].sheet)].marks[ix(stars[i].vertex)];
      if (differ && mark == free_point) mark = run_end;
    }
  }
}

/// Whether some conductors of different sheets share a slab: only then does connectivity need all sheets at once.
bool sheets_meet(const std::vector<Sheet>& sheets, const Conductors& conductors) {
  for (std::size_t i = 0; i < sheets.size(); ++i) {
    for (std::size_t j = i + 1; j < sheets.size(); ++j) {
      const auto conducts = [&](std::int32_t body) { return conductors.conducts(body); };
      if (sheets[i].outlines.edges.empty() || sheets[j].outlines.edges.empty()) continue;
      if (std::ranges::any_of(sheets[i].bodies, conducts) && std::ranges::any_of(sheets[j].bodies, conducts) &&
          conductors.share_slab(sheets[i].bodies.front(), sheets[j].bodies.front()))
        return true;
    }
  }
  return false;
}

}  // namespace

EdgeGraph overlaid(const std::vector<const EdgeGraph*>& graphs, LabelPool& labels) {
  EdgeGraph all;
  for (const EdgeGraph* graph : graphs) {
    const auto first = static_cast<std::int32_t>(all.points.size());
    all.points.insert(all.points.end(), graph->points.begin(), graph->points.end());
    for (const Edge& e : graph->edges) all.edges.push_back({e.u + first, e.v + first, e.label});
  }
  compact(all, labels);
  return all;
}

Sheets make_sheets(const model::Model& model, LabelPool& labels, const Conductors& conductors, Diagnostics& diagnostics,
                   const Progress& progress) {
  Sheets made;
  std::vector<std::vector<std::int32_t>> shapes_of_body(model.bodies().size());
  for (std::size_t s = 0; s < model.shapes().size(); ++s)
    shapes_of_body[ix(model.shapes()[s].body)].push_back(static_cast<std::int32_t>(s));
  // Slabs, face of a sheet, guides apart: what one key has in common is drawn into one sheet.
  std::map<std::tuple<std::int32_t, std::int32_t, std::int32_t, bool>, std::vector<std::int32_t>> groups;
  for (std::size_t b = 0; b < model.bodies().size(); ++b) {
    const model::Body& body = model.bodies()[b];
    groups[{body.first_slab, body.last_slab, body.sheet ? body.sheet->face : -1,
            static_cast<std::int32_t>(b) >= model.first_guide_body()}]
        .push_back(static_cast<std::int32_t>(b));
  }
  made.exact.components.assign(model.bodies().size(), 0);
  made.exact.pieces.assign(model.nets().size(), 0);
  made.area_mm2.assign(model.bodies().size(), 0);
  std::size_t done = 0;
  for (const auto& [slabs, bodies] : groups) {
    progress.at("outlines", static_cast<double>(done++) / static_cast<double>(groups.size()));
    SheetCensus sheet = make_sheet(model, shapes_of_body, bodies, labels, conductors, diagnostics, progress);
    const std::vector<double> area = areas_mm2(sheet.sheet.outlines, labels, model.bodies().size());
    for (std::size_t b = 0; b < area.size(); ++b)
      made.area_mm2[b] += area[b], made.exact.components[b] += sheet.census.components[b];
    for (std::size_t n = 0; n < made.exact.pieces.size(); ++n) made.exact.pieces[n] += sheet.census.pieces[n];
    made.exact.touching.insert(made.exact.touching.end(), sheet.census.touching.begin(), sheet.census.touching.end());
    made.num_input_vertices += sheet.num_vertices;
    made.num_specks += sheet.num_specks;
    made.sheets.push_back(std::move(sheet.sheet));
  }
  mark_run_ends(made.sheets);
  if (has_fillers(model) || sheets_meet(made.sheets, conductors)) {
    progress.at("connections", 0);
    std::vector<const EdgeGraph*> graphs;
    for (const Sheet& sheet : made.sheets) {
      // What takes copper away counts too, and its place on the board.
      if (has_fillers(model) || std::ranges::any_of(sheet.bodies, [&](std::int32_t b) { return conductors.conducts(b); }))
        graphs.push_back(&sheet.outlines);
    }
    Noder noder(overlaid(graphs, labels), labels, 0, progress);
    noder.settle();
    const EdgeGraph all = noder.take();
    Faces faces = flood(all, labels, progress);
    keep_positive(faces, labels);
    drop_specks(all, faces, labels, nullptr, model);
    Census census = take_census(all, faces, labels, conductors);
    made.exact.pieces = std::move(census.pieces);
    made.exact.touching = std::move(census.touching);
  }
  std::sort(made.exact.touching.begin(), made.exact.touching.end());
  made.exact.touching.erase(std::unique(made.exact.touching.begin(), made.exact.touching.end()), made.exact.touching.end());
  return made;
}

}  // namespace pcbmesh::overlay
