// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/cli/diagnostics_json.hpp"

namespace pcbmesh::cli {

nlohmann::ordered_json diagnostics_json(const Diagnostics& diagnostics) {
  using Json = nlohmann::ordered_json;
  Json out = Json::array();
  for (const Diagnostic& d : diagnostics.entries()) {
    Json spots = Json::array();
    for (const Spot& spot : d.spots) spots.push_back(spot.text());
    out.push_back({{"severity", d.severity == Severity::warning ? "warning" : "note"},
                   {"code", d.code},
                   {"text", d.text},
                   {"count", d.count},
                   {"places", spots}});
  }
  return out;
}

}  // namespace pcbmesh::cli
