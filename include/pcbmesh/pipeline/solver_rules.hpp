// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "pcbmesh/study/study.hpp"

namespace pcbmesh::pipeline {

/// What a solver wants of the mesh file.
struct ExportRules {
  std::string msh_version;     ///< empty = any
  bool text = false;           ///< binary files are not read
  bool splits_chords = false;  ///< sheets: no inner edge may join two points of the rim
};

/// @source Palace guide (config/model), manuals of ElmerGrid and GetDP, MFEM mesh formats.
[[nodiscard]] ExportRules export_rules(study::Solver solver);

}  // namespace pcbmesh::pipeline
