// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <new>
#include <random>

#include "folder.hpp"
#include "formats/msh/format.hpp"
#include "pcbmesh/base/error.hpp"
#include "sample_prism_mesh.hpp"

namespace {
std::atomic<std::size_t> largest_request{0};
}  // namespace

// Not inlined: g++ 12 else takes the pair for mismatched.
[[gnu::noinline]] void* operator new(std::size_t size) {
  if (size > largest_request) largest_request = size;
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace pcbmesh::formats {
namespace {

using testing::contents;
using testing::create;
using testing::Folder;

mesh::MeshData read(const std::filesystem::path& file) {
  return msh::mesh_format.read(file, Progress{});
}

mesh::MeshData read_text(const std::string& text) {
  const Folder folder;
  create(folder / "a.msh", text);
  return read(folder / "a.msh");
}

Error error_of(const std::string& text) {
  try {
    static_cast<void>(read_text(text));
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "no error for\n" << text;
  return {ErrorCode::internal, "none"};
}

/// Bytes one after the other, in the machine's order.
class Bytes {
 public:
  template <class... Values>
  Bytes& ints(Values... values) {
    (put(static_cast<std::int32_t>(values)), ...);
    return *this;
  }
  template <class... Values>
  Bytes& sizes(Values... values) {
    (put(static_cast<std::uint64_t>(values)), ...);
    return *this;
  }
  template <class... Values>
  Bytes& reals(Values... values) {
    (put(static_cast<double>(values)), ...);
    return *this;
  }
  Bytes& text(std::string_view text) {
    bytes_ += text;
    return *this;
  }
  operator std::string() const { return bytes_; }  // NOLINT: reads as bytes wherever they are wanted

 private:
  template <class T>
  void put(T value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  std::string bytes_;
};

const std::string head_22 = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
const std::string head_41 = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";

/// Every element kind that is read, sparse node numbers out of order, a point, a line, an untagged triangle.
const std::string zoo_22 =
    head_22 +
    "$PhysicalNames\n2\n3 7 \"some volume\"\n2 4 \"wall \"\n$EndPhysicalNames\n"
    "$Nodes\n9\n900 0 0 0\n20 1 0 0\n30 0 1 0\n40 0 0 1\n50 1 0 1\n60 0 1 1\n70 1 1 0\n80 1 1 1\n1000000000 .5 .5 "
    "2e0\n$EndNodes\n"
    "$Elements\n8\n1 15 2 1 1 900\n2 1 2 1 1 900 20\n3 2 2 4 4 900 30 20\n4 2 2 0 4 900 30 20\n5 3 2 5 5 900 20 70 30\n"
    "6 4 3 7 7 0 900 20 30 40\n7 6 2 7 7 900 20 30 40 50 60\n8 7 0 900 20 70 30 1000000000\n$EndElements\n";

TEST(MshReader, ReadsEveryFirstOrderKindAndMapsSparseNumbers) {
  const mesh::MeshData mesh = read_text(zoo_22);
  ASSERT_EQ(mesh.nodes.size(), 9u);
  EXPECT_EQ(mesh.nodes[8], (std::array<double, 3>{0.5, 0.5, 2}));
  ASSERT_EQ(mesh.cells.size(), 3u);
  EXPECT_EQ(mesh.cells[0].kind, mesh::CellKind::tetrahedron);
  EXPECT_EQ(mesh.cells[0].corners, (std::vector<std::int64_t>{0, 1, 2, 3}));
  EXPECT_EQ(mesh.cells[0].tags, (std::vector<std::int32_t>{7}));
  EXPECT_EQ(mesh.cells[1].kind, mesh::CellKind::pyramid);
  EXPECT_EQ(mesh.cells[1].corners, (std::vector<std::int64_t>{0, 1, 6, 2, 8}));
  EXPECT_EQ(mesh.cells[1].tags, (std::vector<std::int32_t>{0}));
  EXPECT_EQ(mesh.cells[2].kind, mesh::CellKind::wedge);
  ASSERT_EQ(mesh.faces.size(), 2u);
  EXPECT_EQ(mesh.faces[0].corners, (std::vector<std::int64_t>{0, 2, 1})) << "the untagged triangle is left out";
  EXPECT_EQ(mesh.faces[1].kind, mesh::FaceKind::quadrangle);
  EXPECT_EQ(mesh.faces[1].tags, (std::vector<std::int32_t>{5}));
  EXPECT_EQ(mesh.num_other_elements, (std::vector<std::int64_t>{1, 1}));
  ASSERT_EQ(mesh.names.size(), 2u);
  EXPECT_EQ(mesh.names[0].name, "some volume");
  EXPECT_EQ(mesh.names[1].name, "wall ");
  EXPECT_EQ(mesh.names[1].dimension, 2);
}

TEST(MshReader, ReadsBinary22WithOneHeaderPerElement) {
  const std::string file = Bytes()
                               .text("$MeshFormat\n2.2 1 8\n")
                               .ints(1)
                               .text("\n$EndMeshFormat\n$Nodes\n4\n")
                               .ints(1)
                               .reals(0, 0, 0)
                               .ints(2)
                               .reals(1, 0, 0)
                               .ints(3)
                               .reals(0, 1, 0)
                               .ints(5)
                               .reals(0, 0, 1)
                               .text("\n$EndNodes\n$Elements\n2\n")
                               .ints(2, 1, 2, 10, 3, 3, 1, 3, 2)
                               .ints(4, 1, 3, 11, 9, 1, 0, 1, 2, 3, 5)
                               .text("\n$EndElements\n");
  const mesh::MeshData mesh = read_text(file);
  EXPECT_EQ(mesh.faces.at(0).corners, (std::vector<std::int64_t>{0, 2, 1}));
  EXPECT_EQ(mesh.cells.at(0).corners, (std::vector<std::int64_t>{0, 1, 2, 3}));
  EXPECT_EQ(mesh.cells.at(0).tags, (std::vector<std::int32_t>{9}));
}

/// 4.1 binary as Gmsh itself writes it: a point and a curve entity, bounding lists, nodes on several entities, one parametric.
std::string gmsh_like_41() {
  return Bytes()
      .text("$MeshFormat\n4.1 1 8\n")
      .ints(1)
      .text("\n$EndMeshFormat\n$Entities\n")
      .sizes(1, 1, 1, 2)
      .ints(1)
      .reals(0, 0, 0)
      .sizes(0)
      .ints(4)
      .reals(0, 0, 0, 1, 1, 1)
      .sizes(1)
      .ints(3)
      .sizes(2)
      .ints(1, -1)
      .ints(8)
      .reals(0, 0, 0, 1, 1, 1)
      .sizes(2)
      .ints(5, 6)
      .sizes(1)
      .ints(4)
      .ints(2)
      .reals(0, 0, 0, 1, 1, 1)
      .sizes(1)
      .ints(77)
      .sizes(1)
      .ints(-8)
      .ints(3)
      .reals(0, 0, 0, 1, 1, 1)
      .sizes(0)
      .sizes(0)
      .text("\n$EndEntities\n$Nodes\n")
      .sizes(2, 5, 1, 9)
      .ints(2, 8, 1)
      .sizes(3)
      .sizes(1, 2, 9)
      .reals(0, 0, 0, .1, .2, 1, 0, 0, .1, .2, 0, 1, 0, .1, .2)
      .ints(3, 2, 0)
      .sizes(2)
      .sizes(4, 5)
      .reals(0, 0, 1, 1, 1, 1)
      .text("\n$EndNodes\n$Elements\n")
      .sizes(4, 4, 1, 40)
      .ints(0, 1, 15)
      .sizes(1)
      .sizes(1, 1)
      .ints(2, 8, 2)
      .sizes(1)
      .sizes(7, 1, 9, 2)
      .ints(3, 2, 4)
      .sizes(1)
      .sizes(40, 1, 2, 9, 4)
      .ints(3, 3, 4)
      .sizes(1)
      .sizes(20, 2, 1, 9, 5)
      .text("\n$EndElements\n$NodeData\n\x01$\x02\n$EndNodeData\n");
}

TEST(MshReader, ReadsGroupsThroughEntitiesIn41) {
  const mesh::MeshData mesh = read_text(gmsh_like_41());
  ASSERT_EQ(mesh.nodes.size(), 5u);
  EXPECT_EQ(mesh.nodes[2], (std::array<double, 3>{0, 1, 0}));
  EXPECT_EQ(mesh.faces.at(0).tags, (std::vector<std::int32_t>{5}));
  EXPECT_EQ(mesh.faces.at(0).corners, (std::vector<std::int64_t>{0, 2, 1}));
  EXPECT_EQ(mesh.cells.at(0).tags, (std::vector<std::int32_t>{77, 0}));
  EXPECT_EQ(mesh.cells.at(0).corners, (std::vector<std::int64_t>{0, 1, 2, 3, 1, 0, 2, 4}));
  EXPECT_EQ(mesh.num_other_elements[0], 1);
}

/// A tetrahedron with two of its faces: one of a group, one of none, said to be each other's partner.
std::string linked_22(const std::string& periodic) {
  return head_22 +
         "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n"
         "$Elements\n3\n1 2 2 5 11 1 3 2\n2 2 2 0 12 1 2 4\n3 4 2 7 1 1 2 3 4\n$EndElements\n" +
         periodic;
}

TEST(MshReader, ReadsPeriodicLinksOfSurfacesWithTheirFaces) {
  const mesh::MeshData mesh = read_text(linked_22(
      "$Periodic\n3\n0 1 2\n1\n1 2\n2 11 12\nAffine 1 0 0 3 0 1 0 0 0 0 1 0.5 0 0 0 1\n3\n1 1\n2 2\n3 99\n2 12 13\n0\n"
      "$EndPeriodic\n"));
  ASSERT_EQ(mesh.periodic.size(), 2u);  // links of points and curves are passed over
  const mesh::PeriodicLink& link = mesh.periodic[0];
  EXPECT_NE(link.name.find("11"), std::string::npos);
  EXPECT_EQ(link.nodes, (std::vector<std::array<std::int64_t, 2>>{{0, 0}, {1, 1}, {2, -1}}));
  ASSERT_TRUE(link.from_partner);
  EXPECT_EQ(*link.from_partner, (std::array<double, 12>{1, 0, 0, 3, 0, 1, 0, 0, 0, 0, 1, 0.5}));
  ASSERT_EQ(link.faces.size(), 1u);
  EXPECT_EQ(link.faces[0].corners, (std::vector<std::int64_t>{0, 2, 1}));
  ASSERT_EQ(link.partner_faces.size(), 1u);  // of no group, and so not among MeshData::faces
  EXPECT_EQ(link.partner_faces[0].corners, (std::vector<std::int64_t>{0, 1, 3}));
  EXPECT_FALSE(mesh.periodic[1].from_partner);
  EXPECT_TRUE(mesh.periodic[1].partner_faces.empty());
}

TEST(MshReader, SaysWhatIsWrongWithPeriodicLinks) {
  for (const auto& [periodic, word] :
       std::vector<std::array<std::string, 2>>{{"$Periodic\n1\n3 11 12\n0\n$EndPeriodic\n", "dimension 3"},
                                               {"$Periodic\n1\n2 11 12\nRotation 1\n$EndPeriodic\n", "'Rotation'"},
                                               {"$Periodic\n1\n2 11 12\n4000000000\n1 1\n$EndPeriodic\n", "nodes of a link"},
                                               {"$Periodic\n2\n2 11 12\n1\n1 1\n$EndPeriodic\n", "$EndPeriodic"},
                                               {"$Periodic\n1\n2 11 12\nAffine 1 0 0 x\n$EndPeriodic\n", "'x'"}}) {
    const Error error = error_of(linked_22(periodic));
    EXPECT_TRUE(error.code() == ErrorCode::file_syntax || error.code() == ErrorCode::file_truncated) << error.what();
    EXPECT_NE(error.text().find(word), std::string::npos) << "expected '" << word << "' in: " << error.what();
    EXPECT_GT(error.spot().line, 0) << error.what();
  }
}

TEST(MshReader, ReadsPackedFiles) {
  const Folder folder;
  const std::string name = (folder / "a.msh.gz").string();
  gzFile packed = gzopen(name.c_str(), "wb");
  gzwrite(packed, zoo_22.data(), static_cast<unsigned>(zoo_22.size()));
  gzclose(packed);
  EXPECT_EQ(read(name).nodes.size(), 9u);
}

TEST(MshReader, ReadsLinesOfDosAndUnknownSections) {
  std::string text = zoo_22;
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) text.insert(at, "\r");
  EXPECT_EQ(read_text(text).nodes.size(), 9u);
  std::string commented = "$Comments\n$Nodes $ are below\n$EndComments\n";  // g++ 12 warns of literal + string
  commented.append(zoo_22).append("$NodeData\n1\n\"x\"\n$EndNodeData");
  EXPECT_EQ(read_text(commented).nodes.size(), 9u);
}

TEST(MshReader, SaysWhatIsWrongAndWhere) {
  struct Case {
    std::string text, word;
    std::int64_t line;
  };
  const std::string nodes = "$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n";
  const auto elements = [&](const std::string& rows) { return head_22 + nodes + "$Elements\n1\n" + rows + "\n$EndElements\n"; };
  for (const Case& c : std::vector<Case>{
           {"", "empty", 1},
           {"solid cube\n", "$MeshFormat", 0},
           {"$NOD\n", "version 1", 0},
           {"$MeshFormat\n4 0 8\n$EndMeshFormat\n", "'4'", 2},
           {"$MeshFormat\n4.1 2 8\n", "file type 2", 2},
           {"$MeshFormat\n4.1 0 4\n", "4 bytes", 2},
           {head_22, "$Nodes", 0},
           {head_22 + nodes, "without $Elements", 0},
           {head_22 + "$Elements\n", "before nodes", 0},
           {head_22 + nodes + nodes, "two sections", 0},
           {head_22 + "$Nodes\n1\n1 0 zero 0\n$EndNodes\n", "'zero'", 6},
           {head_22 + "$Nodes\n2\n1 0 0 0\n1 0 0 0\n$EndNodes\n", "node number 1 is given twice", 0},
           {head_22 + "$Nodes\n1\n0 0 0 0\n$EndNodes\n", "not positive", 0},
           {head_22 + "$Nodes\n2\n1 0 0 0\n$EndNodes\n", "'$EndNodes' is no", 0},
           {head_22 + "$Nodes\n1\n1 0 0 0\n2 0 0 0\n$EndNodes\n", "$EndNodes was expected", 0},
           {head_22 + "$Nodes\n-1\n", "-1 nodes", 0},
           {elements("1 2 2 1 1 1 2 4"), "node 4", 12},
           {elements("1 2 2 1 1 1 2 -4"), "node -4", 12},
           {elements("1 17 2 1 1 1 2 3 1 2 3"), "element type 17 is not read", 12},
           {elements("1 0 2 1 1 1 2 3"), "no element type 0", 12},
           {elements("1 2 2 -1 1 1 2 3"), "group -1", 12},
           {elements("1 2 99 1 1 1 2 3"), "99 tags", 12},
           {head_22 + nodes + "$Elements\n2\n5 2 0 1 2 3\n5 2 0 1 2 3\n$EndElements\n", "element number 5 is given twice", 0},
           {head_41 + "$PartitionedEntities\n", "in one piece", 0},
           {head_41 + "$Entities\n0 0 1 0\n1 0 0 0 1 1 1 0 0\n$EndEntities\n$Nodes\n1 1 1 1\n2 1 0 1\n1\n0 0 0\n$EndNodes\n"
                      "$Elements\n1 1 1 1\n2 9 2 1\n1 1 1 1\n$EndElements\n",
            "entity 9", 0},
           {head_41 + "$Nodes\n1 2 1 1\n2 1 0 1\n1\n0 0 0\n$EndNodes\n", "2 nodes", 0},
           {head_41 + "$Nodes\n1 1 1 1\n2 1 0 1\n8\n0 0 0\n$EndNodes\n", "range 1 to 1", 0}}) {
    const Error error = error_of(c.text);
    EXPECT_TRUE(error.code() == ErrorCode::file_syntax || error.code() == ErrorCode::file_truncated) << error.what();
    EXPECT_NE(error.text().find(c.word), std::string::npos) << "expected '" << c.word << "' in: " << error.what();
    EXPECT_GT(error.spot().line, 0) << error.what();
    if (c.line > 0) {
      EXPECT_EQ(error.spot().line, c.line) << error.what();
    }
  }
}

TEST(MshReader, RefusesTheOtherByteOrderWithAPlace) {
  const Error error = error_of(Bytes().text("$MeshFormat\n4.1 1 8\n").ints(0x01000000).text("\n$EndMeshFormat\n"));
  EXPECT_NE(error.text().find("big-endian"), std::string::npos);
  EXPECT_EQ(error.code(), ErrorCode::file_syntax);
}

TEST(MshReader, AbsentFilesAndFoldersAreUnreadable) {
  const Folder folder;
  for (const auto& file : {folder / "absent.msh", folder.path()}) {
    try {
      static_cast<void>(read(file));
      ADD_FAILURE();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::file_unreadable) << error.what();
    }
  }
}

std::vector<std::string> small_files() {
  const mesh::PrismMesh mesh = mesh::PrismMesh::from_parts(testing::plain_parts(1, 1, 2));
  std::vector<std::string> files{zoo_22, gmsh_like_41()};
  const Folder folder;
  for (const std::string version : {"4.1", "2.2"})
    for (const bool binary : {true, false}) {
      write_mesh(mesh, folder / "a.msh", {.binary = binary, .version = version});
      files.push_back(contents(folder / "a.msh"));
    }
  return files;
}

TEST(MshReader, AFileCutAnywhereIsAnError) {
  const Folder folder;
  for (const std::string& whole : small_files()) {
    const bool has_more = whole.find("$NodeData") != std::string::npos;
    const std::size_t needed = has_more ? whole.find("$EndElements") + 12 : whole.size() - 1;
    for (std::size_t size = 0; size < needed; ++size) {
      create(folder / "a.msh", std::string_view(whole).substr(0, size));
      try {
        static_cast<void>(read(folder / "a.msh"));
        FAIL() << "read a file of " << size << " of " << whole.size() << " bytes";
      } catch (const Error& error) {
        ASSERT_TRUE(error.code() == ErrorCode::file_truncated || error.code() == ErrorCode::file_syntax) << error.what();
        ASSERT_TRUE(error.spot().line > 0 || error.spot().byte >= 0) << error.what();
      }
    }
  }
}

TEST(MshReader, DamagedBytesNeverCrashNorAskForMoreThanTheFileJustifies) {
  const Folder folder;
  std::mt19937 random(11);
  const std::vector<std::string> files = small_files();
  for (int run = 0; run < 3000; ++run) {
    std::string bytes = files[random() % files.size()];
    for (auto flips = 1 + random() % 4; flips > 0; --flips) bytes[random() % bytes.size()] = static_cast<char>(random());
    create(folder / "a.msh", bytes);
    largest_request = 0;
    try {
      const mesh::MeshData mesh = read(folder / "a.msh");
      for (const mesh::CellBlock& block : mesh.cells)
        for (const std::int64_t corner : block.corners)
          ASSERT_TRUE(corner >= 0 && corner < static_cast<std::int64_t>(mesh.nodes.size()));
    } catch (const Error& error) {
      ASSERT_NE(error.code(), ErrorCode::internal) << error.what();
    }
    ASSERT_LE(largest_request.load(), (std::size_t{1} << 20) + 64 * bytes.size()) << "run " << run;
  }
}

TEST(MshReader, HugeCountsAreRefusedWithoutMemory) {
  const auto huge = std::uint64_t{1} << 61;
  const Bytes head = Bytes().text("$MeshFormat\n4.1 1 8\n").ints(1).text("\n$EndMeshFormat\n");
  const std::string start = head;
  const std::vector<std::string> files{
      start + std::string(Bytes().text("$Nodes\n").sizes(1, huge, 1, huge)),
      start + std::string(Bytes().text("$Nodes\n").sizes(~std::uint64_t{0}, 1, 1, 1)),
      start + std::string(Bytes().text("$Nodes\n").sizes(1, 1, 1, 1).ints(3, 1, 0).sizes(huge)),
      start + std::string(Bytes().text("$Entities\n").sizes(0, 0, huge, 0)),
      head_22 + "$Nodes\n99999999999999999999\n",
      head_22 + "$Nodes\n9223372036854775807\n",
      head_22 + "$PhysicalNames\n9223372036854775807\n"};
  for (const std::string& file : files) {
    largest_request = 0;
    const Error error = error_of(file);
    EXPECT_TRUE(error.code() == ErrorCode::file_truncated || error.code() == ErrorCode::file_syntax);
    EXPECT_LE(largest_request.load(), std::size_t{2} << 20);
  }
}

TEST(MshReader, CancellingStops) {
  const Folder folder;
  create(folder / "a.msh", zoo_22);
  const std::atomic<bool> cancel = true;
  try {
    static_cast<void>(msh::mesh_format.read(folder / "a.msh", Progress({}, &cancel)));
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::cancelled);
  }
}

}  // namespace
}  // namespace pcbmesh::formats
