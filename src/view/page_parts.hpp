// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

namespace pcbmesh::view {

/// Files of src/view/page, embedded when the program is built.
[[nodiscard]] std::string_view page_template();
[[nodiscard]] std::string_view page_style();
/// The viewer with three.js, bundled and minified.
[[nodiscard]] std::string_view page_script();

}  // namespace pcbmesh::view
