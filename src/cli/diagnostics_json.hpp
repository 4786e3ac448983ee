// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>

#include "pcbmesh/base/diagnostics.hpp"

namespace pcbmesh::cli {

/// An array with one object per kind of message: severity, code, text, count, places.
[[nodiscard]] nlohmann::ordered_json diagnostics_json(const Diagnostics& diagnostics);

}  // namespace pcbmesh::cli
