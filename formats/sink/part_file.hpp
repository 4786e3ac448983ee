// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace pcbmesh::formats {

/// A file in the making: "<target>.<random>.part" in the target's folder, written and read at any place. commit() syncs it,
/// renames it over the target and syncs the folder. Without commit() the destructor removes it. A kill at any moment leaves
/// at most a part file, never a half-written target.
///
/// @guarantee K1  the target is either the old file or the whole new one, at every moment
/// @guarantee K2  after an exception nothing is left beside it
class PartFile {
 public:
  /// Opens the part file. An existing target lends its permissions; a symbolic link to a file is followed.
  /// @param expected_bytes  size of the whole file if known, else 0; refused at once if the disk has less room.
  /// @throws Error write_failed (701) when the target is a directory or device, or the folder does not exist or is read-only.
  explicit PartFile(const std::filesystem::path& target, std::uint64_t expected_bytes = 0);
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  /// @throws Error write_failed (701), with the bytes needed, written and free.
  void write_at(std::uint64_t offset, const void* bytes, std::size_t size);
  /// What was never written reads as zero. @throws Error write_failed (701).
  void read_at(std::uint64_t offset, void* bytes, std::size_t size) const;
  void resize(std::uint64_t size);
  [[nodiscard]] const std::filesystem::path& target() const noexcept { return target_; }

  /// All bytes are on the disk, still under the other name; nothing more can be written. For files that appear together: the
  /// slow part comes before the first of them appears. @param size  that it must have. @throws Error write_failed (701).
  void save(std::uint64_t size);
  /// Saves, and makes the file appear under its name. @param size  that it must have. @throws Error write_failed (701); the old
  /// file is then still there.
  void commit(std::uint64_t size);

 private:
  void open_part();
  void discard() noexcept;
  [[noreturn]] void fail(int error_number, std::string_view what) const;

  std::filesystem::path target_;  ///< as the caller gave it, for messages
  std::string name_, part_;       ///< file names inside the folder
  int folder_ = -1, file_ = -1;   ///< descriptors; the folder's survives a change of directory
  std::uint64_t expected_ = 0;    ///< 0 = unknown
  std::uint64_t written_ = 0;     ///< bytes handed to the system
};

}  // namespace pcbmesh::formats
