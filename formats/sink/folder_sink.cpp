// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/sink/folder_sink.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats {

FolderSink::FolderSink(const std::filesystem::path& target, std::function<bool(std::string_view)> is_ours)
    : is_ours_(std::move(is_ours)) {
  std::filesystem::path name = target;
  if (!name.has_filename()) name = name.parent_path();  // "board.elmer/"
  target_ = name;
  if (name.empty() || name.filename() == "." || name.filename() == "..")
    throw Error(ErrorCode::write_failed, "the folder to be written needs a name of its own", {.file = target.string()});
  require_replaceable();
  std::string part = name.string() + ".part.XXXXXX";
  if (::mkdtemp(part.data()) == nullptr) fail(errno, "create a folder");
  part_ = part;
  const mode_t mask = ::umask(0);
  ::umask(mask);
  static_cast<void>(::chmod(part_.c_str(), 0777 & ~mask));
}

FolderSink::~FolderSink() {
  std::error_code ignored;
  if (part_.empty()) return;
  for (const auto& entry : std::filesystem::directory_iterator(part_, ignored))
    if (is_ours_(entry.path().filename().string())) std::filesystem::remove(entry.path(), ignored);
  std::filesystem::remove(part_, ignored);
}

void FolderSink::require_replaceable() const {
  std::error_code error;
  const auto status = std::filesystem::symlink_status(target_, error);
  if (!std::filesystem::exists(status)) return;
  if (!std::filesystem::is_directory(status))
    throw Error(ErrorCode::write_failed, "is no folder, and this format is a folder of files; give another name",
                {.file = target_.string()});
  for (const auto& entry : std::filesystem::directory_iterator(target_)) {
    const std::string name = entry.path().filename().string();
    if (!is_ours_(name) || !entry.is_regular_file())
      throw Error(
          ErrorCode::write_failed,
          fmt::format("the folder holds '{}', which is not of this format, and the whole folder would be replaced; give "
                      "another name",
                      name),
          {.file = target_.string()});
  }
}

void FolderSink::commit() {
  require_replaceable();
  const int folder = ::open(part_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder >= 0) {
    static_cast<void>(::fsync(folder));
    ::close(folder);
  }
  // One step: at every moment the name leads to the old folder or to the new one.
  if (::renameat2(AT_FDCWD, part_.c_str(), AT_FDCWD, target_.c_str(), RENAME_NOREPLACE) == 0) {
    part_.clear();
  } else if (errno == EEXIST) {
    if (::renameat2(AT_FDCWD, part_.c_str(), AT_FDCWD, target_.c_str(), RENAME_EXCHANGE) != 0)
      fail(errno, "replace the folder");
    // What lies under the other name now is the old folder; the destructor removes it.
  } else {
    fail(errno, "rename the folder");
  }
  const std::filesystem::path parent = target_.has_parent_path() ? target_.parent_path() : std::filesystem::path(".");
  if (const int above = ::open(parent.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); above >= 0) {
    static_cast<void>(::fsync(above));
    ::close(above);
  }
}

void FolderSink::fail(int error_number, std::string_view what) const {
  throw Error(ErrorCode::write_failed,
              fmt::format("can't {}: {}. Nothing was left behind, and an older folder of that name is untouched", what,
                          std::generic_category().message(error_number)),
              {.file = target_.string()});
}

}  // namespace pcbmesh::formats
