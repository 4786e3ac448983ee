// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>

#include "pcbmesh/base/diagnostics.hpp"
#include "pcbmesh/pipeline/forecast.hpp"

namespace pcbmesh::cli {

/// Sizes, unknowns by order, and solver memory.
[[nodiscard]] nlohmann::ordered_json forecast_json(const pipeline::Forecast& forecast);

/// What was taken because the input does not state it.
[[nodiscard]] nlohmann::ordered_json assumptions_json(const Diagnostics& diagnostics);

}  // namespace pcbmesh::cli
