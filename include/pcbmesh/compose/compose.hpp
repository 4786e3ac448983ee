// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <string>
#include <vector>

#include "pcbmesh/base/diagnostics.hpp"
#include "pcbmesh/board/board.hpp"
#include "pcbmesh/model/model.hpp"
#include "pcbmesh/study/study.hpp"

namespace pcbmesh::compose {

/// Board and study -> the domain to be meshed.
///
/// Slabs bottom to top: air below, the stackup reversed (solder mask left out and announced), air above. z = 0 is the bottom
/// of the lowest board layer. Copper gaps on outer layers are air, on inner layers the neighbouring prepreg or core.
/// Bodies: domain, board, one per (copper layer, net) with copper, unplated holes, and one barrel per (span, net).
/// Plated holes are filled with copper of their net through their span (docs/architecture.md, "Drills").
/// A region keeps all copper inside its box; rings are clipped to a slightly larger box first, which bounds the cost,
/// and the domain body cuts exactly.
///
/// Ports come last: a body each, whose edges the overlay keeps straight.
///
/// @throws Error name_unknown (304) with near misses, port_invalid (306) naming every port at fault, region_empty (305),
/// outline_invalid (302), study_invalid (102).
/// @cost O(shape vertices).
[[nodiscard]] model::Model compose(const board::Board& board, const study::Study& study, Diagnostics& diagnostics);

/// A port that could be, or why it could not.
struct PortProposal {
  study::Port port;       ///< named P1, P2 ..., coaxial ones C1, C2 ...; its reference is filled in
  std::string about;      ///< "pin J1.2", "the cut at xmin", "the via at (1, 2) mm, in its antipad on In1.Cu"
  std::string how{};      ///< "vertical", "gap" or "coaxial"; empty if it can't be placed
  std::string why_not{};  ///< empty: the port can be placed
  std::array<double, 2> at_mm{};
};

/// Where ports are looked for.
enum class PortPlaces {
  ends,          ///< pins of the nets, and where the region cuts them
  ends_and_vias  ///< and the antipads that their plated holes pass, as coaxial ports
};

/// Ports of study.nets; those that can be placed first, end by end. Each that is said to be possible passes what compose()
/// asks.
/// @throws Error as compose. @cost O(shapes x ports).
[[nodiscard]] std::vector<PortProposal> propose_ports(const board::Board& board, const study::Study& study, PortPlaces places,
                                                      Diagnostics& diagnostics);

}  // namespace pcbmesh::compose
