// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <functional>

#include "pcbmesh/base/error.hpp"

namespace pcbmesh::testing {

/// The Error that the action throws; a test failure if it throws none.
inline Error error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "no error was thrown";
  return {ErrorCode::internal, "none"};
}

}  // namespace pcbmesh::testing
