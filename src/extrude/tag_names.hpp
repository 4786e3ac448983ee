// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace pcbmesh::extrude {

/// Stands for "no net" in tag names.
inline constexpr std::string_view no_net_word = "none";

/// Escaped name of a net for tag names; no_net_word where there is none.
[[nodiscard]] std::string net_part(std::span<const std::string> nets, std::int32_t net);

/// The names with " #2", " #3" ... appended to those met before.
[[nodiscard]] std::vector<std::string> make_unique(std::vector<std::string> names);

}  // namespace pcbmesh::extrude
