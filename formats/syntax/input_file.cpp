// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/syntax/input_file.hpp"

#include <fmt/format.h>
#include <lzma.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <system_error>

#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats::syntax {
namespace {

[[noreturn]] void fail(ErrorCode code, const std::filesystem::path& file, std::string text) {
  throw Error(code, std::move(text), Spot{.file = file.string()});
}

/// Bytes of a file in order; derived classes unpack.
class Source {
 public:
  explicit Source(const std::filesystem::path& file) : file_(file) {
    std::error_code ignored;
    if (std::filesystem::is_directory(file, ignored))
      fail(ErrorCode::file_unreadable, file, "is a folder; name a file inside it");
    stream_.reset(std::fopen(file.c_str(), "rb"));
    if (!stream_) fail(ErrorCode::file_unreadable, file, fmt::format("can't be opened: {}", std::strerror(errno)));
  }
  virtual ~Source() = default;
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;

  /// Fills the buffer as far as the file goes; 0 = end.
  virtual std::size_t read(char* out, std::size_t size) { return read_raw(out, size); }

  std::array<unsigned char, 6> peek() {
    std::array<unsigned char, 6> head{};
    const std::size_t got = read_raw(reinterpret_cast<char*>(head.data()), head.size());
    std::memcpy(packed_.data(), head.data(), got);
    num_packed_ = got;
    return head;
  }

 protected:
  std::size_t read_raw(char* out, std::size_t size) {
    std::size_t got = 0;
    if (next_packed_ < num_packed_) {  // bytes looked at by peek()
      got = std::min(size, num_packed_ - next_packed_);
      std::memcpy(out, packed_.data() + next_packed_, got);
      next_packed_ += got;
    }
    if (got < size) got += std::fread(out + got, 1, size - got, stream_.get());
    if (std::ferror(stream_.get()) != 0)
      fail(ErrorCode::file_unreadable, file_, fmt::format("reading failed: {}", std::strerror(errno)));
    return got;
  }

  struct Close {
    void operator()(std::FILE* f) const { std::fclose(f); }
  };
  std::filesystem::path file_;
  std::unique_ptr<std::FILE, Close> stream_;
  std::array<char, 6> packed_{};
  std::size_t num_packed_ = 0, next_packed_ = 0;
};

constexpr std::size_t packed_block = 1 << 16;

class XzSource final : public Source {
 public:
  explicit XzSource(const std::filesystem::path& file) : Source(file) {
    constexpr std::uint64_t memory_limit = std::uint64_t{512} << 20;
    if (lzma_stream_decoder(&lzma_, memory_limit, LZMA_CONCATENATED) != LZMA_OK)
      fail(ErrorCode::file_unreadable, file, "the xz decoder can't be started: out of memory");
  }
  ~XzSource() override { lzma_end(&lzma_); }

  std::size_t read(char* out, std::size_t size) override {
    lzma_.next_out = reinterpret_cast<std::uint8_t*>(out);
    lzma_.avail_out = size;
    while (lzma_.avail_out > 0 && !at_end_) {
      if (lzma_.avail_in == 0 && !raw_end_) {
        lzma_.avail_in = read_raw(reinterpret_cast<char*>(block_.data()), block_.size());
        lzma_.next_in = block_.data();
        raw_end_ = lzma_.avail_in == 0;
      }
      const lzma_ret result = lzma_code(&lzma_, raw_end_ ? LZMA_FINISH : LZMA_RUN);
      if (result == LZMA_STREAM_END)
        at_end_ = true;
      else if (result == LZMA_BUF_ERROR && raw_end_)
        fail(ErrorCode::file_truncated, file_, "the xz stream ends early; copy the file again");
      else if (result == LZMA_MEMLIMIT_ERROR)
        fail(ErrorCode::file_unreadable, file_, "the xz stream needs more than 512 MiB to unpack; repack it with xz -6");
      else if (result != LZMA_OK && result != LZMA_BUF_ERROR)
        fail(ErrorCode::file_syntax, file_,
             fmt::format("the xz stream is damaged (lzma code {}); test it with xz -t", static_cast<int>(result)));
    }
    return size - lzma_.avail_out;
  }

 private:
  lzma_stream lzma_ = LZMA_STREAM_INIT;
  std::array<std::uint8_t, packed_block> block_{};
  bool raw_end_ = false, at_end_ = false;
};

class GzipSource final : public Source {
 public:
  explicit GzipSource(const std::filesystem::path& file) : Source(file) {
    constexpr int gzip_only = 15 + 16;
    if (inflateInit2(&zlib_, gzip_only) != Z_OK)
      fail(ErrorCode::file_unreadable, file, "the gzip decoder can't be started: out of memory");
  }
  ~GzipSource() override { inflateEnd(&zlib_); }

  std::size_t read(char* out, std::size_t size) override {
    size = std::min<std::size_t>(size, std::size_t{1} << 30);
    zlib_.next_out = reinterpret_cast<Bytef*>(out);
    zlib_.avail_out = static_cast<uInt>(size);
    while (zlib_.avail_out > 0 && !at_end_) {
      if (zlib_.avail_in == 0) {
        zlib_.avail_in = static_cast<uInt>(read_raw(reinterpret_cast<char*>(block_.data()), block_.size()));
        zlib_.next_in = block_.data();
        if (zlib_.avail_in == 0) {
          if (!between_members_) fail(ErrorCode::file_truncated, file_, "the gzip stream ends early; copy the file again");
          at_end_ = true;
          break;
        }
      }
      between_members_ = false;
      const int result = inflate(&zlib_, Z_NO_FLUSH);
      if (result == Z_STREAM_END) {
        between_members_ = true;
        inflateReset(&zlib_);
      } else if (result != Z_OK && result != Z_BUF_ERROR) {
        fail(ErrorCode::file_syntax, file_,
             fmt::format("the gzip stream is damaged (zlib code {}); test it with gzip -t", result));
      }
    }
    return size - zlib_.avail_out;
  }

 private:
  z_stream zlib_{};
  std::array<Bytef, packed_block> block_{};
  bool between_members_ = false, at_end_ = false;
};

std::unique_ptr<Source> open_source(const std::filesystem::path& file) {
  auto plain = std::make_unique<Source>(file);
  const auto head = plain->peek();
  constexpr std::array<unsigned char, 6> xz_head{0xFD, '7', 'z', 'X', 'Z', 0x00};
  if (head == xz_head || file.extension() == ".xz") return std::make_unique<XzSource>(file);
  if ((head[0] == 0x1F && head[1] == 0x8B) || file.extension() == ".gz") return std::make_unique<GzipSource>(file);
  return plain;
}

std::string read_up_to(const std::filesystem::path& file, std::size_t limit, bool must_end) {
  const std::unique_ptr<Source> source = open_source(file);
  std::error_code unknown_size;
  const std::uintmax_t on_disk = std::filesystem::file_size(file, unknown_size);
  // One byte more than a plain file has, so that its end is seen without growing the buffer.
  std::size_t room = unknown_size ? packed_block : static_cast<std::size_t>(std::min<std::uintmax_t>(on_disk, limit)) + 1;
  std::string bytes;
  std::size_t filled = 0;
  for (;;) {
    room = std::min(room, limit + 1);
    bytes.resize(room);
    const std::size_t got = source->read(bytes.data() + filled, room - filled);
    filled += got;
    if (filled > limit || got == 0) break;
    if (filled == room) room *= 2;
  }
  if (filled > limit && must_end)
    fail(ErrorCode::file_unreadable, file, fmt::format("holds more than {} MiB, the most that is read", limit >> 20));
  bytes.resize(std::min(filled, limit));
  return bytes;
}

}  // namespace

std::string read_whole_file(const std::filesystem::path& file) {
  return read_up_to(file, max_unpacked_bytes, true);
}

std::string read_head(const std::filesystem::path& file, std::size_t num_bytes) {
  return read_up_to(file, num_bytes, false);
}

std::string unpacked_name(const std::filesystem::path& file) {
  const std::filesystem::path ending = file.extension();
  return (ending == ".xz" || ending == ".gz" ? file.stem() : file.filename()).string();
}

}  // namespace pcbmesh::formats::syntax
