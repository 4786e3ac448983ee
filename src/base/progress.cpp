// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/base/progress.hpp"

#include "pcbmesh/base/error.hpp"

namespace pcbmesh {

void Progress::at(std::string_view stage, double fraction) const {
  check();
  if (report_) report_(stage, fraction);
}

void Progress::check() const {
  if (cancel_ != nullptr && cancel_->load(std::memory_order_relaxed))
    throw Error(ErrorCode::cancelled, "cancelled; nothing was written");
}

}  // namespace pcbmesh
