// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

namespace pcbmesh {

/// "0.1.0", from project(VERSION) alone.
[[nodiscard]] std::string_view version() noexcept;

}  // namespace pcbmesh
