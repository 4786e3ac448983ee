// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/sink/part_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>
#include <system_error>
#include <utility>

#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats {
namespace {

constexpr std::size_t longest_name = 255;  // NAME_MAX of every Linux file system in use

std::string random_suffix() {
  std::uint64_t bits = 0;
  // A short or failed read only weakens the guess-proofness; O_EXCL decides about collisions.
  if (::getrandom(&bits, sizeof bits, GRND_NONBLOCK) != static_cast<ssize_t>(sizeof bits))
    bits = static_cast<std::uint64_t>(::getpid()) * 0x9E3779B97F4A7C15ULL ^ reinterpret_cast<std::uintptr_t>(&bits);
  return fmt::format(".{:016x}.part", bits);
}

std::optional<std::uint64_t> bytes_free(int folder) {
  struct statvfs status {};
  if (::fstatvfs(folder, &status) != 0 || status.f_blocks == 0) return std::nullopt;
  return static_cast<std::uint64_t>(status.f_bavail) * status.f_frsize;
}

std::string readable_bytes(std::uint64_t bytes) {
  if (bytes < 1'000) return fmt::format("{} bytes", bytes);
  if (bytes < 1'000'000) return fmt::format("{:.1f} kB", static_cast<double>(bytes) * 1e-3);
  if (bytes < 1'000'000'000) return fmt::format("{:.1f} MB", static_cast<double>(bytes) * 1e-6);
  return fmt::format("{:.1f} GB", static_cast<double>(bytes) * 1e-9);
}

/// Where the bytes shall really go: behind a symbolic link if it leads somewhere.
std::filesystem::path behind_links(const std::filesystem::path& target) {
  std::error_code ignored;
  if (!std::filesystem::is_symlink(target, ignored)) return target;
  const std::filesystem::path real = std::filesystem::canonical(target, ignored);
  return ignored ? target : real;
}

}  // namespace

PartFile::PartFile(const std::filesystem::path& target, std::uint64_t expected_bytes)
    : target_(target), expected_(expected_bytes) {
  const std::filesystem::path real = behind_links(target);
  name_ = real.filename().string();
  const auto refuse = [&](std::string text) {
    throw Error(ErrorCode::write_failed, std::move(text), {.file = target_.string()});
  };
  if (name_.empty() || name_ == "." || name_ == "..") refuse("a file name is needed to write to, not a folder");
  const std::string folder = real.has_parent_path() ? real.parent_path().string() : std::string(".");
  folder_ = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder_ < 0) {
    const int why = errno;
    refuse(fmt::format("can't write into folder '{}': {}; create it or choose another one", folder,
                       std::generic_category().message(why)));
  }
  try {
    open_part();
  } catch (...) {
    discard();
    throw;
  }
}

PartFile::~PartFile() {
  discard();
}

void PartFile::open_part() {
  struct stat old {};
  const bool exists = ::fstatat(folder_, name_.c_str(), &old, 0) == 0;
  if (exists && !S_ISREG(old.st_mode))
    throw Error(ErrorCode::write_failed,
                S_ISDIR(old.st_mode) ? "is a folder; give the name of a file" : "is no regular file; give the name of a file",
                {.file = target_.string()});
  // A rename would replace even a write-protected file; its owner did not want that.
  if (exists && ::faccessat(folder_, name_.c_str(), W_OK, AT_EACCESS) != 0) fail(errno, "replace the file");
  if (const auto room = bytes_free(folder_); expected_ > 0 && room && *room < expected_) fail(ENOSPC, "start writing");
  for (int attempt = 0; attempt < 100 && file_ < 0; ++attempt) {
    const std::string suffix = random_suffix();
    part_ = name_.substr(0, std::min(name_.size(), longest_name - suffix.size())) + suffix;
    file_ = ::openat(folder_, part_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (file_ < 0 && errno != EEXIST && errno != EINTR) break;
  }
  if (file_ < 0) {
    const int why = errno;
    part_.clear();
    fail(why, "create the file");
  }
  // Not every file system knows permissions; the file itself matters more.
  if (exists) static_cast<void>(::fchmod(file_, old.st_mode & 0777));
}

void PartFile::write_at(std::uint64_t offset, const void* bytes, std::size_t size) {
  if (file_ < 0) throw Error(ErrorCode::internal, "a file was written to after it was closed", {.file = target_.string()});
  const char* from = static_cast<const char*>(bytes);
  while (size > 0) {
    const ssize_t done = ::pwrite(file_, from, size, static_cast<off_t>(offset));
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) {
      const int why = done < 0 ? errno : EIO;
      fail(why, "write");
    }
    from += done;
    size -= static_cast<std::size_t>(done);
    offset += static_cast<std::uint64_t>(done);
    written_ += static_cast<std::uint64_t>(done);
  }
}

void PartFile::read_at(std::uint64_t offset, void* bytes, std::size_t size) const {
  char* to = static_cast<char*>(bytes);
  while (size > 0) {
    const ssize_t done = ::pread(file_, to, size, static_cast<off_t>(offset));
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) {
      const int why = errno;
      fail(why, "read back");
    }
    if (done == 0) {  // behind the end: what was never written is zero
      std::memset(to, 0, size);
      return;
    }
    to += done;
    size -= static_cast<std::size_t>(done);
    offset += static_cast<std::uint64_t>(done);
  }
}

void PartFile::resize(std::uint64_t size) {
  if (::ftruncate(file_, static_cast<off_t>(size)) != 0) {
    const int why = errno;
    fail(why, "resize the file");
  }
}

void PartFile::save(std::uint64_t total) {
  if (::fsync(file_) != 0 && errno != EINVAL && errno != ENOTSUP) fail(errno, "save");
  const int descriptor = std::exchange(file_, -1);
  // NFS and quotas may report a late failure here; the descriptor is gone in any case.
  if (::close(descriptor) != 0 && errno != EINTR) fail(errno, "close");
  struct stat now {};
  if (::fstatat(folder_, part_.c_str(), &now, AT_SYMLINK_NOFOLLOW) != 0) fail(errno, "find again");
  if (static_cast<std::uint64_t>(now.st_size) != total) fail(EIO, "save in full");
}

void PartFile::commit(std::uint64_t total) {
  if (file_ >= 0) save(total);
  if (::renameat(folder_, part_.c_str(), folder_, name_.c_str()) != 0) fail(errno, "rename");
  part_.clear();
  if (::fsync(folder_) != 0 && errno != EINVAL && errno != ENOTSUP) {
    const int why = errno;
    throw Error(ErrorCode::write_failed,
                fmt::format("is written whole, but its folder could not be saved to disk ({}); check the disk",
                            std::generic_category().message(why)),
                {.file = target_.string()});
  }
}

void PartFile::discard() noexcept {
  if (file_ >= 0) ::close(std::exchange(file_, -1));
  if (!part_.empty()) ::unlinkat(folder_, part_.c_str(), 0);
  part_.clear();
  if (folder_ >= 0) ::close(std::exchange(folder_, -1));
}

void PartFile::fail(int error_number, std::string_view what) const {
  std::string text = fmt::format("can't {}: {}", what, std::generic_category().message(error_number));
  const bool lacks_room = error_number == ENOSPC || error_number == EDQUOT || error_number == EFBIG;
  if (expected_ > 0) text += fmt::format("; {} are needed", readable_bytes(expected_));
  if (written_ > 0) text += fmt::format("; {} were written", readable_bytes(written_));
  if (folder_ >= 0)
    if (const auto room = bytes_free(folder_)) text += fmt::format("; {} are free", readable_bytes(*room));
  text += lacks_room ? "; make room or choose another folder" : "; choose another folder or check the disk";
  text += ". Nothing was left behind, and an older file of that name is untouched";
  throw Error(ErrorCode::write_failed, std::move(text), {.file = target_.string()});
}

}  // namespace pcbmesh::formats
