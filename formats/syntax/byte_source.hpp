// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats::syntax {

/// A file that is read once from front to back through a small window, as bytes, words or lines.
/// Packed files (.gz, .xz) are unpacked in memory first.
class ByteSource {
 public:
  /// @throws Error file_unreadable (201), and those of unpacking (202, 205).
  explicit ByteSource(const std::filesystem::path& file);
  ~ByteSource();
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;

  [[nodiscard]] std::int64_t offset() const { return window_start_ + static_cast<std::int64_t>(at_); }
  [[nodiscard]] std::int64_t size() const { return size_; }
  [[nodiscard]] std::int64_t remaining() const { return size_ - offset(); }

  /// Next value in little-endian bytes. @throws Error file_truncated (205).
  template <typename T>
  [[nodiscard]] T raw() {
    require(sizeof(T));
    T value;
    std::memcpy(&value, window_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }
  /// Next word between blanks; valid until the next call. @throws Error file_truncated (205).
  [[nodiscard]] std::string_view word();
  /// Rest of the line without its end; valid until the next call. @throws Error file_truncated (205).
  [[nodiscard]] std::string_view line();
  /// Skips the rest of a line that must hold nothing more. @throws Error file_syntax (202).
  void end_line();
  /// Skips blanks and line ends; false at the end of the file.
  [[nodiscard]] bool skip_blanks();
  /// The next byte, after skip_blanks() was true. It stays.
  [[nodiscard]] char peek() const { return window_[at_]; }
  /// Skips everything up to and with a marker that starts a line. @throws Error file_truncated (205).
  void skip_past(std::string_view marker);

  /// Section named in messages; `as_text` chooses between line and byte offset as the place.
  void enter(std::string section, bool as_text);
  [[noreturn]] void fail(std::string text, ErrorCode code = ErrorCode::file_syntax) const;

 private:
  static constexpr std::size_t window_size = std::size_t{1} << 20;
  static constexpr std::size_t longest_line = std::size_t{1} << 16;

  void require(std::size_t count) {
    if (window_end_ - at_ < count) refill(count);
  }
  void refill(std::size_t count);
  [[nodiscard]] bool fill_window();
  [[noreturn]] void fail_truncated() const;

  std::filesystem::path file_;
  int descriptor_ = -1;  ///< -1: the window is the whole file
  std::vector<char> window_;
  std::size_t at_ = 0, window_end_ = 0;
  std::int64_t window_start_ = 0, size_ = 0, line_ = 1;
  std::string section_;
  bool as_text_ = true;
};

/// Numbers of a section, as words of text or as bytes.
class Numbers {
 public:
  Numbers(ByteSource& source, bool binary) : source_(&source), binary_(binary) {}
  [[nodiscard]] std::int32_t integer();
  /// A count or id; at most 2^63 - 1.
  [[nodiscard]] std::int64_t size();
  [[nodiscard]] double real();
  /// A count of items that take at least `bytes` (binary) or `letters` (text) each in the rest of the file.
  [[nodiscard]] std::int64_t count(std::int64_t bytes, std::int64_t letters, std::string_view what);
  /// The same for a count read by other means.
  std::int64_t justified(std::int64_t count, std::int64_t bytes, std::int64_t letters, std::string_view what) const;
  [[nodiscard]] bool binary() const { return binary_; }

 private:
  ByteSource* source_;  ///< not null
  bool binary_;
};

}  // namespace pcbmesh::formats::syntax
