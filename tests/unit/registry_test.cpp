// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/formats/registry.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <functional>
#include <set>

#include "folder.hpp"
#include "pcbmesh/base/error.hpp"
#include "sample_prism_mesh.hpp"
#include "thrown_error.hpp"

namespace pcbmesh::formats {
namespace {

using testing::contents;
using testing::create;
using testing::error_of;
using testing::Folder;

TEST(Registry, NamesAndEndingsAreUnambiguous) {
  std::set<std::string_view> names, endings;
  const auto add = [&](const auto& format) {
    EXPECT_TRUE(names.insert(format.name).second) << format.name;
    EXPECT_FALSE(format.title.empty());
    for (const std::string_view ending : format.extensions) {
      EXPECT_TRUE(ending.starts_with('.')) << ending;
      EXPECT_TRUE(endings.insert(ending).second) << ending;
    }
  };
  for (const BoardFormat* format : board_formats()) add(*format);
  for (const MeshFormat* format : mesh_formats()) {
    add(*format);
    EXPECT_TRUE(format->write != nullptr || format->read != nullptr);
  }
  EXPECT_GE(names.size(), 4u);
}

TEST(Registry, BoardsAreKnownByTheirFirstBytesWhateverTheirName) {
  const Folder folder;
  const auto code_of = [&](const std::string& name, const std::string& text) {
    create(folder / name, text);
    return error_of([&] { static_cast<void>(read_board(folder / name)); });
  };
  // Half a board: the right reader is found, and it is the one that complains.
  EXPECT_NE(code_of("a.txt", "(kicad_pcb (version 20221018").code(), ErrorCode::format_unknown);
  EXPECT_NE(code_of("b.txt", "{\"pcbmesh_board\": 1").code(), ErrorCode::format_unknown);
  EXPECT_NE(code_of("c.KICAD_PCB", "no board at all").code(), ErrorCode::format_unknown) << "the ending decides";
}

TEST(Registry, UnknownBoardsShowTheirHeadAndTheList) {
  const Folder folder;
  create(folder / "a.brd", "<eagle>\n\x1B[2J");
  const Error error = error_of([&] { static_cast<void>(read_board(folder / "a.brd")); });
  EXPECT_EQ(error.code(), ErrorCode::format_unknown);
  EXPECT_NE(error.text().find("'<eagle>..[2J'"), std::string::npos) << error.text();
  EXPECT_NE(error.text().find("kicad (.kicad_pcb)"), std::string::npos) << error.text();
  EXPECT_EQ(error_of([&] { static_cast<void>(read_board(folder / "a.brd", "altium")); }).code(), ErrorCode::format_unknown);
  EXPECT_EQ(error_of([&] { static_cast<void>(read_board(folder / "absent.brd")); }).code(), ErrorCode::file_unreadable);
}

TEST(Registry, MeshesAreWrittenByEndingOrByName) {
  const mesh::PrismMesh mesh = mesh::PrismMesh::from_parts(testing::plain_parts(2, 2, 2));
  const Folder folder;
  write_mesh(mesh, folder / "a.msh", {});
  write_mesh(mesh, folder / "b.MSH", {});
  write_mesh(mesh, folder / "c.dat", {}, "msh");
  write_mesh(mesh, folder / "d.vtu", {});
  EXPECT_EQ(contents(folder / "a.msh"), contents(folder / "b.MSH"));
  EXPECT_EQ(contents(folder / "a.msh"), contents(folder / "c.dat"));
  EXPECT_TRUE(contents(folder / "d.vtu").starts_with("<?xml"));
  EXPECT_EQ(folder.num_files(), 4u);
  for (const char* name : {"a.stl", "a", "a.msh.gz", "a.msh.xz"})
    EXPECT_EQ(error_of([&] { write_mesh(mesh, folder / name, {}); }).code(), ErrorCode::usage) << name;
  EXPECT_EQ(error_of([&] { write_mesh(mesh, folder / "a.msh", {}, "stl"); }).code(), ErrorCode::usage);
  EXPECT_EQ(folder.num_files(), 4u);
}

TEST(Registry, MeshesAreReadByEndingPackedOrNot) {
  const mesh::PrismMesh mesh = mesh::PrismMesh::from_parts(testing::plain_parts(2, 2, 2));
  const Folder folder;
  write_mesh(mesh, folder / "a.msh", {});
  const std::string bytes = contents(folder / "a.msh"), packed_name = (folder / "a.msh.gz").string();
  gzFile packed = gzopen(packed_name.c_str(), "wb");
  gzwrite(packed, bytes.data(), static_cast<unsigned>(bytes.size()));
  gzclose(packed);
  EXPECT_EQ(read_mesh(folder / "a.msh").cells.at(0).size(), mesh.num_prisms());
  EXPECT_EQ(read_mesh(packed_name).nodes, read_mesh(folder / "a.msh").nodes);
  const Error error = error_of([&] { static_cast<void>(read_mesh(folder / "a.pvtu")); });
  EXPECT_EQ(error.code(), ErrorCode::format_unknown);
  EXPECT_NE(error.text().find("these are read: msh"), std::string::npos) << error.text();
  EXPECT_EQ(error_of([&] { static_cast<void>(read_mesh(folder / "a.stl")); }).code(), ErrorCode::format_unknown);
  EXPECT_EQ(error_of([&] { static_cast<void>(read_mesh(folder / "absent.msh")); }).code(), ErrorCode::file_unreadable);
}

}  // namespace
}  // namespace pcbmesh::formats
