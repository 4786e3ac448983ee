// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/validation/profiles.hpp"

#include <algorithm>
#include <array>

#include "validation/profiles/solvers.hpp"

namespace pcbmesh::validation {
namespace {

constexpr std::array<const Profile*, 5> table{&profiles::palace, &profiles::mfem, &profiles::getdp, &profiles::elmer,
                                              &profiles::dolfinx};

}  // namespace

std::span<const Profile* const> all_profiles() {
  return table;
}

const Profile* find_profile(std::string_view name) {
  const auto found = std::ranges::find(table, name, [](const Profile* profile) { return profile->name; });
  return found == table.end() ? nullptr : *found;
}

}  // namespace pcbmesh::validation
