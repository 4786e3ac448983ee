// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <string>
#include <string_view>

#include "pcbmesh/base/diagnostics.hpp"
#include "pcbmesh/base/progress.hpp"

namespace pcbmesh::cli {

/// Set by ^C and by a termination request; polled by every long step.
[[nodiscard]] const std::atomic<bool>& cancel_flag();
/// Turns SIGINT and SIGTERM into cancel_flag(); a second ^C kills as usual.
void catch_signals();

/// A progress line on standard error, if that is a terminal and `quiet` is off; else silent. Always cancellable.
[[nodiscard]] Progress terminal_progress(bool quiet);
/// Removes the progress line.
void clear_progress();

/// Warnings, then notes, grouped and counted with their first places, to standard error.
void print_diagnostics(const Diagnostics& diagnostics);

/// "1,234,567"
[[nodiscard]] std::string grouped(std::int64_t number);

}  // namespace pcbmesh::cli
