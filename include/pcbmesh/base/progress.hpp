// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <functional>
#include <string_view>

namespace pcbmesh {

/// Progress and cancellation, passed by reference through every long step.
class Progress {
 public:
  /// @param report  called with the stage's name and a fraction in [0, 1]; may be empty.
  /// @param cancel  polled by check(); may be null. The flag may be set from a signal handler.
  explicit Progress(std::function<void(std::string_view stage, double fraction)> report = {},
                    const std::atomic<bool>* cancel = nullptr)
      : report_(std::move(report)), cancel_(cancel) {}

  /// Starts or advances a stage. @throws Error cancelled (103).
  void at(std::string_view stage, double fraction) const;
  /// @throws Error cancelled (103) if the caller asked to stop. Cheap: one relaxed load.
  void check() const;

 private:
  std::function<void(std::string_view, double)> report_;
  const std::atomic<bool>* cancel_ = nullptr;
};

}  // namespace pcbmesh
