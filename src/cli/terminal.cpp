// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/cli/terminal.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>

namespace pcbmesh::cli {
namespace {

std::atomic<bool> cancelled{false};

void on_signal(int signal) {
  cancelled.store(true, std::memory_order_relaxed);
  std::signal(signal, SIG_DFL);
}

}  // namespace

void catch_signals() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
}

Progress terminal_progress(bool quiet) {
  if (quiet || isatty(STDERR_FILENO) == 0) return Progress({}, &cancelled);
  // Silent during the first second: a quick run needs no bar.
  const auto start = std::chrono::steady_clock::now();
  return Progress(
      [start](std::string_view stage, double fraction) {
        if (std::chrono::steady_clock::now() - start < std::chrono::seconds(1)) return;
        constexpr int width = 30;
        const int full = static_cast<int>(std::clamp(fraction, 0.0, 1.0) * width);
        fmt::print(stderr, "\r\x1b[K[{:#<{}}{:.<{}}] {}", "", full, "", width - full, stage);
        std::fflush(stderr);
      },
      &cancelled);
}

void clear_progress() {
  if (isatty(STDERR_FILENO) != 0) fmt::print(stderr, "\r\x1b[K");
}

void print_diagnostics(const Diagnostics& diagnostics) {
  for (Severity severity : {Severity::warning, Severity::note})
    for (const Diagnostic& d : diagnostics.entries()) {
      if (d.severity != severity) continue;
      fmt::print(stderr, "{}: {}{} [{}]\n", severity == Severity::warning ? "warning" : "note", d.text,
                 d.count > 1 ? fmt::format(" ({} times)", grouped(d.count)) : "", d.code);
      for (std::size_t i = 0; i < std::min<std::size_t>(d.spots.size(), severity == Severity::warning ? 3 : 1); ++i)
        fmt::print(stderr, "  at {}\n", d.spots[i].text());
    }
}

std::string grouped(std::int64_t number) {
  std::string digits = std::to_string(number);
  for (std::size_t i = digits.size(); i > (number < 0 ? 4U : 3U); i -= 3) digits.insert(i - 3, ",");
  return digits;
}

}  // namespace pcbmesh::cli
