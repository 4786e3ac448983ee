// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/sink/file_sink.hpp"

#include <gtest/gtest.h>
#include <sched.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <clocale>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <random>

#include "folder.hpp"
#include "pcbmesh/base/error.hpp"
#include "thrown_error.hpp"

namespace pcbmesh::formats {
namespace {

namespace fs = std::filesystem;

using testing::contents;
using testing::create;
using testing::error_of;
using testing::Folder;

/// Runs the action in a child process; its exit status (the action's result), or minus the signal that ended it.
int in_child(const std::function<int()>& action) {
  const pid_t child = ::fork();
  if (child == 0) {
    int result = 99;
    try {
      result = action();
    } catch (...) {
    }
    ::_exit(result);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

// K1
TEST(FileSink, WritesTheFileWholeAndLeavesNothingBeside) {
  const Folder folder;
  std::string expected;
  {
    FileSink sink(folder / "a.bin");
    for (int i = 0; i < 300'000; ++i) {
      sink.put_raw(i);
      expected.append(reinterpret_cast<const char*>(&i), sizeof i);
    }
    const std::string large(2 * FileSink::buffer_size + 7, 'x');
    sink.put(large);
    expected += large;
    sink.put("end");
    expected += "end";
    EXPECT_EQ(sink.size(), expected.size());
    EXPECT_FALSE(fs::exists(folder / "a.bin"));
    sink.commit();
  }
  EXPECT_TRUE(contents(folder / "a.bin") == expected);
  EXPECT_EQ(folder.num_files(), 1u);
}

TEST(FileSink, WithoutCommitTheOldFileSurvivesAndNothingIsLeft) {
  const Folder folder;
  create(folder / "a.msh", "old");
  try {
    FileSink sink(folder / "a.msh");
    sink.put(std::string(3 * FileSink::buffer_size, 'n'));
    EXPECT_EQ(folder.num_files(), 2u) << "the part file stands in the same folder";
    throw Error(ErrorCode::cancelled, "stop");
  } catch (const Error&) {
  }
  EXPECT_EQ(contents(folder / "a.msh"), "old");
  EXPECT_EQ(folder.num_files(), 1u);
}

TEST(FileSink, KeepsPermissionsOfAnOldFileAndFollowsLinks) {
  const Folder folder;
  create(folder / "real.msh", "old");
  fs::permissions(folder / "real.msh", fs::perms(0640));
  fs::create_symlink("real.msh", folder / "link.msh");
  FileSink sink(folder / "link.msh");
  sink.put("new");
  sink.commit();
  EXPECT_TRUE(fs::is_symlink(folder / "link.msh"));
  EXPECT_EQ(contents(folder / "real.msh"), "new");
  EXPECT_EQ(fs::status(folder / "real.msh").permissions(), fs::perms(0640));
}

TEST(FileSink, NewFilesObeyTheUmask) {
  const Folder folder;
  const mode_t before = ::umask(027);
  FileSink sink(folder / "a");
  sink.commit();
  ::umask(before);
  EXPECT_EQ(fs::status(folder / "a").permissions(), fs::perms(0640));
}

TEST(FileSink, WorksForRelativePathsEvenWhenTheProgramMoves) {
  const Folder folder;
  const fs::path before = fs::current_path();
  fs::create_directory(folder / "sub");
  fs::current_path(folder.path());
  {
    FileSink bare("a.txt");
    FileSink nested("sub/b.txt");
    fs::current_path(before);
    bare.put("a");
    nested.put("b");
    bare.commit();
    nested.commit();
  }
  EXPECT_EQ(contents(folder / "a.txt"), "a");
  EXPECT_EQ(contents(folder / "sub/b.txt"), "b");
  EXPECT_EQ(folder.num_files(), 2u);
}

TEST(FileSink, RefusesFoldersDevicesAndMissingFoldersWithASentence) {
  const Folder folder;
  fs::create_directory(folder / "d");
  for (const fs::path& target : {folder / "d", folder / "d/", fs::path("/dev/null"), folder / "absent/a.msh", fs::path("")}) {
    const Error error = error_of([&] { FileSink sink(target); });
    EXPECT_EQ(error.code(), ErrorCode::write_failed) << target;
    EXPECT_EQ(error.spot().file, target.string());
  }
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  EXPECT_EQ(folder.num_files(), 1u);
}

TEST(FileSink, NamesOfFullLengthWork) {
  const Folder folder;
  const std::string name(255, 'n');
  FileSink sink(folder / name);
  sink.put("x");
  sink.commit();
  EXPECT_EQ(contents(folder / name), "x");
}

TEST(FileSink, RefusesAtOnceWhatTheDiskCannotHold) {
  const Folder folder;
  const Error error = error_of([&] { FileSink sink(folder / "a", std::uint64_t{1} << 60); });
  EXPECT_EQ(error.code(), ErrorCode::write_failed);
  EXPECT_NE(error.text().find(" GB are needed"), std::string::npos) << error.text();
  EXPECT_NE(error.text().find("are free"), std::string::npos) << error.text();
  EXPECT_EQ(folder.num_files(), 0u);
}

TEST(FileSink, AWriteThatFailsIsReportedAndCleanedUp) {
  const Folder folder;
  create(folder / "a", "old");
  const int status = in_child([&] {
    const rlimit limit{1 << 20, 1 << 20};
    ::signal(SIGXFSZ, SIG_IGN);
    ::setrlimit(RLIMIT_FSIZE, &limit);
    try {
      FileSink sink(folder / "a");
      sink.put(std::string(2 << 20, 'x'));
      sink.commit();
    } catch (const Error& error) {
      return error.code() == ErrorCode::write_failed && error.text().find("1.0 MB were written") != std::string::npos ? 0 : 2;
    }
    return 3;
  });
  EXPECT_EQ(status, 0);
  EXPECT_EQ(contents(folder / "a"), "old");
  EXPECT_EQ(folder.num_files(), 1u);
}

TEST(FileSink, AFullDiskIsReportedAndCleanedUp) {
  const Folder folder;
  const int status = in_child([&] {
    const uid_t user = ::getuid();
    const gid_t group = ::getgid();
    if (::unshare(CLONE_NEWNS) != 0) {
      if (::unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) return 77;
      // Without these maps no file can be made.
      create("/proc/self/uid_map", "0 " + std::to_string(user) + " 1");
      create("/proc/self/setgroups", "deny");
      create("/proc/self/gid_map", "0 " + std::to_string(group) + " 1");
    }
    if (::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0) return 77;
    if (::mount("tmpfs", folder.path().c_str(), "tmpfs", 0, "size=1m") != 0) return 77;
    create(folder / "a", "old");
    try {
      FileSink sink(folder / "a");
      sink.put(std::string(2 << 20, 'x'));
      sink.commit();
      return 3;
    } catch (const Error& error) {
      if (error.code() != ErrorCode::write_failed || error.text().find("No space left") == std::string::npos) return 2;
    }
    return contents(folder / "a") == "old" && folder.num_files() == 1 ? 0 : 4;
  });
  if (status == 77) GTEST_SKIP() << "may not mount a small disk here";
  EXPECT_EQ(status, 0);
}

TEST(FileSink, AKillAtAnyMomentLeavesTheOldOrTheNewFile) {
  const Folder folder;
  const fs::path target = folder / "a";
  const auto whole = [](char fill) { return std::string(4 << 20, fill); };
  create(target, whole('0'));
  std::mt19937 random(7);
  int killed = 0;
  for (int run = 0; run < 40; ++run) {
    const char fill = static_cast<char>('a' + run % 26);
    const std::string before = contents(target);
    const pid_t child = ::fork();
    if (child == 0) {
      try {
        FileSink sink(target);
        for (int i = 0; i < (4 << 20); ++i) sink.put_raw(fill);
        sink.commit();
      } catch (...) {
        ::_exit(1);
      }
      ::_exit(0);
    }
    ::usleep(static_cast<useconds_t>(random() % 20'000));
    ::kill(child, SIGKILL);
    int status = 0;
    ::waitpid(child, &status, 0);
    killed += WIFSIGNALED(status);
    const std::string after = contents(target);
    ASSERT_TRUE(after == before || after == whole(fill)) << "run " << run << " left " << after.size() << " bytes";
  }
  EXPECT_GT(killed, 0) << "no run was cut short: the test proves nothing";
  for (const fs::directory_entry& entry : fs::directory_iterator(folder.path()))
    EXPECT_TRUE(entry.path() == target || entry.path().extension() == ".part") << entry.path();
}

TEST(FileSink, NumbersReadBackExactlyInAnyLocale) {
  const Folder folder;
  const char* german = std::setlocale(LC_ALL, "de_DE.UTF-8");
  const double values[] = {0.1, 1e-9, -2.5, 1.0 / 3, 123456789.125, std::numeric_limits<double>::max(), 5e-324, 0.0};
  FileSink sink(folder / "a");
  for (double value : values) {
    sink.put_number(value);
    sink.put("\n");
  }
  sink.put_number(std::numeric_limits<std::int64_t>::min());
  sink.commit();
  if (german != nullptr) std::setlocale(LC_ALL, "C");
  std::ifstream in(folder / "a");
  std::string word;
  for (double value : values) {
    in >> word;
    double back = 0;
    std::from_chars(word.data(), word.data() + word.size(), back);
    EXPECT_EQ(back, value) << word;
  }
  in >> word;
  EXPECT_EQ(word, "-9223372036854775808");
}

}  // namespace
}  // namespace pcbmesh::formats
