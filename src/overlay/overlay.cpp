// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/overlay/overlay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "src/overlay/blunting.hpp"
#include "src/overlay/collapse.hpp"
#include "src/overlay/ledger.hpp"
#include "src/overlay/noding.hpp"
#include "src/overlay/sheets.hpp"
#include "src/overlay/verify.hpp"

namespace pcbmesh::overlay {
namespace {

constexpr Nm least_tolerance = nm_per_um;
constexpr int most_blunt_rounds = 6;

Nm first_tolerance(const model::Model& model, const OverlayOptions& options) {
  if (options.tolerance_nm) {
    if (*options.tolerance_nm <= 0 || *options.tolerance_nm > nm_per_mm)
      throw Error(ErrorCode::usage, fmt::format("the snapping tolerance must be above 0 and at most 1 mm, not {}",
                                                format_length(*options.tolerance_nm)));
    return *options.tolerance_nm;
  }
  const bool some_nets = !model.nets_of_interest().empty();
  Nm tolerance = some_nets ? 5 * nm_per_um : 20 * nm_per_um;
  if (some_nets && model.narrowest_of_interest_nm() > 0) tolerance = std::min(tolerance, model.narrowest_of_interest_nm() / 20);
  if (model.narrowest_feature_nm() > 0) tolerance = std::min(tolerance, model.narrowest_feature_nm() / 8);
  return std::max(tolerance, least_tolerance);
}

/// One try: the tolerance, and the bodies that an earlier try showed to be too delicate for blunting.
struct Attempt {
  Nm tolerance_nm = 0;
  std::vector<std::int32_t> spared;
};

struct Cleaned {
  EdgeGraph graph;
  Faces faces;
  NodingCounts counts;
  Census census;
};

Cleaned clean(const Sheets& sheets, const OverlayOptions& options, const Attempt& attempt, LabelPool& labels,
              const Conductors& conductors, const Progress& progress) {
  const double tol = static_cast<double>(attempt.tolerance_nm);
  const CollapseLimits limits{options.simplify_over_tolerance * tol, tol / 40};
  std::vector<EdgeGraph> simplified;
  for (std::size_t s = 0; s < sheets.sheets.size(); ++s) {
    progress.at("simplification", static_cast<double>(s) / static_cast<double>(sheets.sheets.size()));
    simplified.push_back(collapse(sheets.sheets[s].outlines, sheets.sheets[s].marks, limits, labels, progress));
  }
  std::vector<const EdgeGraph*> graphs;
  for (const EdgeGraph& graph : simplified) graphs.push_back(&graph);
  progress.at("snapping", 0);
  Noder noder(overlaid(graphs, labels), labels, attempt.tolerance_nm, progress);
  noder.settle();
  const BluntLimits tips{options.blunt_angle_deg, options.blunt_width_over_tolerance * tol, attempt.spared};
  for (int round = 0; round < most_blunt_rounds; ++round) {
    progress.at("snapping", 0.4 + 0.1 * round);
    if (blunt(noder, tips, conductors) == 0) break;
    noder.settle();
  }
  Cleaned result;
  result.counts = noder.counts();
  result.graph = noder.take();
  result.faces = flood(result.graph, labels, progress);
  if (keep_positive(result.faces, labels) > 0) {
    // Where an outline was turned inside out or laid double, membership decides; edges that then divide nothing go.
    for (std::size_t e = 0; e < result.graph.edges.size(); ++e)
      result.graph.edges[e].label =
          labels.subtract(result.faces.state[ix(result.faces.left[e])], result.faces.state[ix(result.faces.right[e])]);
    compact(result.graph, labels);
    result.faces = flood(result.graph, labels, progress);
  }
  result.census = take_census(result.graph, result.faces, labels, conductors);
  return result;
}

Spot spot_of(Point p) {
  Spot spot;
  spot.at_mm = {static_cast<double>(p.x) * 1e-6, static_cast<double>(p.y) * 1e-6};
  return spot;
}

/// Where and in what a cleaned graph differs from the layout.
Spot locate(const Mismatch& mismatch, const Sheets& sheets, const Cleaned& cleaned, LabelPool& labels,
            const Conductors& conductors, const Progress& progress) {
  const model::Model& model = conductors.model();
  Spot spot;
  if (mismatch.body >= 0) {
    const std::vector<Point> after = places_of_parts(cleaned.graph, cleaned.faces, labels, mismatch.body);
    std::vector<Point> before;
    for (const Sheet& sheet : sheets.sheets) {
      if (!std::ranges::binary_search(sheet.bodies, mismatch.body)) continue;
      const Faces faces = flood(sheet.outlines, labels, progress);
      before = places_of_parts(sheet.outlines, faces, labels, mismatch.body);
    }
    if (const auto place = differing_place(before, after, 2e5)) spot = spot_of(*place);
    const model::Body& body = model.bodies()[ix(mismatch.body)];
    spot.layer = model.slabs()[ix(body.first_slab)].layer;
    spot.net = model.net_name(body.net);
    return spot;
  }
  if (!mismatch.nets) return spot;
  std::vector<NetPair> pairs;
  for (std::size_t e = 0; e < cleaned.graph.edges.size(); ++e) {
    pairs.clear();
    conductors.pairs_across(labels, cleaned.graph.edges[e].label, pairs);
    conductors.pairs_within(labels, cleaned.faces.state[ix(cleaned.faces.left[e])], pairs);
    if (std::ranges::find(pairs, *mismatch.nets) == pairs.end()) continue;
    spot = spot_of(cleaned.graph.points[ix(cleaned.graph.edges[e].u)]);
    break;
  }
  spot.net = model.net_name((*mismatch.nets)[1]);
  return spot;
}

mesh::PlanarGraph to_planar_graph(const EdgeGraph& graph, const LabelPool& labels) {
  mesh::PlanarGraphParts parts;
  parts.vertices = graph.points;
  parts.edges.reserve(graph.edges.size());
  parts.increment_offsets.push_back(0);
  for (const Edge& e : graph.edges) {
    parts.edges.push_back({e.u, e.v});
    const auto entries = labels.entries(e.label);
    parts.increments.insert(parts.increments.end(), entries.begin(), entries.end());
    parts.increment_offsets.push_back(static_cast<std::int32_t>(parts.increments.size()));
  }
  return mesh::PlanarGraph::from_parts(std::move(parts));
}

void measure_areas(const model::Model& model, const Sheets& sheets, const std::vector<double>& area_mm2,
                   OverlayStatistics& statistics) {
  double total_before = 0, total_after = 0;
  for (std::size_t b = 0; b < area_mm2.size(); ++b) {
    if (model.bodies()[b].kind != model::BodyKind::copper || sheets.area_mm2[b] <= 0) continue;
    const double error = std::abs(area_mm2[b] - sheets.area_mm2[b]) / sheets.area_mm2[b];
    statistics.worst_body_area_error = std::max(statistics.worst_body_area_error, error);
    total_before += sheets.area_mm2[b];
    total_after += area_mm2[b];
  }
  statistics.total_area_error = total_before > 0 ? (total_after - total_before) / total_before : 0;
}

/// Bodies a mismatch is about.
std::vector<std::int32_t> bodies_of(const Mismatch& mismatch, const model::Model& model) {
  std::vector<std::int32_t> bodies;
  for (std::size_t b = 2; b < model.bodies().size(); ++b) {
    const std::int32_t net = model.bodies()[b].net;
    const bool named = mismatch.nets && (net == (*mismatch.nets)[0] || net == (*mismatch.nets)[1]);
    if (named || static_cast<std::int32_t>(b) == mismatch.body) bodies.push_back(static_cast<std::int32_t>(b));
  }
  return bodies;
}

/// The next try after a failed one; nullopt when none is left. Blunting is given up for the bodies concerned first, since
/// that costs the rest of the board nothing.
std::optional<Attempt> next_attempt(const Attempt& last, Nm first_tolerance_nm, const std::optional<Mismatch>& mismatch,
                                    const model::Model& model) {
  if (mismatch && last.spared.size() < 64) {
    Attempt again = last;
    for (const std::int32_t body : bodies_of(*mismatch, model)) {
      if (!std::ranges::binary_search(last.spared, body)) again.spared.push_back(body);
    }
    std::ranges::sort(again.spared);
    if (again.spared.size() > last.spared.size()) return again;
  }
  const Nm three_quarters = first_tolerance_nm * 3 / 4;
  const Nm smaller = last.tolerance_nm == first_tolerance_nm ? three_quarters
                     : last.tolerance_nm == three_quarters   ? first_tolerance_nm / 2
                                                             : last.tolerance_nm / 2;
  if (smaller >= least_tolerance) return Attempt{smaller, {}};
  // The last resort is the least tolerance itself, unless a smaller one was asked for from the start.
  if (last.tolerance_nm > least_tolerance) return Attempt{least_tolerance, {}};
  return std::nullopt;
}

OverlayResult finished(const model::Model& model, const Sheets& sheets, const Census& reference, const Cleaned& cleaned,
                       const Attempt& attempt, int num_attempts, const LabelPool& labels, const Progress& progress) {
  const std::vector<double> area_mm2 = areas_mm2(cleaned.graph, labels, model.bodies().size());
  OverlayResult result{to_planar_graph(cleaned.graph, labels),
                       make_ledger(model, sheets, cleaned.graph, area_mm2, labels, attempt.tolerance_nm, progress),
                       {},
                       reference.pieces,
                       {}};
  for (const NetPair& pair : reference.touching) {
    if (pair[0] >= 0) result.touching_nets.push_back(pair);
  }
  result.statistics.tolerance_nm = attempt.tolerance_nm;
  result.statistics.attempts = num_attempts;
  result.statistics.num_input_vertices = sheets.num_input_vertices;
  result.statistics.num_snapped = cleaned.counts.num_snapped;
  result.statistics.num_crossings = cleaned.counts.num_crossings;
  result.statistics.num_passes = cleaned.counts.num_passes;
  measure_areas(model, sheets, area_mm2, result.statistics);
  return result;
}

/// Nets that meet in the layout itself (net ties, drawing errors) are meshed as drawn, and named.
void warn_of_contacts(const Census& reference, const Sheets& sheets, const Cleaned& cleaned, LabelPool& labels,
                      const Conductors& conductors, Diagnostics& diagnostics, const Progress& progress) {
  for (const NetPair& pair : reference.touching) {
    if (pair[0] < 0) continue;  // copper without a net is nobody's short
    const Mismatch contact{{}, -1, pair};
    diagnostics.warn("overlay.touching_nets",
                     fmt::format("nets {} and {} touch or overlap in the layout itself; they are meshed as drawn",
                                 conductors.model().net_name(pair[0]), conductors.model().net_name(pair[1])),
                     locate(contact, sheets, cleaned, labels, conductors, progress));
  }
}

/// What a series of attempts came to.
struct Outcome {
  std::optional<OverlayResult> result;  ///< agrees with the reference; empty if no attempt did
  std::optional<Error> failure;         ///< of the last attempt that failed
  std::optional<Census> finest;         ///< of the last attempt: the layout as the least tolerance shows it
  int num_attempts = 0;
};

Outcome attempt_all(Nm tolerance_nm, int num_before, const Sheets& sheets, const Census& reference,
                    const OverlayOptions& options, LabelPool& labels, const Conductors& conductors, Diagnostics& diagnostics,
                    const Progress& progress) {
  Outcome outcome;
  outcome.num_attempts = num_before;
  for (std::optional<Attempt> attempt = Attempt{tolerance_nm, {}}; attempt;) {
    ++outcome.num_attempts;
    std::optional<Mismatch> mismatch;
    try {
      Cleaned cleaned = clean(sheets, options, *attempt, labels, conductors, progress);
      progress.at("verification", 0);
      mismatch = compare(reference, cleaned.census, conductors.model());
      if (!mismatch) {
        warn_of_contacts(reference, sheets, cleaned, labels, conductors, diagnostics, progress);
        outcome.result =
            finished(conductors.model(), sheets, reference, cleaned, *attempt, outcome.num_attempts, labels, progress);
        return outcome;
      }
      const Spot spot = locate(*mismatch, sheets, cleaned, labels, conductors, progress);
      outcome.failure.emplace(
          ErrorCode::overlay_topology,
          mismatch->text +
              "; the layout has a gap or a neck there that is too small to be meshed: widen it, or give a smaller tolerance",
          spot);
      diagnostics.note("overlay.retry", fmt::format("tolerance {}: {}", format_length(attempt->tolerance_nm), mismatch->text),
                       spot);
      outcome.finest = std::move(cleaned.census);
    } catch (const Error& error) {
      if (error.code() != ErrorCode::overlay_no_fixpoint) throw;
      diagnostics.note("overlay.retry", fmt::format("tolerance {}: {}", format_length(attempt->tolerance_nm), error.text()),
                       error.spot());
      outcome.failure = error;
      outcome.finest.reset();
    }
    attempt = next_attempt(*attempt, tolerance_nm, mismatch, conductors.model());
  }
  return outcome;
}

}  // namespace

OverlayResult overlay(const model::Model& model, const OverlayOptions& options, Diagnostics& diagnostics,
                      const Progress& progress) {
  const Nm tolerance_nm = first_tolerance(model, options);
  LabelPool labels;
  const Conductors conductors(model);
  const Sheets sheets = make_sheets(model, labels, conductors, diagnostics, progress);
  Outcome strict = attempt_all(tolerance_nm, 0, sheets, sheets.exact, options, labels, conductors, diagnostics, progress);
  if (strict.result) return std::move(*strict.result);
  if (!strict.finest || strict.finest->touching != sheets.exact.touching) throw strict.failure.value();

  // Layouts hold necks and gaps of a fraction of a micrometre inside one net: fills that graze each other, rings that touch in
  // a point. No factory makes them. So the layout as the least tolerance shows it becomes the reference, and the place is
  // named.
  diagnostics.warn("overlay.contact_within_net",
                   strict.failure->text() + "; until then the layout is taken as it is after snapping", strict.failure->spot());
  const Census reference = std::move(*strict.finest);
  Outcome outcome =
      attempt_all(tolerance_nm, strict.num_attempts, sheets, reference, options, labels, conductors, diagnostics, progress);
  if (!outcome.result) throw outcome.failure.value();
  return std::move(*outcome.result);
}

}  // namespace pcbmesh::overlay
