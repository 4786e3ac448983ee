// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>

namespace pcbmesh::formats {

/// Buffered output that becomes a file whole or not at all.
///
/// Bytes go to "<target>.<random>.part" in the target's folder; commit() syncs it, renames it over the target and syncs the
/// folder. Without commit() (exception, cancellation) the destructor removes the part file. A kill at any moment leaves
/// at most a part file, never a half-written target.
///
/// @guarantee K1  the target is either the old file or the whole new one, at every moment
/// @guarantee K2  after an exception nothing is left beside it
/// @guarantee K3  numbers look the same in every locale: shortest text that reads back to the same value
class FileSink {
 public:
  /// Opens the part file. An existing target lends its permissions; a symbolic link to a file is followed.
  /// @param expected_bytes  size of the whole file if known, else 0; refused at once if the disk has less room.
  /// @throws Error write_failed (701) when the target is a directory or device, or the folder does not exist or is read-only.
  explicit FileSink(const std::filesystem::path& target, std::uint64_t expected_bytes = 0);
  ~FileSink();
  FileSink(const FileSink&) = delete;
  FileSink& operator=(const FileSink&) = delete;

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

  /// Bytes appended so far.
  [[nodiscard]] std::uint64_t size() const noexcept { return written_ + used_; }
  [[nodiscard]] const std::filesystem::path& target() const noexcept { return target_; }

  /// Makes the file appear under its name. @throws Error write_failed (701); the old file is then still there.
  void commit();

  static constexpr std::size_t buffer_size = 256 * 1024;
  static constexpr std::size_t max_room = buffer_size;
  static constexpr std::size_t max_number_text = 32;  ///< longest shortest-form double has 24 characters

 private:
  void flush();
  void write_all(const char* bytes, std::size_t size);
  void open_part();
  void discard() noexcept;
  [[noreturn]] void fail(int error_number, std::string_view what) const;

  std::filesystem::path target_;  ///< as the caller gave it, for messages
  std::string name_, part_;       ///< file names inside the folder
  int folder_ = -1, file_ = -1;   ///< descriptors; the folder's survives a change of directory
  std::uint64_t expected_ = 0;    ///< 0 = unknown
  std::uint64_t written_ = 0;     ///< bytes handed to the system
  std::size_t used_ = 0;          ///< bytes waiting in buffer_
  std::unique_ptr<char[]> buffer_;
};

}  // namespace pcbmesh::formats
