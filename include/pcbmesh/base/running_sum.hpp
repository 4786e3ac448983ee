// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

namespace pcbmesh {

/// Sum whose error does not grow with the number of terms. @source Neumaier 1974.
class RunningSum {
 public:
  void add(double term) {
    const double sum = sum_ + term;
    lost_ += std::abs(sum_) >= std::abs(term) ? (sum_ - sum) + term : (term - sum) + sum_;
    sum_ = sum;
  }
  [[nodiscard]] double total() const { return sum_ + lost_; }

 private:
  double sum_ = 0, lost_ = 0;
};

}  // namespace pcbmesh
