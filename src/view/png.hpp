// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace pcbmesh::view {

/// PNG file of 8-bit pixels. `pixels`: rows from the top, `channels` = 3 (RGB) or 4 (RGBA). Same pixels, same bytes.
[[nodiscard]] std::string encode_png(int width, int height, int channels, std::span<const std::uint8_t> pixels);

/// zlib's gzip stream, without name and time. @param level 1 to 9.
[[nodiscard]] std::string gzip(std::string_view bytes, int level);
[[nodiscard]] std::string base64(std::string_view bytes);

}  // namespace pcbmesh::view
