// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/base/version.hpp"

namespace pcbmesh {

std::string_view version() noexcept {
  return PCBMESH_VERSION;
}

}  // namespace pcbmesh
