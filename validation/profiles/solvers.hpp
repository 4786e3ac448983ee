// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pcbmesh/validation/profiles.hpp"

// A new profile is a file of its own, one line here and one in profiles.cpp.
namespace pcbmesh::validation::profiles {

extern const Profile palace, mfem, getdp, elmer, dolfinx;

}  // namespace pcbmesh::validation::profiles
