// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pcbmesh/board/board.hpp"
#include "pcbmesh/pipeline/start_study.hpp"
#include "src/cli/study_options.hpp"

namespace pcbmesh::cli {

/// The solver's demands come when its ports are there: a study that is begun has none yet. The solver it is meant for comes
/// beside it.
struct BegunStudy {
  study::Study study;
  study::Solver solver = study::Solver::none;
};
/// @throws Error as study_from().
[[nodiscard]] BegunStudy begin_study(const StudyOptions& options);

/// Whether nets and a solver are named and a port is wanted, but none is: then they are placed where pins and cuts allow.
[[nodiscard]] bool wants_ports(const BegunStudy& begun);

/// What an engineer asks first where nothing is said: S-parameters from 0.1 to 10 GHz, with the inside of the copper left out.
void take_first_answers(const StudyOptions& options, study::Study& study);

/// Ports in their places and the solver at its own, held against its demands. @throws Error as start_study() and check().
[[nodiscard]] pipeline::StartedStudy settle_study(const board::Board& board, const StudyOptions& options, BegunStudy begun,
                                                  pipeline::PortPlaces places = pipeline::PortPlaces::ends);

}  // namespace pcbmesh::cli
