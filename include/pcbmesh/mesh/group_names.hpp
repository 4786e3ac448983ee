// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <vector>

namespace pcbmesh::mesh {

/// Longest name that every reader of $PhysicalNames takes, in bytes.
inline constexpr std::size_t max_name_bytes = 127;

/// Group names as every file of a mesh spells them, in the given order: control characters become spaces, double quotes single
/// ones, bytes that are no UTF-8 question marks; longer names are cut at a character and end in "~" and a number. All names
/// of the result differ. @cost O(n log n).
[[nodiscard]] std::vector<std::string> group_names(std::span<const std::string> names);

}  // namespace pcbmesh::mesh
