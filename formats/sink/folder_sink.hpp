// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

namespace pcbmesh::formats {

/// A folder of files that appears whole or not at all: its files are written in a folder beside it, which then takes its place.
/// An older folder of that name is replaced only if it holds nothing but files of this format: what else lies there is
/// somebody's.
class FolderSink {
 public:
  /// @param is_ours  whether a file of that name may lie in the folder. @throws Error write_failed (701).
  FolderSink(const std::filesystem::path& target, std::function<bool(std::string_view name)> is_ours);
  ~FolderSink();
  FolderSink(const FolderSink&) = delete;
  FolderSink& operator=(const FolderSink&) = delete;

  /// Where a file is to be written until commit().
  [[nodiscard]] std::filesystem::path file(std::string_view name) const { return part_ / name; }
  /// Makes the folder appear under its name. @throws Error write_failed (701); the old folder is then still there.
  void commit();

 private:
  [[noreturn]] void fail(int error_number, std::string_view what) const;
  void require_replaceable() const;

  std::filesystem::path target_, part_;
  std::function<bool(std::string_view)> is_ours_;
};

}  // namespace pcbmesh::formats
