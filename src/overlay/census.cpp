// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/overlay/census.hpp"

#include <algorithm>

namespace pcbmesh::overlay {
namespace {

NetPair ordered(std::int32_t a, std::int32_t b) {
  return {std::min(a, b), std::max(a, b)};
}

void sort_unique(std::vector<NetPair>& pairs) {
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

/// Distinct ids among `ids`, ascending.
std::vector<std::int32_t> distinct(std::vector<std::int32_t> ids) {
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  return ids;
}

std::vector<NetPair> touching_nets(const EdgeGraph& graph, const Faces& faces, LabelPool& labels,
                                   const Conductors& conductors) {
  std::vector<NetPair> pairs;
  for (const std::int32_t state : distinct(faces.state)) conductors.pairs_within(labels, state, pairs);
  std::vector<std::int32_t> used;
  used.reserve(graph.edges.size());
  for (std::size_t e = 0; e < graph.edges.size(); ++e)
    used.push_back(labels.subtract(faces.state[ix(faces.left[e])], faces.state[ix(faces.right[e])]));
  for (const std::int32_t label : distinct(std::move(used))) conductors.pairs_across(labels, label, pairs);
  sort_unique(pairs);
  return pairs;
}

}  // namespace

bool Conductors::conducts(std::int32_t body) const {
  const model::BodyKind kind = model_.bodies()[ix(body)].kind;
  return kind == model::BodyKind::copper || kind == model::BodyKind::barrel;
}

bool Conductors::share_slab(std::int32_t a, std::int32_t b) const {
  const model::Body &first = model_.bodies()[ix(a)], &second = model_.bodies()[ix(b)];
  if (first.sheet && second.sheet) return first.sheet->face == second.sheet->face;
  // A sheet meets what begins, ends or passes at its face.
  if (first.sheet) return second.first_slab <= first.sheet->face && first.sheet->face <= second.last_slab + 1;
  if (second.sheet) return share_slab(b, a);
  return first.first_slab <= second.last_slab && second.first_slab <= first.last_slab;
}

void Conductors::pairs_across(const LabelPool& labels, std::int32_t label, std::vector<NetPair>& out) const {
  const auto entries = labels.entries(label);
  for (const Increment& left : entries) {
    if (left.delta <= 0) continue;
    for (const Increment& right : entries) {
      if (right.delta < 0 && clash(left.body, right.body)) out.push_back(ordered(net(left.body), net(right.body)));
    }
  }
}

void Conductors::pairs_within(const LabelPool& labels, std::int32_t state, std::vector<NetPair>& out) const {
  const auto entries = labels.entries(state);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    for (std::size_t j = i + 1; j < entries.size(); ++j) {
      if (clash(entries[i].body, entries[j].body)) out.push_back(ordered(net(entries[i].body), net(entries[j].body)));
    }
  }
}

namespace {

std::vector<std::int32_t> element_offsets(const Faces& faces, const LabelPool& labels) {
  std::vector<std::int32_t> offsets(faces.state.size() + 1, 0);
  for (std::size_t f = 0; f < faces.state.size(); ++f)
    offsets[f + 1] = offsets[f] + static_cast<std::int32_t>(labels.entries(faces.state[f]).size());
  return offsets;
}

}  // namespace

BodyParts::BodyParts(const EdgeGraph& graph, const Faces& faces, LabelPool& labels)
    : offsets_(element_offsets(faces, labels)), joined_(ix(offsets_.back())) {
  for (std::size_t e = 0; e < graph.edges.size(); ++e) {
    const auto left = labels.entries(faces.state[ix(faces.left[e])]), right = labels.entries(faces.state[ix(faces.right[e])]);
    const std::int32_t left_first = first(faces.left[e]), right_first = first(faces.right[e]);
    std::size_t i = 0, j = 0;
    while (i < left.size() && j < right.size()) {
      if (left[i].body < right[j].body) {
        ++i;
      } else if (right[j].body < left[i].body) {
        ++j;
      } else {
        joined_.unite(left_first + static_cast<std::int32_t>(i++), right_first + static_cast<std::int32_t>(j++));
      }
    }
  }
}

Census take_census(const EdgeGraph& graph, const Faces& faces, LabelPool& labels, const Conductors& conductors) {
  const auto bodies = conductors.model().bodies();
  Census census;
  census.components.assign(bodies.size(), 0);
  census.pieces.assign(conductors.model().nets().size(), 0);
  BodyParts parts(graph, faces, labels);
  const auto num_faces = static_cast<std::int32_t>(faces.state.size());
  for (std::int32_t f = 0; f < num_faces; ++f) {
    std::int32_t element = parts.first(f);
    for (const Increment& in : labels.entries(faces.state[ix(f)])) {
      if (parts.part(element) == element) ++census.components[ix(in.body)];
      ++element;
    }
  }
  const auto joins = [&](std::int32_t a, std::int32_t b) {
    return bodies[ix(a)].net == bodies[ix(b)].net && conductors.conducts(a) && conductors.conducts(b) &&
           conductors.share_slab(a, b);
  };
  census.touching = touching_nets(graph, faces, labels, conductors);
  if (has_fillers(conductors.model())) {
    census.pieces = count_pieces_by_cells(graph, faces, labels, conductors.model());
    return census;
  }
  // One net's bodies join where they overlap, and where they stand side by side.
  for (std::int32_t f = 0; f < num_faces; ++f) {
    const auto state = labels.entries(faces.state[ix(f)]);
    for (std::size_t i = 0; i < state.size(); ++i) {
      for (std::size_t j = i + 1; j < state.size(); ++j) {
        if (joins(state[i].body, state[j].body))
          parts.unite(parts.first(f) + static_cast<std::int32_t>(i), parts.first(f) + static_cast<std::int32_t>(j));
      }
    }
  }
  for (std::size_t e = 0; e < graph.edges.size(); ++e) {
    const auto label = labels.entries(labels.subtract(faces.state[ix(faces.left[e])], faces.state[ix(faces.right[e])]));
    if (label.size() < 2) continue;
    const auto element = [&](std::int32_t face, std::int32_t body) {
      const auto state = labels.entries(faces.state[ix(face)]);
      const auto at =
          std::lower_bound(state.begin(), state.end(), body, [](const Increment& in, std::int32_t b) { return in.body < b; });
      return parts.first(face) + static_cast<std::int32_t>(at - state.begin());
    };
    for (const Increment& in : label) {
      for (const Increment& out : label) {
        if (in.delta > 0 && out.delta < 0 && joins(in.body, out.body))
          parts.unite(element(faces.left[e], in.body), element(faces.right[e], out.body));
      }
    }
  }
  for (std::int32_t f = 0; f < num_faces; ++f) {
    std::int32_t element = parts.first(f);
    for (const Increment& in : labels.entries(faces.state[ix(f)])) {
      const std::int32_t net = bodies[ix(in.body)].net;
      if (net >= 0 && conductors.conducts(in.body) && parts.part(element) == element) ++census.pieces[ix(net)];
      ++element;
    }
  }
  return census;
}

std::vector<double> areas_mm2(const EdgeGraph& graph, const LabelPool& labels, std::size_t num_bodies) {
  std::vector<__int128> twice(num_bodies, 0);
  for (const Edge& e : graph.edges) {
    const Point a = graph.points[ix(e.u)], b = graph.points[ix(e.v)];
    const __int128 strip = static_cast<__int128>(a.x) * b.y - static_cast<__int128>(b.x) * a.y;
    for (const Increment& in : labels.entries(e.label)) twice[ix(in.body)] += strip * in.delta;
  }
  std::vector<double> areas(num_bodies);
  for (std::size_t b = 0; b < num_bodies; ++b) areas[b] = static_cast<double>(twice[b]) * 0.5e-12;
  return areas;
}

std::vector<Point> places_of_parts(const EdgeGraph& graph, const Faces& faces, LabelPool& labels, std::int32_t body) {
  BodyParts parts(graph, faces, labels);
  std::vector<std::pair<std::int32_t, Point>> found;
  for (std::size_t e = 0; e < graph.edges.size(); ++e) {
    for (const std::int32_t face : {faces.left[e], faces.right[e]}) {
      const auto state = labels.entries(faces.state[ix(face)]);
      for (std::size_t i = 0; i < state.size(); ++i) {
        if (state[i].body != body) continue;
        const std::int32_t part = parts.part(parts.first(face) + static_cast<std::int32_t>(i));
        found.emplace_back(part, std::min(graph.points[ix(graph.edges[e].u)], graph.points[ix(graph.edges[e].v)]));
      }
    }
  }
  std::sort(found.begin(), found.end());
  std::vector<Point> places;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (i == 0 || found[i].first != found[i - 1].first) places.push_back(found[i].second);
  }
  std::sort(places.begin(), places.end());
  return places;
}

}  // namespace pcbmesh::overlay
