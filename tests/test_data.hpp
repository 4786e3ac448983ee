// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdlib>
#include <filesystem>

namespace pcbmesh::tests {

/// Folder of real boards: PCBMESH_TEST_DATA, else ../shared/data beside the source tree; empty if absent.
inline std::filesystem::path test_data() {
  const char* given = std::getenv("PCBMESH_TEST_DATA");
  const std::filesystem::path folder =
      given != nullptr ? std::filesystem::path(given) : std::filesystem::path(PCBMESH_SOURCE_DIR) / ".." / "shared" / "data";
  return std::filesystem::is_directory(folder) ? folder : std::filesystem::path();
}

}  // namespace pcbmesh::tests

/// Skips the test with a clear word when the real boards are absent.
#define PCBMESH_NEEDS_TEST_DATA()          \
  if (pcbmesh::tests::test_data().empty()) \
  GTEST_SKIP() << "no test data: set PCBMESH_TEST_DATA to a folder with kicad/ and oracle/"
