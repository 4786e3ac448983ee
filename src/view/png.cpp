// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/view/png.hpp"

#include <zlib.h>

#include <array>
#include <cstring>

#include "pcbmesh/base/error.hpp"

namespace pcbmesh::view {
namespace {

constexpr int gzip_window = 15 + 16, zlib_window = 15;

std::string deflated(std::string_view bytes, int level, int window) {
  z_stream stream{};
  if (deflateInit2(&stream, level, Z_DEFLATED, window, 9, Z_DEFAULT_STRATEGY) != Z_OK)
    throw Error(ErrorCode::internal, "zlib would not start");
  std::string out;
  std::array<char, 1 << 16> room{};
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  std::size_t left = bytes.size();
  int result = Z_OK;
  do {
    if (stream.avail_in == 0 && left > 0) {
      stream.avail_in = static_cast<uInt>(std::min<std::size_t>(left, 1U << 30));
      left -= stream.avail_in;
    }
    stream.next_out = reinterpret_cast<Bytef*>(room.data());
    stream.avail_out = static_cast<uInt>(room.size());
    result = deflate(&stream, left == 0 ? Z_FINISH : Z_NO_FLUSH);
    out.append(room.data(), room.size() - stream.avail_out);
  } while (result != Z_STREAM_END);
  deflateEnd(&stream);
  return out;
}

void put_big_endian(std::string& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>((value >> shift) & 0xff);
}

void put_chunk(std::string& out, std::string_view type, std::string_view body) {
  put_big_endian(out, static_cast<std::uint32_t>(body.size()));
  const std::size_t first = out.size();
  out += type;
  out += body;
  const auto* bytes = reinterpret_cast<const Bytef*>(out.data() + first);
  put_big_endian(out, static_cast<std::uint32_t>(crc32(0, bytes, static_cast<uInt>(out.size() - first))));
}

}  // namespace

std::string encode_png(int width, int height, int channels, std::span<const std::uint8_t> pixels) {
  const auto row = static_cast<std::size_t>(width) * static_cast<std::size_t>(channels);
  std::string raw;
  raw.reserve((row + 1) * static_cast<std::size_t>(height));
  for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y) {
    raw += '\0';  // no filter: flat colours pack best as they are
    raw.append(reinterpret_cast<const char*>(pixels.data()) + y * row, row);
  }
  std::string out = "\x89PNG\r\n\x1a\n";
  std::string header;
  put_big_endian(header, static_cast<std::uint32_t>(width));
  put_big_endian(header, static_cast<std::uint32_t>(height));
  header += '\x08';
  header += channels == 4 ? '\x06' : '\x02';
  header.append(3, '\0');
  put_chunk(out, "IHDR", header);
  put_chunk(out, "IDAT", deflated(raw, 5, zlib_window));
  put_chunk(out, "IEND", {});
  return out;
}

std::string gzip(std::string_view bytes, int level) {
  return deflated(bytes, level, gzip_window);
}

std::string base64(std::string_view bytes) {
  constexpr char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    for (std::size_t k = 0; k < 3; ++k) word = word << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) out += k <= count ? letters[(word >> (18 - 6 * k)) & 63] : '=';
  }
  return out;
}

}  // namespace pcbmesh::view
