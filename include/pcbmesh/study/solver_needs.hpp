// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pcbmesh/study/study.hpp"

namespace pcbmesh::study {

/// Whether the study's solver can solve its problem on tetrahedra alone: dolfinx has no edge elements on prisms. A study that
/// does not say how its elements are split gets them then; one that says `none` is refused by check().
[[nodiscard]] bool needs_tetrahedra(const Study& study);

}  // namespace pcbmesh::study
