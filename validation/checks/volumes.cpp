// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>

#include "validation/checks/checks.hpp"
#include "validation/checks/parallel.hpp"

namespace pcbmesh::validation::checks {
namespace {

constexpr double relative_tolerance = 1e-9;

bool agree(double a, double b) {
  return std::abs(a - b) <= relative_tolerance * std::max(std::abs(a), std::abs(b));
}

struct Enclosed {
  double volume = 0;     ///< by the divergence theorem over the boundary
  double magnitude = 0;  ///< sum of the terms' magnitudes: what rounding is relative to
};

Enclosed enclosed_volume(const Context& context, const FaceMatch& match) {
  Vector3 middle{};
  for (std::size_t axis = 0; axis < 3; ++axis) middle[axis] = 0.5 * (context.low[axis] + context.high[axis]);
  const auto num_faces = static_cast<std::int64_t>(match.boundary.size());
  std::vector<std::array<double, 2>> slices(static_cast<std::size_t>((num_faces + slice_length - 1) / slice_length));
  for_each_slice(context.num_threads, num_faces, [&](int, std::int64_t slice, std::int64_t first, std::int64_t last) {
    CompensatedSum sum;
    double magnitude = 0;
    std::array<std::int64_t, 4> corners{};
    for (std::int64_t i = first; i < last; ++i) {
      const int n = context.corners_of_half_face(match.boundary[static_cast<std::size_t>(i)], corners);
      const auto at = [&](std::size_t k) { return context.mesh.nodes[static_cast<std::size_t>(corners[k])] - middle; };
      const double six = n == 3 ? flux(at(0), at(1), at(2)) : flux(at(0), at(1), at(2), at(3));
      sum.add(six);
      magnitude += std::abs(six);
    }
    slices[static_cast<std::size_t>(slice)] = {sum.value(), magnitude};
  });
  CompensatedSum total;
  Enclosed result;
  for (const auto& [six, magnitude] : slices) {
    total.add(six);
    result.magnitude += magnitude / 6;
  }
  result.volume = total.value() / 6;
  return result;
}

void compare_group(const Context& context, const Expectation::Volume& expected, const VolumeSums& sums, CheckLog& log) {
  const int slot = context.cell_tags.slot(expected.tag);
  if (slot < 0) return;  // check_tags reports it
  const auto s = static_cast<std::size_t>(slot);
  if (expected.num_cells >= 0 && expected.num_cells != sums.cells_of_tag[s]) {
    log.found("volume.cell_count", FindingSeverity::error,
              fmt::format("group {} '{}' has {} cells, tags.json says {}", expected.tag, expected.name, sums.cells_of_tag[s],
                          expected.num_cells),
              std::abs(expected.num_cells - sums.cells_of_tag[s]));
  }
  if (expected.volume_m3 < 0 || !context.has_geometry) return;
  const double unit = context.expectation->unit_m;
  const double found = sums.of_tag[s] * unit * unit * unit;
  if (agree(found, expected.volume_m3)) return;
  log.found("volume.wrong", FindingSeverity::error,
            fmt::format("group {} '{}' fills {:.12g} m3, tags.json says {:.12g} m3 (off by {:.3g} relative)", expected.tag,
                        expected.name, found, expected.volume_m3, found / expected.volume_m3 - 1));
}

}  // namespace

void check_volumes(const Context& context, const FaceMatch& match, const VolumeSums& sums, Report& report) {
  CheckLog log(report, context, "volumes");
  if (context.has_geometry && context.num_cells() > 0) {
    const Enclosed enclosed = enclosed_volume(context, match);
    // Thin shells have terms that nearly cancel; 1e-14 of their magnitude is rounding, not a finding.
    const double slack = relative_tolerance * std::abs(sums.total) + 1e-14 * enclosed.magnitude;
    if (!(std::abs(enclosed.volume - sums.total) <= slack)) {
      log.found(
          "volume.not_enclosed", FindingSeverity::error,
          fmt::format("the cells fill {:.12g}, but their boundary encloses {:.12g} cubed units", sums.total, enclosed.volume));
    }
  }
  log.examined(context.cell_tags.size());
  for (int slot = 0; slot < context.cell_tags.size(); ++slot) {
    const auto s = static_cast<std::size_t>(slot);
    const std::int32_t tag = context.cell_tags.tag(slot);
    report.volumes.push_back({tag, context.name_of(3, tag), sums.cells_of_tag[s], sums.of_tag[s]});
  }
  if (context.expectation == nullptr) return;
  for (const auto& expected : context.expectation->volumes) compare_group(context, expected, sums, log);
}

}  // namespace pcbmesh::validation::checks
