// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "pcbmesh/layering/quality_report.hpp"

namespace pcbmesh::cli {

/// Groups, histograms and the worst prisms, as report.json has them.
[[nodiscard]] nlohmann::ordered_json quality_json(const layering::QualityReport& report);
/// The same as tables for a terminal.
[[nodiscard]] std::string quality_text(const layering::QualityReport& report);

}  // namespace pcbmesh::cli
