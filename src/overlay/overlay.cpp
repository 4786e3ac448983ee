// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/overlay/overlay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "src/overlay/blunting.hpp"
#include "src/overlay/collapse.hpp"
#include "src/overlay/ledger.hpp"
#include "src/overlay/match_sides.hpp"
#include "src/overlay/noding.hpp"
#include "src/overlay/sheets.hpp"
#include "src/overlay/verify.hpp"

namespace pcbmesh::overlay {
namespace {

constexpr Nm least_tolerance = nm_per_um;
constexpr int most_blunt_rounds = 6;
constexpr double most_area_error = 0.02;

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
  if (options.coarsest_auto_nm) tolerance = std::min(tolerance, *options.coarsest_auto_nm);
  return std::max(tolerance, least_tolerance);
}

/// One try: the tolerance, and the bodies that an earlier try showed to be too delicate for blunting.
struct Attempt {
  Nm tolerance_nm = 0;
  std::vector<std::int32_t> spared;
  bool blunts = true;
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
  Noder noder(overlaid(graphs, labels), labels, attempt.tolerance_nm, progress, conductors.model().first_guide_body());
  noder.settle();
  const BluntLimits tips{attempt.blunts ? options.blunt_angle_deg : 0, options.blunt_width_over_tolerance * tol,
                         attempt.spared};
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
    spot.layer = body.sheet ? body.sheet->layer : model.slabs()[ix(body.first_slab)].layer;
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

mesh::PlanarGraph to_planar_graph(const EdgeGraph& graph, const LabelPool& labels, const model::Model& model, Nm tolerance_nm) {
  mesh::PlanarGraphParts parts;
  parts.vertices = graph.points;
  match_sides(parts.vertices, model, tolerance_nm);
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

/// Bodies that mismatches are about, ascending.
std::vector<std::int32_t> bodies_of(const std::vector<Mismatch>& mismatches, const model::Model& model) {
  std::vector<std::int32_t> bodies;
  for (const Mismatch& mismatch : mismatches) {
    if (mismatch.body >= 2) bodies.push_back(mismatch.body);
    for (std::size_t b = 2; b < model.bodies().size(); ++b) {
      const std::int32_t net = model.bodies()[b].net;
      const bool named = mismatch.nets && (net == (*mismatch.nets)[0] || net == (*mismatch.nets)[1]);
      if (named || (net >= 0 && net == mismatch.net)) bodies.push_back(static_cast<std::int32_t>(b));
    }
  }
  std::ranges::sort(bodies);
  bodies.erase(std::unique(bodies.begin(), bodies.end()), bodies.end());
  return bodies;
}

/// 3/4, 1/2, 1/4 ... of the first tolerance, at last a micrometre without blunting; nullopt when none is left.
std::optional<Attempt> smaller_attempt(const Attempt& last, Nm first_tolerance_nm) {
  const Nm three_quarters = first_tolerance_nm * 3 / 4;
  const Nm smaller = last.tolerance_nm > three_quarters    ? three_quarters
                     : last.tolerance_nm == three_quarters ? first_tolerance_nm / 2
                                                           : last.tolerance_nm / 2;
  if (smaller >= least_tolerance) return Attempt{smaller, {}};
  if (last.tolerance_nm > least_tolerance) return Attempt{least_tolerance, {}};
  // What the probe of accept_what_no_tolerance_keeps() does, so this holds where anything does.
  if (last.blunts) return Attempt{last.tolerance_nm, {}, false};
  return std::nullopt;
}

/// The attempts, and what they are measured by.
class Attempts {
 public:
  Attempts(const model::Model& model, const OverlayOptions& options, const Sheets& sheets, LabelPool& labels,
           const Conductors& conductors, Diagnostics& diagnostics, const Progress& progress)
      : model_(model),
        options_(options),
        sheets_(sheets),
        labels_(labels),
        conductors_(conductors),
        diagnostics_(diagnostics),
        progress_(progress),
        expected_(sheets.exact) {}

  OverlayResult run(Nm first_tolerance_nm) {
    std::optional<Error> failure;
    std::optional<Attempt> attempt = Attempt{first_tolerance_nm, {}};
    for (int num_attempts = 1; attempt; ++num_attempts) {
      try {
        const Cleaned cleaned = clean(sheets_, options_, *attempt, labels_, conductors_, progress_);
        progress_.at("verification", 0);
        std::vector<Mismatch> mismatches = compare(expected_, cleaned.census, model_);
        const std::vector<std::int32_t> delicate =
            options_.blunt_angle_deg > 0 ? bodies_of(mismatches, model_) : std::vector<std::int32_t>{};
        const bool can_spare = attempt->blunts && attempt->spared.empty() && !delicate.empty();
        if (!mismatches.empty() && !can_spare && accept_what_no_tolerance_keeps())
          mismatches = compare(expected_, cleaned.census, model_);
        if (mismatches.empty()) {
          const std::vector<double> area_mm2 = areas_mm2(cleaned.graph, labels_, model_.bodies().size());
          // Topology holds. If areas do not, one somewhat smaller tolerance is worth a try: which of two outlines gives way is
          // luck.
          const Nm somewhat_smaller = first_tolerance_nm * 17 / 20;
          if (attempt->tolerance_nm == first_tolerance_nm && somewhat_smaller >= least_tolerance && !is_faithful(area_mm2)) {
            diagnostics_.note("overlay.retry",
                              fmt::format("tolerance {}: one body in a hundred changes its area by more than {} %",
                                          format_length(attempt->tolerance_nm), 100 * most_area_error));
            attempt = Attempt{somewhat_smaller, {}};
            continue;
          }
          warn_of_contacts(cleaned);
          OverlayResult result = finished(cleaned, area_mm2, *attempt, num_attempts);
          result.statistics.first_tolerance_nm = first_tolerance_nm;
          return result;
        }
        const Spot spot = locate(mismatches.front(), sheets_, cleaned, labels_, conductors_, progress_);
        failure = refusal(mismatches.front(), spot);
        diagnostics_.note("overlay.retry",
                          fmt::format("tolerance {}: {}", format_length(attempt->tolerance_nm), mismatches.front().text), spot);
        // Blunting is given up for the bodies concerned first: that costs the rest of the board nothing.
        if (can_spare) {
          attempt->spared = delicate;
          continue;
        }
      } catch (const Error& error) {
        if (error.code() != ErrorCode::overlay_no_fixpoint) throw;
        diagnostics_.note("overlay.retry", fmt::format("tolerance {}: {}", format_length(attempt->tolerance_nm), error.text()),
                          error.spot());
        failure = error;
      }
      attempt = smaller_attempt(*attempt, first_tolerance_nm);
    }
    throw failure.value();
  }

 private:
  OverlayResult finished(const Cleaned& cleaned, const std::vector<double>& area_mm2, const Attempt& attempt,
                         int num_attempts) const {
    OverlayResult result{to_planar_graph(cleaned.graph, labels_, model_, attempt.tolerance_nm),
                         make_ledger(model_, sheets_, cleaned.graph, area_mm2, labels_, attempt.tolerance_nm, progress_),
                         {},
                         expected_.pieces,
                         {}};
    for (const NetPair& pair : sheets_.exact.touching) {
      if (pair[0] >= 0) result.touching_nets.push_back(pair);
    }
    result.statistics.tolerance_nm = attempt.tolerance_nm;
    result.statistics.attempts = num_attempts;
    result.statistics.num_input_vertices = sheets_.num_input_vertices;
    result.statistics.num_snapped = cleaned.counts.num_snapped;
    result.statistics.num_crossings = cleaned.counts.num_crossings;
    result.statistics.num_passes = cleaned.counts.num_passes;
    measure_areas(model_, sheets_, area_mm2, result.statistics);
    return result;
  }

  /// Do 99 of 100 copper bodies keep their area?
  [[nodiscard]] bool is_faithful(const std::vector<double>& area_mm2) const {
    std::vector<double> errors;
    for (std::size_t b = 0; b < area_mm2.size(); ++b) {
      if (model_.bodies()[b].kind == model::BodyKind::copper && sheets_.area_mm2[b] > 0)
        errors.push_back(std::abs(area_mm2[b] / sheets_.area_mm2[b] - 1));
    }
    if (errors.empty()) return true;
    const auto place = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() * 99 / 100);
    std::ranges::nth_element(errors, place);
    return *place <= most_area_error;
  }

  /// Nets that meet in the layout itself (net ties, drawing errors) are meshed as drawn, and named.
  void warn_of_contacts(const Cleaned& cleaned) {
    for (const NetPair& pair : sheets_.exact.touching) {
      if (pair[0] < 0) continue;  // copper without a net is nobody's short
      Mismatch contact;
      contact.nets = pair;
      diagnostics_.warn("overlay.touching_nets",
                        fmt::format("nets {} and {} touch or overlap in the layout itself; they are meshed as drawn",
                                    model_.net_name(pair[0]), model_.net_name(pair[1])),
                        locate(contact, sheets_, cleaned, labels_, conductors_, progress_));
    }
  }

  static Error refusal(const Mismatch& mismatch, const Spot& spot) {
    return {ErrorCode::overlay_topology,
            mismatch.text +
                "; the layout has a gap or a neck there that is too small to be meshed: widen it, or give a smaller tolerance",
            spot};
  }

  /// Gaps and necks below the least tolerance cannot be kept. Between two nets that is an error, told at once; within one net
  /// it is worth a warning, and the rest of the board must not pay for it.
  /// @return true if something else is expected now.
  bool accept_what_no_tolerance_keeps() {
    if (probed_) return false;
    probed_ = true;
    const Nm least = std::min(least_tolerance, options_.tolerance_nm.value_or(least_tolerance));
    const Cleaned probe = clean(sheets_, options_, {least, {}, false}, labels_, conductors_, progress_);
    const std::vector<Mismatch> lost = compare(expected_, probe.census, model_);
    for (const Mismatch& mismatch : lost) {
      const Spot spot = locate(mismatch, sheets_, probe, labels_, conductors_, progress_);
      if (mismatch.nets) throw refusal(mismatch, spot);
      diagnostics_.warn("overlay.parts_joined", mismatch.text + "; gaps and necks below 1 um within one net are not kept",
                        spot);
    }
    expected_ = probe.census;
    return !lost.empty();
  }

  const model::Model& model_;
  const OverlayOptions& options_;
  const Sheets& sheets_;
  LabelPool& labels_;
  const Conductors& conductors_;
  Diagnostics& diagnostics_;
  const Progress& progress_;
  Census expected_;
  bool probed_ = false;
};

}  // namespace

OverlayResult overlay(const model::Model& model, const OverlayOptions& options, Diagnostics& diagnostics,
                      const Progress& progress) {
  const Nm tolerance_nm = first_tolerance(model, options);
  LabelPool labels;
  const Conductors conductors(model);
  const Sheets sheets = make_sheets(model, labels, conductors, diagnostics, progress);
  return Attempts(model, options, sheets, labels, conductors, diagnostics, progress).run(tolerance_nm);
}

}  // namespace pcbmesh::overlay
