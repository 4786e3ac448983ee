// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/pipeline/solver_rules.hpp"

namespace pcbmesh::pipeline {

ExportRules export_rules(study::Solver solver) {
  switch (solver) {
    case study::Solver::palace:
      return {"2.2", false, true};
    case study::Solver::getdp:
    case study::Solver::mfem:
      return {"2.2", false, false};
    case study::Solver::elmer:
      return {"2.2", true, false};
    case study::Solver::dolfinx:
    case study::Solver::none:
      break;
  }
  return {};
}

}  // namespace pcbmesh::pipeline
