// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/layering/divide_layers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "pcbmesh/base/error.hpp"

namespace pcbmesh::layering {
namespace {

constexpr std::int64_t most_sublayers_of_slab = 1'000'000;
constexpr std::int64_t most_sublayers = 10'000'000;
// Heights come from divisions: a ratio that falls an ulp beyond must not cost a sub-layer.
constexpr double tolerance = 1e-9;
constexpr double default_growth = 2;

double height_nm(const model::Slab& slab) {
  return static_cast<double>(slab.z_top_nm - slab.z_bottom_nm);
}

void require_count(double count, std::int64_t already, const model::Slab& slab) {
  if (count <= static_cast<double>(most_sublayers_of_slab) &&
      static_cast<double>(already) + count <= static_cast<double>(most_sublayers))
    return;
  Spot spot;
  spot.layer = slab.layer;
  throw Error(ErrorCode::layering_invalid,
              fmt::format("the layer would be cut into {:.0f} sub-layers, more than {} for a layer or {} for the stack; use a "
                          "larger common height (another height policy), sub-layer rule none or weaker bounds on heights",
                          count, most_sublayers_of_slab, most_sublayers),
              spot);
}

/// Count of equal sub-layers of one slab and what asked for it; the policy wins a tie.
std::pair<int, HeightCause> equal_count(double height_m, int policy_count, const SlabLimits& limits, const model::Slab& slab) {
  std::pair<int, HeightCause> out{policy_count, policy_count > 1 ? HeightCause::policy : HeightCause::slab};
  if (limits.least_count > out.first) out = {limits.least_count, HeightCause::across};
  if (limits.port_count > out.first) out = {limits.port_count, HeightCause::port};
  const double by_wavelength = std::ceil(height_m / limits.wavelength_height_m - tolerance);
  require_count(by_wavelength, 0, slab);
  if (by_wavelength > out.first) out = {static_cast<int>(by_wavelength), HeightCause::wavelength};
  require_count(out.first, 0, slab);
  return out;
}

/// Heights of the sub-layers of all slabs, nanometres, with grading across slab faces.
class Grading {
 public:
  Grading(std::span<const model::Slab> slabs, std::span<const SlabLimits> limits, std::span<const int> counts, double growth)
      : slabs_(slabs), growth_(growth), bottom_(slabs.size()), top_(slabs.size()), most_(slabs.size()), heights_(slabs.size()) {
    for (std::size_t s = 0; s < slabs.size(); ++s) {
      most_[s] = height_nm(slabs[s]) / counts[s];
      bottom_[s] = top_[s] = std::min(most_[s], limits[s].face_height_m / metres_per_nm);
      divide(s);
    }
    // Every pass lowers a bound at a face by at least the tolerance, and low sub-layers spread outwards at once; counts are
    // capped, so it ends.
    for (bool changed = true; changed;) {
      changed = false;
      for (std::size_t s = 1; s < slabs.size(); ++s)
        changed |= lower_to(s, bottom_[s], heights_[s].front(), heights_[s - 1].back());
      for (std::size_t s = slabs.size(); s-- > 1;)
        changed |= lower_to(s - 1, top_[s - 1], heights_[s - 1].back(), heights_[s].front());
    }
  }
  [[nodiscard]] const std::vector<double>& heights(std::size_t slab) const { return heights_[slab]; }

 private:
  bool lower_to(std::size_t slab, double& bound, double height, double neighbour) {
    if (height <= growth_ * neighbour * (1 + tolerance)) return false;
    bound = growth_ * neighbour;
    divide(slab);
    return true;
  }
  void divide(std::size_t s) {
    const double height = height_nm(slabs_[s]);
    // Never more than geometric steps from both faces and whole heights between.
    require_count(height / most_[s] + 2 * std::log(most_[s] / std::min(bottom_[s], top_[s])) / std::log(growth_), 0, slabs_[s]);
    heights_[s] = graded_heights(height, bottom_[s], top_[s], most_[s], growth_);
  }

  std::span<const model::Slab> slabs_;
  double growth_;
  std::vector<double> bottom_, top_, most_;
  std::vector<std::vector<double>> heights_;
};

}  // namespace

std::string_view name_of(HeightCause cause) {
  switch (cause) {
    case HeightCause::slab:
      return "slab";
    case HeightCause::policy:
      return "policy";
    case HeightCause::wavelength:
      return "wavelength";
    case HeightCause::across:
      return "across";
    case HeightCause::port:
      return "port";
    case HeightCause::skin_depth:
      return "skin_depth";
    case HeightCause::growth:
      return "growth";
  }
  return "?";
}

std::vector<int> least_counts(std::span<const model::Slab> slabs, std::span<const SlabLimits> limits) {
  std::vector<int> counts;
  for (std::size_t s = 0; s < slabs.size(); ++s)
    counts.push_back(equal_count(height_nm(slabs[s]) * metres_per_nm, 1, limits[s], slabs[s]).first);
  return counts;
}

std::vector<double> graded_heights(double height, double bottom, double top, double most, double growth) {
  // Sub-layers of equal weight in a field of heights whose slope is at most g = ln(growth): neighbours then differ at most by
  // `growth`. At a face the field starts so that the first sub-layer, which reaches into higher field, still obeys its bound.
  const double g = std::log(growth), start = g / (growth - 1);
  const double low = bottom < most ? bottom * start : most, high = top < most ? top * start : most;
  double rise = (most - low) / g, fall = height - (most - high) / g;  // where the field reaches `most` and leaves it
  if (rise > fall) rise = fall = std::clamp(0.5 * (height + (high - low) / g), 0.0, height);
  const double rising = std::log1p(g * rise / low) / g, flat = (fall - rise) / most;
  const double weight = rising + flat + std::log1p(g * (height - fall) / high) / g;
  const double count = std::max(1.0, std::ceil(weight - tolerance));
  std::vector<double> heights;
  double z = 0;
  for (double k = 1; k <= count; ++k) {
    const double x = weight * k / count;
    double next = height;
    if (k < count && x <= rising)
      next = low * std::expm1(g * x) / g;
    else if (k < count && x <= rising + flat)
      next = rise + (x - rising) * most;
    else if (k < count)
      next = height - high * std::expm1(g * (weight - x)) / g;
    heights.push_back(next - z);
    z = next;
  }
  return heights;
}

DividedLayers divide_layers(std::span<const model::Slab> slabs, std::span<const int> counts, std::span<const SlabLimits> limits,
                            std::optional<double> growth) {
  if (slabs.empty()) throw Error(ErrorCode::layering_invalid, "the domain has no layers to cut");
  std::vector<int> equal;
  std::vector<HeightCause> causes;
  bool is_graded = growth.has_value();
  for (std::size_t s = 0; s < slabs.size(); ++s) {
    const auto [count, cause] = equal_count(height_nm(slabs[s]) * metres_per_nm, counts[s], limits[s], slabs[s]);
    equal.push_back(count);
    causes.push_back(cause);
    is_graded = is_graded || std::isfinite(limits[s].face_height_m);
  }
  std::optional<Grading> grading;
  if (is_graded) grading.emplace(slabs, limits, equal, growth.value_or(default_growth));

  mesh::LayerPlanParts parts;
  std::vector<LayerChoice> choices;
  parts.z_m.push_back(static_cast<double>(slabs.front().z_bottom_nm) * metres_per_nm);
  for (std::size_t s = 0; s < slabs.size(); ++s) {
    const auto bottom = static_cast<double>(slabs[s].z_bottom_nm);
    const int count = grading ? static_cast<int>(grading->heights(s).size()) : equal[s];
    require_count(count, static_cast<std::int64_t>(parts.slab.size()), slabs[s]);
    double z_nm = bottom;
    LayerChoice choice{slabs[s].layer, height_nm(slabs[s]) * metres_per_nm, counts[s], count, 1e300, 0, causes[s], limits[s]};
    // More sub-layers than equal ones: grading did it, for the copper's own faces or for a neighbour.
    if (count > equal[s]) choice.cause = std::isfinite(limits[s].face_height_m) ? HeightCause::skin_depth : HeightCause::growth;
    for (int k = 1; k <= count; ++k) {
      z_nm = grading ? z_nm + grading->heights(s)[static_cast<std::size_t>(k - 1)] : bottom + height_nm(slabs[s]) * k / count;
      // Faces of slabs are exact.
      parts.z_m.push_back((k == count ? static_cast<double>(slabs[s].z_top_nm) : z_nm) * metres_per_nm);
      parts.slab.push_back(static_cast<std::int32_t>(s));
      const double height = parts.z_m.back() - *(parts.z_m.end() - 2);
      choice.lowest_m = std::min(choice.lowest_m, height);
      choice.highest_m = std::max(choice.highest_m, height);
    }
    choices.push_back(std::move(choice));
  }
  return {mesh::LayerPlan::from_parts(std::move(parts)), std::move(choices)};
}

}  // namespace pcbmesh::layering
