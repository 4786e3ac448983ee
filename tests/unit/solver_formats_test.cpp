// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <clocale>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <sstream>

#include "folder.hpp"
#include "formats/elements/element_walk.hpp"
#include "formats/face_parents/face_parents.hpp"
#include "formats/sink/folder_sink.hpp"
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

using mesh::ElementKind;
using testing::contents;
using testing::create;
using testing::error_of;
using testing::Folder;

mesh::PrismMesh sample() {
  return mesh::PrismMesh::from_parts(testing::sample_parts());
}

/// Faces of all cells as sorted corners, with the cells that have them: found the slow way.
std::map<std::vector<std::int64_t>, std::vector<std::int64_t>> cells_by_face(mesh::MeshSource& source) {
  std::map<std::vector<std::int64_t>, std::vector<std::int64_t>> out;
  std::int64_t cell = 0;
  for (std::size_t b = 0; b < source.blocks().size(); ++b) {
    const ElementKind kind = source.blocks()[b].kind;
    if (mesh::dimension_of(kind) != 3) continue;
    const auto width = static_cast<std::size_t>(mesh::nodes_of(kind));
    source.visit(b, [&](std::span<const std::int64_t> rows) {
      for (; !rows.empty(); rows = rows.subspan(width), ++cell)
        for (const CellSide& side : sides_of(kind)) {
          std::vector<std::int64_t> key;
          for (int i = 0; i < side.num_corners; ++i) key.push_back(rows[side.corners[static_cast<std::size_t>(i)]]);
          std::ranges::sort(key);
          out[key].push_back(cell);
        }
    });
  }
  return out;
}

TEST(FaceParents, AreTheCellsThatHaveTheFace) {
  const mesh::PrismMesh mesh = sample();
  mesh::PrismSource prisms(mesh);
  extrude::TetrahedralSource twin(prisms);
  extrude::SecondOrderSource second(mesh, {});
  for (mesh::MeshSource* source : {static_cast<mesh::MeshSource*>(&prisms), static_cast<mesh::MeshSource*>(&twin),
                                   static_cast<mesh::MeshSource*>(&second)}) {
    const auto expected = cells_by_face(*source);
    const FaceParents parents(*source, Progress{});
    EXPECT_EQ(parents.num_loose(), 0);
    std::int64_t face = 0;
    for (std::size_t b = 0; b < source->blocks().size(); ++b) {
      const ElementKind kind = source->blocks()[b].kind;
      if (mesh::dimension_of(kind) != 2) continue;
      const auto width = static_cast<std::size_t>(mesh::nodes_of(kind));
      source->visit(b, [&](std::span<const std::int64_t> rows) {
        for (; !rows.empty(); rows = rows.subspan(width), ++face) {
          std::vector<std::int64_t> key(rows.begin(), rows.begin() + mesh::corners_of(kind));
          std::ranges::sort(key);
          std::vector<std::int64_t> found;
          for (const FaceParents::Parent& parent : parents.of(face))
            if (parent.cell >= 0) found.push_back(parent.cell);
          EXPECT_EQ(found, expected.at(key));
        }
      });
    }
    EXPECT_EQ(face, source->num_elements(2));
  }
}

TEST(FaceParents, LooseFacesAreCountedAndRefused) {
  mesh::MeshData data;
  data.nodes.resize(6);
  data.nodes[1] = {1, 0, 0}, data.nodes[2] = {0, 1, 0}, data.nodes[3] = {0, 0, 1}, data.nodes[4] = {1, 1, 1};
  data.cells.push_back({mesh::CellKind::tetrahedron, {0, 1, 2, 3}, {1}});
  data.faces.push_back({mesh::FaceKind::triangle, {0, 1, 2, 1, 2, 4, 0, 2, 1}, {1, 1, 2}});
  mesh::MeshDataSource source(data);
  const FaceParents parents(source, Progress{});
  EXPECT_EQ(parents.num_loose(), 1);
  EXPECT_EQ(parents.of(2)[0].cell, 0) << "the same face in a second group";
  const Folder folder;
  for (const char* name : {"a.exo", "a.inp"}) {
    const Error error = error_of([&] { write_mesh(source, folder / name, {}); });
    EXPECT_EQ(error.code(), ErrorCode::format_limit);
    EXPECT_NE(error.text().find("1 tagged faces"), std::string::npos) << error.text();
  }
  EXPECT_EQ(folder.num_files(), 0u);
}

void expect_same(const mesh::MeshData& a, const mesh::MeshData& b) {
  EXPECT_EQ(a.nodes, b.nodes);
  ASSERT_EQ(a.cells.size(), b.cells.size());
  ASSERT_EQ(a.faces.size(), b.faces.size());
  for (std::size_t i = 0; i < a.cells.size(); ++i) {
    EXPECT_EQ(a.cells[i].kind, b.cells[i].kind);
    EXPECT_EQ(a.cells[i].corners, b.cells[i].corners);
    EXPECT_EQ(a.cells[i].mids, b.cells[i].mids);
    EXPECT_EQ(a.cells[i].tags, b.cells[i].tags);
  }
  for (std::size_t i = 0; i < a.faces.size(); ++i) {
    EXPECT_EQ(a.faces[i].corners, b.faces[i].corners);
    EXPECT_EQ(a.faces[i].mids, b.faces[i].mids);
    EXPECT_EQ(a.faces[i].tags, b.faces[i].tags);
  }
}

std::set<std::tuple<int, std::int32_t, std::string>> names_of(const mesh::MeshData& mesh) {
  std::set<std::tuple<int, std::int32_t, std::string>> out;
  for (const mesh::GroupName& name : mesh.names) out.emplace(name.dimension, name.tag, name.name);
  return out;
}

/// Every format that is read gives back exactly what was written, for every kind of element it holds.
TEST(RoundTrip, GivesBackEveryNumber) {
  const mesh::PrismMesh mesh = sample();
  for (const MeshFormat* format : mesh_formats()) {
    if (format->read == nullptr || format->write == nullptr || format->scope.readable == 0) continue;
    // Abaqus has 20 characters a coordinate and faces as sides: below. The native file computes its cells: native_mesh_test.
    if (format->name == "abaqus" || format->name == "native") continue;
    const bool is_msh = format->name == "msh", is_xdmf = format->name == "xdmf", is_hdf5 = is_xdmf || format->name == "vtkhdf";
    for (const int variant : {0, 1, 2, 3, 4}) {
      mesh::PrismSource prisms(mesh);
      extrude::SecondOrderSource second(mesh, {.with_face_nodes = variant != 2});
      if (variant == 2) {
        EXPECT_THROW(extrude::TetrahedralSource{second}, Error) << "wedges of 15 nodes have no middles of diagonals";
      }
      extrude::TetrahedralSource twin(variant == 4 ? static_cast<mesh::MeshSource&>(second) : prisms);
      mesh::MeshSource& source = variant == 0                   ? static_cast<mesh::MeshSource&>(prisms)
                                 : variant == 1 || variant == 4 ? static_cast<mesh::MeshSource&>(twin)
                                                                : second;
      if (!std::ranges::all_of(source.blocks(), [&](const auto& block) { return holds(format->scope.readable, block.kind); }))
        continue;
      for (const bool binary : {true, false}) {
        if (!binary && is_hdf5) continue;
        for (const char* version : {"", "2.2"}) {
          if (*version != '\0' && !is_msh) continue;
          const Folder folder;
          const std::string name = "a" + std::string(format->extensions[0]);
          try {
            write_mesh(source, folder / name, {.binary = binary, .unit = LengthUnit::metre, .version = version, .faces = true});
          } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::format_not_built) << error.what();
            continue;
          }
          // An XDMF file of cells alone is what dolfinx and meshio read; the one for ParaView has the faces too.
          const mesh::MeshData read = read_mesh(folder / (is_xdmf ? "a_paraview.xdmf" : name)), expected = mesh::expand(source);
          SCOPED_TRACE(std::string(format->name) + " variant " + std::to_string(variant) + " " + version);
          expect_same(read, expected);
        }
      }
    }
  }
}

// Cells exactly; coordinates to their 20 characters; faces as sets, because a side has no first corner.
TEST(Abaqus, GivesBackCellsSidesAndTags) {
  const mesh::PrismMesh mesh = sample();
  for (const int variant : {0, 1, 2, 3}) {
    mesh::PrismSource prisms(mesh);
    extrude::SecondOrderSource second(mesh, {.with_face_nodes = variant == 3});
    extrude::TetrahedralSource twin(variant == 3 ? static_cast<mesh::MeshSource&>(second) : prisms);
    mesh::MeshSource& source = variant == 0   ? static_cast<mesh::MeshSource&>(prisms)
                               : variant == 2 ? static_cast<mesh::MeshSource&>(second)
                                              : twin;
    SCOPED_TRACE(variant);
    const Folder folder;
    write_mesh(source, folder / "a.inp", {});
    const mesh::MeshData read = read_mesh(folder / "a.inp"), expected = mesh::expand(source);
    ASSERT_EQ(read.cells.size(), 1u);
    EXPECT_EQ(read.cells[0].corners, expected.cells[0].corners);
    EXPECT_EQ(read.cells[0].mids, expected.cells[0].mids);
    EXPECT_EQ(read.cells[0].tags, expected.cells[0].tags);
    ASSERT_EQ(read.nodes.size(), expected.nodes.size());
    for (std::size_t i = 0; i < read.nodes.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(read.nodes[i][k], expected.nodes[i][k], 1e-13 * 1e-3);
    const auto faces_of = [](const mesh::MeshData& data) {
      std::multiset<std::tuple<std::int32_t, std::set<std::int64_t>, std::set<std::int64_t>>> out;
      for (const mesh::FaceBlock& block : data.faces) {
        const auto n = static_cast<std::ptrdiff_t>(mesh::corners_of(block.kind));
        for (std::ptrdiff_t i = 0; i < block.size(); ++i)
          out.insert({block.tags[static_cast<std::size_t>(i)],
                      {block.corners.begin() + i * n, block.corners.begin() + (i + 1) * n},
                      {block.mids.begin() + i * block.num_mid, block.mids.begin() + (i + 1) * block.num_mid}});
      }
      return out;
    };
    EXPECT_EQ(faces_of(read), faces_of(expected));
    for (const mesh::GroupName& name : read.names)
      EXPECT_TRUE(names_of(expected).contains({name.dimension, name.tag, name.name})) << name.name;
  }
}

TEST(Abaqus, SaysWhatIsWrongAndWhere) {
  const Folder folder;
  const std::string nodes = "*Node\n1, 0, 0, 0\n2, 1., 0, 0\n3, 0, 1., 0\n4, 0, 0, 1.D0\n";
  struct Case {
    std::string text, expected;
  };
  for (const auto& [text, expected] : std::initializer_list<Case>{
           {"", "empty"},
           {nodes, "no elements"},
           {nodes + "*ELEMENT, TYPE=S3\n1, 1, 2, 3\n", "'S3' are not read"},
           {nodes + "*ELEMENT, TYPE=C3D4\n1, 1, 2, 3\n*STEP\n", "too early"},
           {nodes + "*ELEMENT, TYPE=C3D4\n1, 1, 2, 3\n", "too few"},
           {nodes + "*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 4, 5\n", "has 5 nodes"},
           {nodes + "*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 5\n", "node 5, which does not exist"},
           {nodes + "*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, x\n", "number was expected"},
           {nodes + "*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 4\n*SURFACE, NAME=a\n2, S1\n", "element 2, which does not exist"},
           {nodes + "*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 4\n*SURFACE, NAME=a\n1, S5\n", "no side S5"},
           {"*INCLUDE, INPUT=b.inp\n", "include"},
           {"*NODE\n1, a, 0, 0\n", "coordinate was expected"}}) {
    create(folder / "a.inp", text);
    const Error error = error_of([&] { static_cast<void>(read_mesh(folder / "a.inp")); });
    EXPECT_NE(error.text().find(expected), std::string::npos) << error.text() << " for\n" << text;
    EXPECT_GT(error.spot().line, 0) << error.what();
  }
  // A hand-made file: letters behind the type, an element over two lines, sets with and without numbers.
  create(folder / "b.inp", nodes +
                               "5, 1, 1, 1\n** comment\n*ELEMENT, TYPE=C3D4H, ELSET=copper\n7, 1, 2,\n3, 4\n"
                               "*element, type=c3d4, elset=V9_air\n9, 2, 3, 4, 5\n*SURFACE, NAME=port, TYPE=ELEMENT\n7, S1\n");
  const mesh::MeshData mesh = read_mesh(folder / "b.inp");
  EXPECT_EQ(mesh.cells.at(0).tags, (std::vector<std::int32_t>{1, 9}));
  EXPECT_EQ(mesh.faces.at(0).corners, (std::vector<std::int64_t>{0, 2, 1}));
  EXPECT_EQ(mesh.nodes.at(3)[2], 1.0);
}

TEST(Mfem, NamesComeBackFromVersion13) {
  mesh::PrismSource source(sample());
  const Folder folder;
  write_mesh(source, folder / "a.mesh", {});
  std::set<std::tuple<int, std::int32_t, std::string>> expected;
  for (const mesh::ElementGroup& group : source.groups())
    if (group.num_elements > 0) expected.emplace(group.dimension, group.tag, group.name);
  EXPECT_EQ(names_of(read_mesh(folder / "a.mesh")), expected);
  write_mesh(source, folder / "b.mesh", {.version = "", .mfem_version = "1.0"});
  EXPECT_TRUE(names_of(read_mesh(folder / "b.mesh")).empty());
  EXPECT_TRUE(contents(folder / "b.mesh").starts_with("MFEM mesh v1.0\n"));
}

TEST(Mfem, SaysWhatIsWrongAndWhere) {
  const Folder folder;
  const std::string head = "MFEM mesh v1.0\n\ndimension\n3\n", element = "elements\n1\n1 4 0 1 2 3\n",
                    vertices = "vertices\n4\n3\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
  struct Case {
    std::string text, expected;
  };
  for (const auto& [text, expected] : std::initializer_list<Case>{
           {"", "empty"},
           {"mesh\n", "does not start with"},
           {"MFEM mesh v1.1\n", "version '1.1'"},
           {"MFEM mesh v1.0\ndimension\n2\n", "dimension 2"},
           {head + "elements\n7000000000000\n1 4 0 1 2 3\n", "can't hold them"},
           {head + "elements\n-1\n", "-1 elements"},
           {head + "elements\n1\n1 2 0 1 2\n", "geometry 2"},
           {head + "elements\n1\n0 4 0 1 2 3\n", "numbered from 1"},
           {head + "elements\n1\n1 4 0 1 2 9\n" + vertices, "vertex 9; there are 4"},
           {head + "elements\n1\n1 4 0 1 2 -3\n" + vertices, "vertex -3"},
           {head + element + "vertices\n4\n\nnodes\nFiniteElementSpace\n", "curved"},
           {head + element + "vertices\n4\n2\n0.25 0.25\n1.25 0.25\n0.25 1.25\n1.25 1.25\n", "2 coordinates"},
           {head + element, "without vertices"},
           {head + element + "knots\n", "not known"},
           {head + element + vertices + vertices, "two sections"}}) {
    create(folder / "a.mesh", text);
    const Error error = error_of([&] { static_cast<void>(read_mesh(folder / "a.mesh")); });
    EXPECT_NE(error.text().find(expected), std::string::npos) << error.text() << " for\n" << text;
    EXPECT_GT(error.spot().line, 0) << error.what();
  }
  // Comments and v1.2's end are understood.
  create(folder / "b.mesh", "MFEM mesh v1.2\n# a comment\n\n# two\ndimension\n3\n" + element + "boundary\n0\n" + vertices +
                                "mfem_serial_mesh_end\ncommunication_groups\n");
  EXPECT_EQ(read_mesh(folder / "b.mesh").cells.at(0).size(), 1);
}

// A file cut at any byte, or with any byte changed, gives an error or a mesh, never a crash or a giant allocation.
TEST(Mfem, DamagedFilesEndInAnError) {
  mesh::PrismSource source(sample());
  const Folder folder;
  write_mesh(source, folder / "a.mesh", {});
  const std::string whole = contents(folder / "a.mesh");
  std::mt19937 random(7);
  int num_errors = 0;
  for (int i = 0; i < 400; ++i) {
    std::string text = whole;
    if (i % 2 == 0)
      text.resize(random() % whole.size());
    else
      text[random() % text.size()] = static_cast<char>(random());
    create(folder / "b.mesh", text);
    try {
      static_cast<void>(read_mesh(folder / "b.mesh"));
    } catch (const Error& error) {
      ++num_errors;
      EXPECT_TRUE(error.code() == ErrorCode::file_syntax || error.code() == ErrorCode::file_truncated ||
                  error.code() == ErrorCode::format_unknown)
          << error.what();
    }
  }
  EXPECT_GT(num_errors, 200);
}

TEST(ShortReals, StandNearestWithinTheirWidth) {
  const Folder folder;
  const auto text_of = [&](double value, std::size_t width) {
    FileSink sink(folder / "a");
    put_real(sink, value, width);
    sink.commit();
    return contents(folder / "a");
  };
  EXPECT_EQ(text_of(1, 16), "1.");
  EXPECT_EQ(text_of(-1e-5, 16), "-1.E-05");
  EXPECT_EQ(text_of(0, 16), "0.");
  for (const std::size_t width : {std::size_t{16}, std::size_t{20}}) {
    std::mt19937_64 random(3);
    std::vector<double> values;
    FileSink sink(folder / "a");
    for (int i = 0; i < 2000; ++i) {
      values.push_back(std::ldexp(static_cast<double>(static_cast<std::int64_t>(random())), -static_cast<int>(random() % 90)));
      put_real(sink, values.back(), width);
      sink.put("\n");
    }
    sink.commit();
    std::istringstream lines(contents(folder / "a"));
    std::string text;
    for (const double value : values) {
      ASSERT_TRUE(std::getline(lines, text));
      ASSERT_LE(text.size(), width);
      ASSERT_NE(text.find('.'), std::string::npos) << text;
      EXPECT_NEAR(std::stod(text), value, std::abs(value) * (width == 16 ? 1e-8 : 1e-12)) << text;
    }
  }
}

// A comma for a point would ruin every text format.
TEST(SolverFormats, TextDoesNotDependOnTheLocale) {
  mesh::PrismSource source(sample());
  const Folder folder;
  const auto write_all = [&](const std::string& stem) {
    for (const char* ending : {".mesh", ".inp", ".bdf", ".unv", ".elmer"}) write_mesh(source, folder / (stem + ending), {});
  };
  write_all("a");
  const char* set = nullptr;
  for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8"})
    if (set == nullptr) set = std::setlocale(LC_ALL, name);
  struct Comma : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
  };
  const std::locale old = std::locale::global(std::locale(std::locale::classic(), new Comma));
  write_all("b");
  std::locale::global(old);
  std::setlocale(LC_ALL, "C");
  for (const char* ending : {".mesh", ".inp", ".bdf", ".unv"})
    EXPECT_EQ(contents(folder / ("a" + std::string(ending))), contents(folder / ("b" + std::string(ending)))) << ending;
  EXPECT_EQ(contents(folder / "a.elmer" / "mesh.nodes"), contents(folder / "b.elmer" / "mesh.nodes"));
}

TEST(SolverFormats, CellsWithoutAWordAreRefusedBeforeTheFirstByte) {
  const mesh::PrismMesh mesh = sample();
  extrude::SecondOrderSource source(mesh, {});
  const Folder folder;
  for (const char* ending : {".mesh", ".inp", ".bdf", ".unv", ".elmer"}) {
    const Error error = error_of([&] { write_mesh(source, folder / (std::string("a") + ending), {}); });
    EXPECT_EQ(error.code(), ErrorCode::format_limit) << ending;
    EXPECT_NE(error.text().find("wedge18"), std::string::npos) << error.text();
  }
  EXPECT_EQ(folder.num_files(), 0u);
}

TEST(FolderSink, AppearsWholeOrNotAtAll) {
  const auto is_ours = [](std::string_view name) { return name == "one" || name == "two"; };
  const Folder folder;
  const auto write = [&](const std::string& text, bool commits) {
    FolderSink sink(folder / "a.elmer", is_ours);
    create(sink.file("one"), text);
    if (commits) sink.commit();
  };
  write("first", false);
  EXPECT_EQ(folder.num_files(), 0u);
  write("first", true);
  EXPECT_EQ(contents(folder / "a.elmer" / "one"), "first");
  write("second", false);
  EXPECT_EQ(contents(folder / "a.elmer" / "one"), "first");
  write("second", true);
  EXPECT_EQ(contents(folder / "a.elmer" / "one"), "second");
  EXPECT_EQ(folder.num_files(), 1u);
  // Somebody's file must not go with the old folder.
  create(folder / "a.elmer" / "results.vtu", "precious");
  const Error error = error_of([&] { write("third", true); });
  EXPECT_EQ(error.code(), ErrorCode::write_failed);
  EXPECT_NE(error.text().find("results.vtu"), std::string::npos) << error.text();
  EXPECT_EQ(contents(folder / "a.elmer" / "one"), "second");
  EXPECT_EQ(folder.num_files(), 1u);
  create(folder / "b.elmer", "a file");
  EXPECT_EQ(error_of([&] { FolderSink(folder / "b.elmer", is_ours); }).code(), ErrorCode::write_failed);
}

/// Elmer's boundary names both parents of an inner face and one of an outer.
TEST(Elmer, BoundaryNamesItsParents) {
  mesh::PrismMeshParts parts = testing::sample_parts();
  parts.face_tags.push_back({.id = 5, .name = "sheet|GND", .kind = mesh::FaceTagKind::sheet, .net = 0, .is_inner = true});
  for (std::int32_t t = 0; t < parts.planar.num_triangles(); ++t)
    if (parts.planar.regions()[static_cast<std::size_t>(t)] == 0) parts.caps.push_back({4, 1, t, true});
  std::ranges::sort(parts.caps, {}, [](const mesh::Cap& c) { return std::tuple(c.tag, c.level, c.triangle); });
  for (mesh::VolumeTag& tag : parts.volume_tags) tag.num_prisms = 0, tag.volume_m3 = 0;
  for (mesh::FaceTag& tag : parts.face_tags) tag.num_triangles = tag.num_quads = 0, tag.area_m2 = 0;
  testing::fill_tag_sizes(parts);
  mesh::PrismSource source(mesh::PrismMesh::from_parts(parts));
  const Folder folder;
  write_mesh(source, folder / "a.elmer", {});
  std::istringstream boundary(contents(folder / "a.elmer" / "mesh.boundary"));
  std::int64_t inner = 0, outer = 0;
  for (std::string line; std::getline(boundary, line);) {
    std::istringstream words(line);
    std::int64_t id = 0, tag = 0, first = 0, second = 0, type = 0;
    words >> id >> tag >> first >> second >> type;
    EXPECT_TRUE(type == 303 || type == 404);
    EXPECT_GT(first, 0);
    EXPECT_EQ(second > 0, tag == 5) << line;
    ++(second > 0 ? inner : outer);
  }
  EXPECT_EQ(inner, 8);
  EXPECT_EQ(inner + outer, source.num_elements(2));
  EXPECT_NE(contents(folder / "a.elmer" / "mesh.names").find("$ sheet|GND = 5\n"), std::string::npos);
}

}  // namespace
}  // namespace pcbmesh::formats
