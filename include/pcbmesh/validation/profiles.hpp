// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string_view>

#include "pcbmesh/validation/report.hpp"

namespace pcbmesh::validation {

namespace checks {
struct Context;
struct FaceMatch;
}  // namespace checks

/// What one solver forbids or mistreats in a mesh that is right in itself. Give it to check() in CheckOptions.
struct Profile {
  std::string_view name;   ///< e.g. "palace"; its codes are "profile.palace.*"
  std::string_view title;  ///< program and version the rules are of
  void (*judge)(const checks::Context& context, const checks::FaceMatch& match, Report& report);
};

/// All profiles, in the order of docs/checks.md.
[[nodiscard]] std::span<const Profile* const> all_profiles();
/// nullptr if there is no such profile.
[[nodiscard]] const Profile* find_profile(std::string_view name);

}  // namespace pcbmesh::validation
