// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/layering/divide_layers.hpp"

namespace pcbmesh::layering {
namespace {

constexpr double speed_of_light_m_per_s = 299'792'458.0;
constexpr double vacuum_permeability = 4e-7 * std::numbers::pi;
constexpr double default_growth = 2;
/// From one terminal of an upright port to the other, where the study does not say. The line beside it wants them: over one
/// lowest edge element of dielectric it errs three times as much as over two (docs/evidence/ports.md).
constexpr int least_elements_of_port = 2;

double skin_depth_m(const board::Material& metal, double frequency_hz, const model::Slab& slab) {
  if (metal.sigma_s_per_m > 0)
    return 1.0 / std::sqrt(std::numbers::pi * frequency_hz * vacuum_permeability * metal.mu_r * metal.sigma_s_per_m);
  Spot spot;
  spot.layer = slab.layer;
  throw Error(ErrorCode::layering_invalid,
              fmt::format("the skin depth is asked for, but '{}' has conductivity {} S/m; give its sigma in the board file, or "
                          "leave out --skin-depth-layers",
                          metal.name, metal.sigma_s_per_m),
              spot);
}

}  // namespace

double slowness(const model::Model& model, const model::Slab& slab) {
  double slowest = 1;
  for (const std::int32_t material : {slab.material, slab.outside}) {
    if (material < 0) continue;
    const board::Material& m = model.materials()[static_cast<std::size_t>(material)];
    slowest = std::max(slowest, m.eps_r * m.mu_r);
  }
  return std::sqrt(slowest);
}

std::vector<SlabLimits> slab_limits(const model::Model& model, const study::Study& study) {
  const study::HeightBounds& bounds = study.height_bounds;
  const std::optional<double> frequency_hz = study::highest_frequency_hz(study);
  std::vector<SlabLimits> limits(model.slabs().size());
  for (std::size_t s = 0; s < limits.size(); ++s) {
    const model::Slab& slab = model.slabs()[s];
    if (frequency_hz)
      limits[s].wavelength_height_m =
          speed_of_light_m_per_s / *frequency_hz / slowness(model, slab) / bounds.elements_per_wavelength;
    if (slab.kind == model::SlabKind::dielectric) limits[s].least_count = bounds.elements_per_dielectric.value_or(1);
  }
  for (const model::Port& port : model.ports()) {
    if (port.faces != model::PortFaces::wall) continue;
    const model::Body& body = model.bodies()[static_cast<std::size_t>(port.body)];
    const std::int32_t num_slabs = body.last_slab - body.first_slab + 1;
    for (std::int32_t s = body.first_slab; s <= body.last_slab; ++s) {
      const model::Slab& slab = model.slabs()[static_cast<std::size_t>(s)];
      const double height_m = static_cast<double>(slab.z_top_nm - slab.z_bottom_nm) * metres_per_nm;
      int& count = limits[static_cast<std::size_t>(s)].port_count;
      if (!port.is_wave && port.longest_edge_m == 0)
        count = std::max(count, (least_elements_of_port + num_slabs - 1) / num_slabs);
      if (port.longest_edge_m > 0) count = std::max(count, static_cast<int>(std::ceil(height_m / port.longest_edge_m - 1e-9)));
    }
  }
  if (!bounds.skin_depth_layers || !frequency_hz) return limits;
  // Hollow copper and sheets hold no field, so they ask for nothing; barrels are upright walls, which heights do not resolve.
  for (const model::Body& body : model.bodies()) {
    if (body.kind != model::BodyKind::copper || body.hollow || body.sheet || body.material < 0) continue;
    for (std::int32_t s = body.first_slab; s <= body.last_slab; ++s) {
      SlabLimits& limit = limits[static_cast<std::size_t>(s)];
      const double depth = skin_depth_m(model.materials()[static_cast<std::size_t>(body.material)], *frequency_hz,
                                        model.slabs()[static_cast<std::size_t>(s)]);
      limit.skin_depth_m = limit.skin_depth_m > 0 ? std::min(limit.skin_depth_m, depth) : depth;
    }
  }
  // h (1 + r + ... + r^(n-1)) = depth
  const double r = bounds.height_growth.value_or(default_growth);
  for (SlabLimits& limit : limits)
    if (limit.skin_depth_m > 0)
      limit.face_height_m = limit.skin_depth_m * (r - 1) / (std::pow(r, *bounds.skin_depth_layers) - 1);
  return limits;
}

}  // namespace pcbmesh::layering
