// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

namespace pcbmesh::study {

/// Text of src/study/materials.json, put into the program when it is built.
extern const std::string_view library_text;

}  // namespace pcbmesh::study
