// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/pipeline/match_quality.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/extrude/extrude.hpp"

namespace pcbmesh::pipeline {
namespace {

constexpr int most_meshes = 12;
/// Edges nearer than this give meshes that differ by no more than the order of the input does.
constexpr double same_edge = 0.004;
/// A mesh of so many triangles is made without asking; beyond, at most so many times those of the finest so far.
constexpr double free_triangles = 50'000, most_stride = 8;
/// A proposal that promises less than this is not tried.
constexpr double least_gain = 0.01;

/// How far the prediction, which knows no voids and no grading, lies off the last mesh; learnt from every mesh.
struct Correction {
  double mean = 1, by_volume = 1, prisms = 1;  ///< measured over predicted
  double unknowns_per_prism = 2.2;
};

class Matching {
 public:
  Matching(const overlay::OverlayResult& graph, const model::Model& model, const study::Study& study,
           const triangulate::TriangulateOptions& options, std::span<const layering::SlabLimits> limits,
           const Progress& progress)
      : graph_(graph),
        model_(model),
        study_(study),
        options_(options),
        limits_(limits),
        progress_(progress),
        least_(layering::least_counts(model.slabs(), limits)),
        shape_(layering::triangle_shape(study.seed, study.smooth)) {
    for (const model::Slab& slab : model.slabs())
      layers_m_.push_back(static_cast<double>(slab.z_top_nm - slab.z_bottom_nm) * metres_per_nm);
  }

  MatchedMesh run(triangulate::TriangulateResult first, Diagnostics& diagnostics) {
    measure(options_.longest_edge_nm * metres_per_nm, std::move(first), {});
    while (static_cast<int>(result_.steps.size()) < most_meshes) {
      const std::optional<double> edge_m = propose();
      if (!edge_m) break;
      progress_.at("match quality", static_cast<double>(result_.steps.size()) / most_meshes);
      options_.longest_edge_nm = *edge_m / metres_per_nm;
      Diagnostics words;  // of this mesh alone: only the chosen one's are told
      triangulate::TriangulateResult planar = triangulate::triangulate(graph_.graph, model_, options_, words, progress_);
      measure(*edge_m, std::move(planar), std::move(words));
    }
    if (!best_) refuse();
    result_.front = front(most_prisms());
    if (result_.front.empty()) result_.front = front(1e300);
    result_.knee = layering::knee_of(result_.front);
    diagnostics.merge(best_words_);
    return {std::move(*best_), std::move(best_counts_), result_.steps[result_.chosen].longest_edge_m, std::move(result_)};
  }

 private:
  [[nodiscard]] double most_prisms() const { return static_cast<double>(study_.max_prisms); }
  [[nodiscard]] double budget_prisms() const {
    double most = most_prisms();
    const study::MatchGoal& goal = study_.match;
    if (goal.budget_prisms) most = std::min(most, static_cast<double>(*goal.budget_prisms));
    if (goal.budget_unknowns)
      most = std::min(most, static_cast<double>(*goal.budget_unknowns) / correction_.unknowns_per_prism);
    return most;
  }
  [[nodiscard]] double corrected(const layering::PlanQuality& quality) const {
    return std::min(quality.mean * correction_.mean, quality.by_volume * correction_.by_volume);
  }
  [[nodiscard]] std::vector<layering::FrontPoint> front(double most) const {
    return layering::pareto_front(measured_, layers_m_, least_, shape_, extra_, most / correction_.prisms);
  }

  /// The front's point for the goal: fewest prisms that reach the target, else best within the budget, else the knee.
  [[nodiscard]] std::optional<layering::FrontPoint> wanted() const {
    const std::vector<layering::FrontPoint> points = front(budget_prisms());
    if (points.empty()) return std::nullopt;
    if (study_.match.target_quality) {
      for (const layering::FrontPoint& point : points)
        if (corrected(point.choice.quality) >= *study_.match.target_quality + margin_) return point;
      return points.back();
    }
    if (study_.match.budget_prisms || study_.match.budget_unknowns) return points.back();
    return points[layering::knee_of(points)];
  }

  /// Longest edge of the next mesh; nothing where no proposal promises more than the best mesh so far.
  std::optional<double> propose() {
    for (int attempt = 0; attempt < 8; ++attempt) {
      const std::optional<layering::FrontPoint> point = wanted();
      if (!point) return std::nullopt;
      const bool is_known = std::any_of(measured_.begin(), measured_.end(), [&](const layering::MeasuredEdge& m) {
        return std::abs(std::log(m.longest_edge_m / point->longest_edge_m)) < same_edge;
      });
      if (!is_known) return best_ && !promises_more(*point) ? std::nullopt : std::optional(no_leap_to(*point));
      if (best_) return std::nullopt;
      margin_ += 0.003;  // made, measured, and just short: aim a little higher
    }
    return std::nullopt;
  }
  /// Predictions far from every mesh err; a leap to a large one is made in strides.
  [[nodiscard]] double no_leap_to(const layering::FrontPoint& point) const {
    const layering::MeasuredEdge& finest = *std::min_element(
        measured_.begin(), measured_.end(), [](const auto& a, const auto& b) { return a.longest_edge_m < b.longest_edge_m; });
    const double known = std::max(free_triangles, most_stride * static_cast<double>(finest.heights.num_triangles));
    if (point.triangles <= known) return point.longest_edge_m;
    return point.longest_edge_m * std::sqrt(point.triangles / known);
  }
  [[nodiscard]] bool promises_more(const layering::FrontPoint& point) const {
    const MatchStep& best = result_.steps[result_.chosen];
    if (study_.match.target_quality)
      return point.prisms * correction_.prisms < (1 - least_gain) * static_cast<double>(best.prisms);
    if (study_.match.budget_prisms || study_.match.budget_unknowns)
      return corrected(point.choice.quality) > std::min(best.mean_prism, best.volume_weighted_prism) + 0.1 * least_gain;
    return std::abs(std::log(point.longest_edge_m / best.longest_edge_m)) > 0.05 && result_.steps.size() < 4;
  }

  /// Counts on the mesh itself: the fewest sub-layers for the target, or the best that the budget allows.
  [[nodiscard]] std::optional<layering::CountChoice> counts_on(const layering::HeightStatistics& heights,
                                                               double knee_prisms) const {
    std::vector<layering::CountChoice> choices = layering::best_counts(heights, layers_m_, least_);
    const auto triangles = static_cast<double>(heights.num_triangles);
    const double most = std::min(budget_prisms(), knee_prisms);
    std::optional<layering::CountChoice> best;
    for (layering::CountChoice& choice : choices) {
      const bool fits = triangles * (choice.num_sublayers + extra_) * correction_.prisms <= most;
      if (best && !fits) break;
      best = std::move(choice);
      if (study_.match.target_quality && corrected(best->quality) >= *study_.match.target_quality) break;
    }
    return best;
  }

  void measure(double edge_m, triangulate::TriangulateResult planar, Diagnostics words) {
    measured_.push_back({edge_m, layering::height_statistics(planar.mesh)});
    const layering::HeightStatistics& heights = measured_.back().heights;
    double knee_prisms = most_prisms();
    if (study_.match == study::MatchGoal{}) {
      const std::optional<layering::FrontPoint> knee = wanted();
      if (knee) knee_prisms = 1.02 * knee->prisms;
    }
    const std::optional<layering::CountChoice> choice = counts_on(heights, knee_prisms);
    PCBMESH_ASSERT(choice.has_value());
    const layering::DividedLayers layers =
        layering::divide_layers(model_.slabs(), choice->counts, limits_, study_.height_bounds.height_growth);
    const mesh::PrismMesh prisms = extrude::extrude(planar.mesh, layers.plan, model_, graph_.net_pieces, graph_.touching_nets);
    const layering::QualityStatistics quality = layering::quality_statistics(prisms);

    MatchStep step{edge_m,
                   planar.mesh.num_triangles(),
                   layers.plan.num_sublayers(),
                   prisms.num_prisms(),
                   layering::num_edges(prisms),
                   quality.mean_prism,
                   quality.volume_weighted_prism,
                   false};
    extra_ = layers.plan.num_sublayers() - choice->num_sublayers;
    correction_.mean = quality.mean_prism / choice->quality.mean;
    correction_.by_volume = quality.volume_weighted_prism / choice->quality.by_volume;
    correction_.prisms =
        static_cast<double>(step.prisms) / (static_cast<double>(step.triangles) * static_cast<double>(step.sublayers));
    correction_.unknowns_per_prism = static_cast<double>(step.unknowns) / static_cast<double>(step.prisms);
    const study::MatchGoal& goal = study_.match;
    step.meets = step.prisms <= goal.budget_prisms.value_or(study_.max_prisms) && step.prisms <= study_.max_prisms &&
                 (!goal.budget_unknowns || step.unknowns <= *goal.budget_unknowns) &&
                 std::min(step.mean_prism, step.volume_weighted_prism) >= goal.target_quality.value_or(0);
    result_.steps.push_back(step);
    if (!step.meets || (best_ && !is_better(step))) return;
    result_.chosen = result_.steps.size() - 1;
    best_ = std::move(planar);
    best_counts_ = choice->counts;
    best_words_ = std::move(words);
  }
  [[nodiscard]] bool is_better(const MatchStep& step) const {
    const MatchStep& best = result_.steps[result_.chosen];
    const auto quality = [](const MatchStep& s) { return std::min(s.mean_prism, s.volume_weighted_prism); };
    if (study_.match.target_quality) return step.prisms < best.prisms;
    if (study_.match.budget_prisms || study_.match.budget_unknowns) return quality(step) > quality(best);
    return true;  // the knee of all that is known by now
  }

  [[noreturn]] void refuse() const {
    const auto quality = [](const MatchStep& s) { return std::min(s.mean_prism, s.volume_weighted_prism); };
    const auto& steps = result_.steps;
    const MatchStep& best =
        *std::max_element(steps.begin(), steps.end(), [&](const auto& a, const auto& b) { return quality(a) < quality(b); });
    const MatchStep& fewest =
        *std::min_element(steps.begin(), steps.end(), [](const auto& a, const auto& b) { return a.prisms < b.prisms; });
    throw Error(
        ErrorCode::target_unreachable,
        fmt::format("no mesh meets the goal of policy matched; of {} made, the best has quality {:.4f} (by volume {:.4f}) "
                    "with {} prisms, and the smallest {} prisms and {} edges; lower --target-quality, raise the budget or "
                    "--max-prisms, mesh a region, or weaken the bounds on heights",
                    steps.size(), best.mean_prism, best.volume_weighted_prism, best.prisms, fewest.prisms, fewest.unknowns));
  }

  const overlay::OverlayResult& graph_;
  const model::Model& model_;
  const study::Study& study_;
  triangulate::TriangulateOptions options_;
  std::span<const layering::SlabLimits> limits_;
  const Progress& progress_;
  std::vector<int> least_;
  layering::TriangleShape shape_;
  std::vector<double> layers_m_;
  std::vector<layering::MeasuredEdge> measured_;
  Correction correction_;
  int extra_ = 0;      ///< sub-layers that grading added to the last mesh
  double margin_ = 0;  ///< by which the prediction must exceed the target
  std::optional<triangulate::TriangulateResult> best_;
  std::vector<int> best_counts_;
  Diagnostics best_words_;
  MatchResult result_;
};

}  // namespace

MatchedMesh match_quality(const overlay::OverlayResult& graph, const model::Model& model, const study::Study& study,
                          triangulate::TriangulateOptions options, triangulate::TriangulateResult first,
                          std::span<const layering::SlabLimits> limits, Diagnostics& diagnostics, const Progress& progress) {
  return Matching(graph, model, study, options, limits, progress).run(std::move(first), diagnostics);
}

}  // namespace pcbmesh::pipeline
