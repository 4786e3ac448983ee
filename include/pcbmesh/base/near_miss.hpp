// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace pcbmesh {

/// Up to `most` candidates close to a misspelt name (edit distance without regard to case, or one contained in the other),
/// best first, ties in alphabetical order. @cost O(candidates x length^2), for messages only.
[[nodiscard]] std::vector<std::string> near_misses(std::string_view name, std::span<const std::string> candidates,
                                                   std::size_t most = 3);

/// "; did you mean 'x' or 'y'?" from near_misses, or "" when nothing is close: the tail of a message.
[[nodiscard]] std::string did_you_mean(std::string_view name, std::span<const std::string> candidates);

}  // namespace pcbmesh
