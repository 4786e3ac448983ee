// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "src/compose/port_placer.hpp"

namespace pcbmesh::compose {

/// "(1.5, 2) mm"
[[nodiscard]] std::string place_text(geometry::Point p);
[[nodiscard]] Outcome failed(std::string fault);
/// Name, impedance, terminals and the study's bound on edges.
void describe(Placed& placed, const study::Port& wanted, const Terminals& nets, std::int32_t reference);

}  // namespace pcbmesh::compose
