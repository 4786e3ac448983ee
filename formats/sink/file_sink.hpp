// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string_view>
#include <type_traits>

#include "formats/sink/part_file.hpp"

namespace pcbmesh::formats {

/// Buffered output that becomes a file whole or not at all: a PartFile written from front to back.
///
/// @guarantee K3  numbers look the same in every locale: shortest text that reads back to the same value
class FileSink {
 public:
  /// @param expected_bytes  size of the whole file if known, else 0; refused at once if the disk has less room.
  /// @throws Error write_failed (701), as PartFile.
  explicit FileSink(const std::filesystem::path& target, std::uint64_t expected_bytes = 0);

  /// Contiguous room for `size` bytes, to be filled by the caller, who then calls advance() with how many were used.
  /// @param size  at most max_room. @throws Error write_failed (701).
  [[nodiscard]] char* room(std::size_t size) {
    if (buffer_size - used_ < size) flush();
    return buffer_.get() + used_;
  }
  void advance(std::size_t size) { used_ += size; }

  /// Appends bytes. @throws Error write_failed (701).
  void put(std::string_view text);
  void put_bytes(const void* bytes, std::size_t size) { put(std::string_view(static_cast<const char*>(bytes), size)); }
  /// Appends the value's bytes in the machine's order (little endian; refused at compile time elsewhere).
  template <typename T>
  void put_raw(T value) {
    static_assert(std::is_arithmetic_v<T>);
    std::memcpy(room(sizeof value), &value, sizeof value);
    advance(sizeof value);
  }
  /// Appends a number as text.
  template <typename T>
  void put_number(T value) {
    static_assert(std::is_arithmetic_v<T>);
    char* first = room(max_number_text);
    advance(static_cast<std::size_t>(std::to_chars(first, first + max_number_text, value).ptr - first));
  }

  /// Replaces bytes that were appended earlier: sizes and offsets that are known only behind what they describe.
  void overwrite(std::uint64_t at, std::string_view text);

  /// Bytes appended so far.
  [[nodiscard]] std::uint64_t size() const noexcept { return written_ + used_; }
  [[nodiscard]] const std::filesystem::path& target() const noexcept { return part_.target(); }

  /// As PartFile::save().
  void save();
  /// Makes the file appear under its name. @throws Error write_failed (701); the old file is then still there.
  void commit();

  static constexpr std::size_t buffer_size = 256 * 1024;
  static constexpr std::size_t max_room = buffer_size;
  static constexpr std::size_t max_number_text = 32;  ///< longest shortest-form double has 24 characters

 private:
  void flush();
  void write_all(const char* bytes, std::size_t size);

  PartFile part_;
  std::uint64_t written_ = 0;  ///< bytes handed to the part file
  std::size_t used_ = 0;       ///< bytes waiting in buffer_
  std::unique_ptr<char[]> buffer_;
};

}  // namespace pcbmesh::formats
