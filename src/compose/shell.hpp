// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pcbmesh/model/model.hpp"
#include "pcbmesh/study/study.hpp"
#include "src/compose/footprint.hpp"
#include "src/compose/stack.hpp"

namespace pcbmesh::compose {

/// Perfectly matched layers of the sides that ask for them: strips beside the domain as bodies, one inside the other for the
/// elements across, so that where those of two sides overlap both axes are stretched. Those above and below are slabs of the
/// stack already.
void add_shell(const study::Study& study, const Footprint& footprint, const Stack& stack, model::ModelParts& parts);

}  // namespace pcbmesh::compose
