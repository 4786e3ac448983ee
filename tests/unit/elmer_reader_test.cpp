// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <random>

#include "folder.hpp"
#include "pcbmesh/base/error.hpp"
#include "pcbmesh/extrude/second_order_source.hpp"
#include "pcbmesh/extrude/tetrahedral_source.hpp"
#include "pcbmesh/formats/registry.hpp"
#include "pcbmesh/mesh/mesh_data_source.hpp"
#include "pcbmesh/mesh/prism_source.hpp"
#include "sample_prism_mesh.hpp"
#include "thrown_error.hpp"

namespace pcbmesh::formats {
namespace {

using testing::contents;
using testing::create;
using testing::error_of;
using testing::Folder;

TEST(ElmerReader, GivesBackEveryNumber) {
  const mesh::PrismMesh mesh = mesh::PrismMesh::from_parts(testing::sample_parts());
  for (const int variant : {0, 1, 2, 3}) {
    mesh::PrismSource prisms(mesh);
    extrude::SecondOrderSource second(mesh, {.with_face_nodes = variant == 3});
    extrude::TetrahedralSource twin(variant == 3 ? static_cast<mesh::MeshSource&>(second) : prisms);
    mesh::MeshSource& source = variant == 0   ? static_cast<mesh::MeshSource&>(prisms)
                               : variant == 2 ? static_cast<mesh::MeshSource&>(second)
                                              : twin;
    SCOPED_TRACE(variant);
    const Folder folder;
    write_mesh(source, folder / "a.elmer", {});
    const mesh::MeshData expected = mesh::expand(source);
    // The folder by its ending, by its header, and by what is in it.
    std::filesystem::copy(folder / "a.elmer", folder / "b");
    for (const auto& file : {folder / "a.elmer", folder / "b", folder / "b" / "mesh.header"}) {
      const mesh::MeshData read = read_mesh(file);
      EXPECT_EQ(read.format.name, "elmer");
      EXPECT_EQ(read.nodes, expected.nodes);
      const auto same = [](const auto& a, const auto& b) {
        return a.kind == b.kind && a.corners == b.corners && a.tags == b.tags && a.mids == b.mids;
      };
      ASSERT_EQ(read.cells.size(), expected.cells.size());
      for (std::size_t i = 0; i < read.cells.size(); ++i) EXPECT_TRUE(same(read.cells[i], expected.cells[i])) << i;
      ASSERT_EQ(read.faces.size(), expected.faces.size());
      for (std::size_t i = 0; i < read.faces.size(); ++i) EXPECT_TRUE(same(read.faces[i], expected.faces[i])) << i;
      EXPECT_EQ(read.names.size(), expected.names.size());
      for (const mesh::GroupName& name : read.names)
        EXPECT_TRUE(std::ranges::any_of(expected.names, [&](const mesh::GroupName& other) {
          return other.dimension == name.dimension && other.tag == name.tag && other.name == name.name;
        })) << name.name;
    }
  }
}

struct Files {
  std::string header = "4 1 2\n2\n504 1\n303 2\n", nodes = "1 -1 0 0 0\n2 -1 1 0 0\n5 -1 0 1 0\n7 -1 0 0 1\n",
              elements = "1 3 504 1 2 5 7\n", boundary = "1 2 1 0 303 1 5 2\n2 0 1 0 303 1 2 7\n",
              names = "$ everywhere = 9\n! ----- names for boundaries -----\n$ lower side = 2\n";

  void write_to(const Folder& folder) const {
    create(folder / "mesh.header", header);
    create(folder / "mesh.nodes", nodes);
    create(folder / "mesh.elements", elements);
    create(folder / "mesh.boundary", boundary);
    create(folder / "mesh.names", names);
  }
};

TEST(ElmerReader, ReadsFilesOfOthers) {
  const Folder folder;
  Files{}.write_to(folder);
  const mesh::MeshData mesh = read_mesh(folder.path());
  EXPECT_EQ(mesh.cells.at(0).corners, (std::vector<std::int64_t>{0, 1, 2, 3}));
  EXPECT_EQ(mesh.cells.at(0).tags, (std::vector<std::int32_t>{3}));
  EXPECT_EQ(mesh.faces.at(0).tags, (std::vector<std::int32_t>{2}));
  EXPECT_EQ(mesh.num_untagged[2], 1);
  ASSERT_EQ(mesh.names.size(), 3u);  // without a heading a name is of both
  EXPECT_EQ(mesh.names[2].name, "lower side");
  EXPECT_EQ(mesh.names[2].dimension, 2);
}

TEST(ElmerReader, SaysWhatIsWrongInWhichFile) {
  struct Case {
    std::string Files::*file;
    std::string text, said, place;
  };
  for (const Case& c :
       std::vector<Case>{{&Files::header, "4 1\n", "", "mesh.header"},
                         {&Files::header, "5 1 2\n", "", "mesh.nodes"},
                         {&Files::header, "400000000000 1 2\n", "nodes", "mesh.nodes"},
                         {&Files::header, "3 1 2\n", "goes on", "mesh.nodes"},
                         {&Files::nodes, "1 -1 0 0 0\n2 -1 1 0 0\n5 -1 0 x 0\n7 -1 0 0 1\n", "'x'", "mesh.nodes"},
                         {&Files::elements, "1 3 504 1 2 5 8\n", "node 8", "mesh.elements"},
                         {&Files::elements, "1 3 827 1 2 5 7\n", "type 827", "mesh.elements"},
                         {&Files::elements, "1 3 303 1 2 5\n", "a surface", "mesh.elements"},
                         {&Files::boundary, "1 2 1 0 504 1 5 2 7\n2 0 1 0 303 1 2 7\n", "a volume", "mesh.boundary"},
                         {&Files::boundary, "1 2 1 0 303 1 5 2\n", "", "mesh.boundary"},
                         {&Files::names, "$ a\n", "'$ name = number'", "mesh.names"},
                         {&Files::names, "$ a = b\n", "number was expected", "mesh.names"},
                         {&Files::names, "= 3\n", "'$ name = number'", "mesh.names"}}) {
    const Folder folder;
    Files files;
    files.*c.file = c.text;
    files.write_to(folder);
    const Error error = error_of([&] { static_cast<void>(read_mesh(folder.path())); });
    EXPECT_TRUE(error.code() == ErrorCode::file_syntax || error.code() == ErrorCode::file_truncated) << error.what();
    EXPECT_NE(error.text().find(c.said), std::string::npos) << error.what();
    EXPECT_EQ(std::filesystem::path(error.spot().file).filename(), c.place) << error.what();
  }
  const Folder folder;
  Files{}.write_to(folder);
  std::filesystem::remove(folder / "mesh.boundary");
  const Error error = error_of([&] { static_cast<void>(read_mesh(folder.path())); });
  EXPECT_EQ(error.code(), ErrorCode::file_unreadable) << error.what();
}

TEST(ElmerReader, DamagedFilesEndInAnErrorOrAMesh) {
  std::mt19937 random(7);
  int num_errors = 0;
  for (int i = 0; i < 400; ++i) {
    Files files;
    std::string& text =
        std::array{&files.header, &files.nodes, &files.elements, &files.boundary, &files.names}[random() % 5][0];
    if (i % 2 == 0)
      text.resize(random() % text.size());
    else
      text[random() % text.size()] = static_cast<char>(random());
    const Folder folder;
    files.write_to(folder);
    try {
      static_cast<void>(read_mesh(folder.path()));
    } catch (const Error&) {
      ++num_errors;
    }
  }
  EXPECT_GT(num_errors, 100);
}

}  // namespace
}  // namespace pcbmesh::formats
