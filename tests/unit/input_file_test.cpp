// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/syntax/input_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "pcbmesh/base/error.hpp"

namespace {

using namespace pcbmesh;
using formats::syntax::read_head;
using formats::syntax::read_whole_file;

class InputFile : public testing::Test {
 protected:
  void SetUp() override {
    folder = std::filesystem::temp_directory_path() /
             ("pcbmesh_input_" + std::to_string(getpid()) + testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder);
    for (int i = 0; i < 20000; ++i) text += "line " + std::to_string(i) + "\n";
    plain = put("plain.txt", text);
  }
  void TearDown() override { std::filesystem::remove_all(folder); }
  std::filesystem::path put(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder / name, std::ios::binary) << bytes;
    return folder / name;
  }
  std::filesystem::path pack(const std::string& program, const std::string& name) const {
    const std::string command = program + " -c '" + plain.string() + "' > '" + (folder / name).string() + "'";
    EXPECT_EQ(std::system(command.c_str()), 0);
    return folder / name;
  }
  static ErrorCode error_of(const std::filesystem::path& file) {
    try {
      (void)read_whole_file(file);
    } catch (const Error& error) {
      EXPECT_EQ(error.spot().file, file.string());
      return error.code();
    }
    return ErrorCode::internal;
  }
  std::filesystem::path folder, plain;
  std::string text;
};

TEST_F(InputFile, ReadsPlainAndPackedFilesAlike) {
  EXPECT_EQ(read_whole_file(plain), text);
  EXPECT_EQ(read_whole_file(pack("xz", "a.xz")), text);
  EXPECT_EQ(read_whole_file(pack("gzip", "a.gz")), text);
  EXPECT_EQ(read_whole_file(pack("gzip", "packed_without_the_ending")), text);
  EXPECT_EQ(read_head(folder / "a.xz", 100), text.substr(0, 100));
  EXPECT_EQ(read_head(plain, 1000000), text);
  EXPECT_EQ(read_whole_file(put("empty", "")), "");
}

TEST_F(InputFile, JoinsSeveralStreams) {
  for (const char* program : {"xz", "gzip"}) {
    std::ifstream in(pack(program, "one"), std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(in)), {});
    EXPECT_EQ(read_whole_file(put("two", bytes + bytes)), text + text) << program;
  }
}

TEST_F(InputFile, SaysWhatIsWrong) {
  EXPECT_EQ(error_of(folder / "absent"), ErrorCode::file_unreadable);
  EXPECT_EQ(error_of(folder), ErrorCode::file_unreadable);
  EXPECT_EQ(error_of(put("no.xz", "not packed at all")), ErrorCode::file_syntax);
  EXPECT_EQ(error_of(put("no.gz", "not packed at all")), ErrorCode::file_syntax);
  EXPECT_EQ(error_of(put("none.gz", "")), ErrorCode::file_truncated);
  for (const std::string program : {"xz", "gzip"}) {
    const auto whole = pack(program, program == "xz" ? "t.xz" : "t.gz");
    std::filesystem::resize_file(whole, std::filesystem::file_size(whole) / 2);
    EXPECT_EQ(error_of(whole), ErrorCode::file_truncated) << program;
  }
}

TEST_F(InputFile, RefusesABomb) {
  // 64 MiB of zeros packed once; 17 members in a row are just above 1 GiB.
  const std::string one = (folder / "one.gz").string(), bomb = (folder / "bomb.gz").string();
  ASSERT_EQ(std::system(("head -c 67108864 /dev/zero | gzip -1 > '" + one + "'").c_str()), 0);
  ASSERT_EQ(
      std::system(("for i in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17; do cat '" + one + "'; done > '" + bomb + "'").c_str()),
      0);
  EXPECT_EQ(error_of(folder / "bomb.gz"), ErrorCode::file_unreadable);
}

TEST(UnpackedName, DropsThePackersEnding) {
  EXPECT_EQ(formats::syntax::unpacked_name("a/b.kicad_pcb.xz"), "b.kicad_pcb");
  EXPECT_EQ(formats::syntax::unpacked_name("a/b.kicad_pcb"), "b.kicad_pcb");
}

}  // namespace
