// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <vector>

namespace pcbmesh::formats::msh {

/// Longest name that every reader of $PhysicalNames takes, in bytes.
inline constexpr std::size_t max_name_bytes = 127;

/// Names fit for $PhysicalNames, in the given order: control characters become spaces, double quotes single ones, longer
/// names are cut at a character and end in "~" and a number. Distinct names stay distinct. @cost O(n log n).
[[nodiscard]] std::vector<std::string> group_names(std::span<const std::string> names);

}  // namespace pcbmesh::formats::msh
