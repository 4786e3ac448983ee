// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "pcbmesh/base/diagnostics.hpp"
#include "pcbmesh/base/progress.hpp"

namespace pcbmesh::cli {

/// Turns SIGINT and SIGTERM into the cancellation that terminal_progress() polls; a second ^C kills as usual.
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
