// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/cli/begin_study.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/formats/deck.hpp"
#include "pcbmesh/study/solver_needs.hpp"

namespace pcbmesh::cli {

BegunStudy begin_study(const StudyOptions& options) {
  StudyOptions without = options;
  without.solver.clear();
  BegunStudy begun{unchecked_study_from(without)};
  begun.solver = options.solver.empty() ? begun.study.solver : study::parse_solver(options.solver);
  begun.study.solver = study::Solver::none;
  return begun;
}

bool wants_ports(const BegunStudy& begun) {
  return formats::has_deck(study::name_of(begun.solver)) && begun.study.problem == study::Problem::driven &&
         begun.study.ports.empty() && !begun.study.nets.empty();
}

void take_first_answers(const StudyOptions& options, study::Study& study) {
  if (options.file.empty() && options.conductors.empty()) study.conductors = study::ConductorMode::hollow;
  if (!study.sweep && study.problem == study::Problem::driven) study.sweep = study::Sweep{1e8, 1e10, 100, {}};
}

pipeline::StartedStudy settle_study(const board::Board& board, const StudyOptions& options, BegunStudy begun,
                                    pipeline::PortPlaces places) {
  study::check(begun.study);
  pipeline::StartedStudy started = pipeline::start_study(board, std::move(begun.study), places);
  started.study.solver = begun.solver;
  if (options.split.empty() && study::needs_tetrahedra(started.study)) started.study.split = study::ElementSplit::tetrahedra;
  if (begun.solver != study::Solver::none && started.study.problem == study::Problem::driven && started.study.ports.empty())
    throw Error(ErrorCode::study_invalid,
                fmt::format("no port could be placed for {}: {}; name some (--port, or ports in a study)",
                            fmt::join(started.study.nets, ", "),
                            started.left_out.empty() ? "the nets have neither pins nor cuts"
                                                     : fmt::format("{}", fmt::join(started.left_out, "; "))));
  study::check(started.study);
  return started;
}

}  // namespace pcbmesh::cli
