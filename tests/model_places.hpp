// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "pcbmesh/base/units.hpp"
#include "pcbmesh/geometry/ring_contact.hpp"
#include "pcbmesh/model/model.hpp"

namespace pcbmesh::testing {

inline bool covers(const model::BodyShape& shape, geometry::Point p) {
  int winding = 0;
  for (const geometry::Ring& ring : shape.rings) winding += geometry::winding_number(ring, p);
  return winding != 0;
}

/// What fills a place in the slab that holds this height above the bottom of a layer: "copper|GND", "PP|no net", "void",
/// "hollow|A".
inline std::string label_at(const model::Model& m, std::string_view layer, double x_mm, double y_mm, Nm above_bottom_nm = 0) {
  const geometry::Point p{nm_from_mm(x_mm) + 1, nm_from_mm(y_mm) + 3};
  std::vector<std::int32_t> present;
  for (std::size_t b = 0; b < m.bodies().size(); ++b)
    if (std::any_of(m.shapes().begin(), m.shapes().end(),
                    [&](const auto& s) { return s.body == static_cast<std::int32_t>(b) && covers(s, p); }))
      present.push_back(static_cast<std::int32_t>(b));
  Nm bottom = -1;
  for (std::size_t s = 0; s < m.slabs().size(); ++s) {
    if (m.slabs()[s].layer != layer) continue;
    if (bottom < 0) bottom = m.slabs()[s].z_bottom_nm;
    if (m.slabs()[s].z_top_nm - bottom <= above_bottom_nm) continue;
    const auto label = m.resolve(static_cast<std::int32_t>(s), present);
    if (label.hollow_net != -2) return fmt::format("hollow|{}", m.net_name(label.hollow_net));
    if (label.is_void()) return "void";
    return fmt::format("{}|{}", m.materials()[static_cast<std::size_t>(label.material)].name, m.net_name(label.net));
  }
  return "no such slab";
}

}  // namespace pcbmesh::testing
