// SPDX-License-Identifier: GPL-3.0-or-later
// A run that is killed or meets a full disk leaves the old file or the new one, in every family of formats.
#include <gtest/gtest.h>
#include <sched.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>
#include <map>
#include <random>

#include "folder.hpp"
#include "pcbmesh/base/error.hpp"
#include "pcbmesh/formats/registry.hpp"
#include "pcbmesh/mesh/prism_source.hpp"
#include "sample_prism_mesh.hpp"

namespace pcbmesh::formats {
namespace {

namespace fs = std::filesystem;
using testing::contents;
using testing::Folder;

struct Case {
  const char* name;
  const char* file;
  WriteMeshOptions options;
};

std::vector<Case> cases() {
  WriteMeshOptions old, packed;
  old.version = "2.2";
  packed.compression = Compression::zlib;
  return {{"msh41", "a.msh", {}},          {"msh22", "a.msh", old},  {"vtu", "a.vtu", {}},
          {"vtu packed", "a.vtu", packed}, {"hdf5", "a.vtkhdf", {}}, {"hdf5 packed", "a.vtkhdf", packed},
          {"native", "a.pcbmesh", {}},     {"elmer", "a.elmer", {}}, {"exodus", "a.exo", {}}};
}

/// The bytes of a file, or of all files of a folder, each behind its name.
std::string contents_of(const fs::path& path) {
  if (!fs::is_directory(path)) return contents(path);
  std::map<std::string, std::string> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(path))
    files[entry.path().filename().string()] = contents(entry.path());
  std::string all;
  for (const auto& [name, bytes] : files) all += name + '\0' + bytes;
  return all;
}

/// The bytes a case writes, or nothing where the format is not built.
std::string bytes_of(mesh::MeshSource& source, const Case& what) {
  const Folder folder;
  try {
    write_mesh(source, folder / what.file, what.options);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::format_not_built) << error.what();
    return {};
  }
  return contents_of(folder / what.file);
}

int wait_for(pid_t child) {
  int status = 0;
  ::waitpid(child, &status, 0);
  return status;
}

TEST(WriteRobustness, FiftyKillsLeaveTheOldFileOrTheNewOne) {
  mesh::PrismSource old_source(mesh::PrismMesh::from_parts(testing::plain_parts(3, 3, 2)));
  mesh::PrismSource source(mesh::PrismMesh::from_parts(testing::plain_parts(60, 60, 10)));
  std::mt19937 random(5);
  for (const Case& what : cases()) {
    SCOPED_TRACE(what.name);
    const std::string old_bytes = bytes_of(old_source, what), new_bytes = bytes_of(source, what);
    if (new_bytes.empty()) continue;
    const Folder folder;
    const fs::path file = folder / what.file;
    int killed = 0, kept = 0;
    std::int64_t longest_us = 2000;
    for (int run = 0; run < 50; ++run) {
      write_mesh(old_source, file, what.options);
      const pid_t child = ::fork();
      if (child == 0) {
        try {
          write_mesh(source, file, what.options);
        } catch (...) {
          ::_exit(1);
        }
        ::_exit(0);
      }
      ::usleep(static_cast<useconds_t>(random() % static_cast<unsigned>(longest_us)));
      ::kill(child, SIGKILL);
      const bool is_killed = WIFSIGNALED(wait_for(child));
      killed += is_killed ? 1 : 0;
      // Moments are spread over the time a run takes on this machine now.
      longest_us = is_killed ? std::min<std::int64_t>(longest_us * 5 / 4, 2'000'000) : longest_us * 4 / 5 + 200;
      const std::string after = contents_of(file);
      ASSERT_TRUE(after == old_bytes || after == new_bytes) << "run " << run << " left " << after.size() << " bytes";
      kept += after == old_bytes ? 1 : 0;
    }
    EXPECT_GT(killed, 5) << "few runs were cut short: the test proves little";
    EXPECT_GT(kept, 0);
    for (const fs::directory_entry& entry : fs::directory_iterator(folder.path()))
      EXPECT_TRUE(entry.path() == file || entry.path().string().find(".part") != std::string::npos) << entry.path();
  }
}

/// Runs the action with a disk of `size` mounted on the folder; its result, or 77 where that is not allowed.
int on_small_disk(const Folder& folder, const char* size, const std::function<int()>& action) {
  const pid_t child = ::fork();
  if (child != 0) {
    const int status = wait_for(child);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  int result = 99;
  try {
    if (::unshare(CLONE_NEWNS) != 0 || ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
        ::mount("tmpfs", folder.path().c_str(), "tmpfs", 0, size) != 0)
      ::_exit(77);
    result = action();
  } catch (...) {
  }
  ::_exit(result);
}

TEST(WriteRobustness, AFullDiskIsSaidAndLeavesNoDebris) {
  mesh::PrismSource source(mesh::PrismMesh::from_parts(testing::plain_parts(100, 100, 20)));
  // Packed and text files do not know their size before: they meet the end of the disk while writing.
  std::vector<Case> all = cases();
  all[0].options.binary = all[1].options.binary = false;
  WriteMeshOptions plain;
  all.push_back({"known size", "a.vtkhdf", plain});
  // Sets of files: none of them appears.
  for (const char* file : {"a.pvtu", "a.vtm", "a.xdmf"}) all.push_back({file, file, plain});
  for (const Case& what : all) {
    SCOPED_TRACE(what.name);
    if (bytes_of(source, what).empty()) continue;
    const Folder folder;
    const int result = on_small_disk(folder, std::string_view(what.name) == "native" ? "size=24k" : "size=200k", [&] {
      const bool is_folder = fs::path(what.file).extension() == ".elmer";
      is_folder ? static_cast<void>(fs::create_directory(folder / what.file)) : testing::create(folder / what.file, "old");
      try {
        write_mesh(source, folder / what.file, what.options);
        return 1;
      } catch (const Error& error) {
        if (error.code() != ErrorCode::write_failed || exit_code(error.code()) != 5) return 2;
        if (error.text().find("No space left") == std::string::npos || error.text().find("are free") == std::string::npos)
          return 3;
      }
      return contents_of(folder / what.file) == (is_folder ? "" : "old") && folder.num_files() == 1 ? 0 : 4;
    });
    if (result == 77) GTEST_SKIP() << "may not mount a small disk here";
    EXPECT_EQ(result, 0);
  }
}

}  // namespace
}  // namespace pcbmesh::formats
