// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "pcbmesh/base/diagnostics.hpp"
#include "pcbmesh/board/board.hpp"
#include "pcbmesh/compose/compose.hpp"
#include "pcbmesh/study/study.hpp"

namespace pcbmesh::pipeline {

using compose::PortPlaces;

/// A study with ports, and what to say about it.
struct StartedStudy {
  study::Study study;                   ///< the given one with the ports that can be placed appended
  std::vector<std::string> port_notes;  ///< per port of the study: where it is; empty for those given
  std::vector<std::string> left_out;    ///< places where no port can be, each with the reason
  Diagnostics diagnostics;
};

/// Proposes lumped ports for study.nets. @throws Error as compose().
[[nodiscard]] StartedStudy start_study(const board::Board& board, study::Study study, PortPlaces places = PortPlaces::ends);

}  // namespace pcbmesh::pipeline
