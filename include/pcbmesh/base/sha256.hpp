// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace pcbmesh {

/// SHA-256 (FIPS 180-4) of a file's bytes: 64 lower-case hexadecimal digits. Of a folder, for formats that are one: that of the
/// list of its files by name, as sha256sum prints it.
/// @throws Error file_unreadable (201). @cost reads the file once; half a second to two per gigabyte.
[[nodiscard]] std::string sha256_of_file(const std::filesystem::path& file);

}  // namespace pcbmesh
