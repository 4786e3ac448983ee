// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/pipeline/start_study.hpp"

#include <fmt/format.h>

#include <utility>

#include "pcbmesh/compose/compose.hpp"

namespace pcbmesh::pipeline {

StartedStudy start_study(const board::Board& board, study::Study study, PortPlaces places) {
  StartedStudy started;
  started.port_notes.resize(study.ports.size());
  for (compose::PortProposal& proposal : compose::propose_ports(board, study, places, started.diagnostics)) {
    if (!proposal.why_not.empty()) {
      started.left_out.push_back(proposal.about.empty()
                                     ? fmt::format("net {}: {}", proposal.port.net, proposal.why_not)
                                     : fmt::format("{} of net {}: {}", proposal.about, proposal.port.net, proposal.why_not));
      continue;
    }
    started.port_notes.push_back(proposal.how == "coaxial" ? fmt::format("coaxial, {}", proposal.about)
                                                           : fmt::format("{}, {}, at ({:.6g}, {:.6g}) mm", proposal.how,
                                                                         proposal.about, proposal.at_mm[0], proposal.at_mm[1]));
    study.ports.push_back(std::move(proposal.port));
  }
  started.study = std::move(study);
  return started;
}

}  // namespace pcbmesh::pipeline
