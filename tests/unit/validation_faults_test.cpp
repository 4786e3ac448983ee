// SPDX-License-Identifier: GPL-3.0-or-later
// Every kind of damage is found, under the code docs/checks.md promises.
#include <gtest/gtest.h>

#include <limits>

#include "unit/check_block.hpp"

namespace pcbmesh::validation {
namespace {

using tests::CheckCase;

CheckCase board() {
  return tests::build_block(tests::board_plan());
}

bool has(const Report& report, const std::string& code) {
  return std::any_of(report.findings.begin(), report.findings.end(), [&](const Finding& f) { return f.code == code; });
}

const Finding& finding(const Report& report, const std::string& code) {
  for (const Finding& f : report.findings) {
    if (f.code == code) return f;
  }
  static const Finding none;
  ADD_FAILURE() << code << " was not found:\n" << to_text(report);
  return none;
}

/// The damaged mesh fails, and the code is among the findings.
Report expect_found(const CheckCase& damaged, const std::string& code) {
  const Report report = check(damaged.mesh, &damaged.expectation, {.num_threads = 1});
  EXPECT_FALSE(report.passed());
  EXPECT_TRUE(has(report, code)) << code << "\n" << to_text(report);
  return report;
}

// The board's nodes and cells by place: 6 x 6 nodes per level, two prisms per square.
std::int64_t node(int x, int y, int k) {
  return (k * 6 + y) * 6 + x;
}
std::int64_t prism(int x, int y, int k, int half = 0) {
  return ((k * 5 + y) * 5 + x) * 2 + half;
}
std::int64_t& corner(CheckCase& c, std::int64_t cell, int i) {
  return c.mesh.cells[0].corners[static_cast<std::size_t>(6 * cell + i)];
}
std::array<double, 3>& at(CheckCase& c, std::int64_t id) {
  return c.mesh.nodes[static_cast<std::size_t>(id)];
}
void erase_cell(CheckCase& c, std::int64_t cell) {
  auto& block = c.mesh.cells[0];
  block.corners.erase(block.corners.begin() + 6 * cell, block.corners.begin() + 6 * cell + 6);
  block.tags.erase(block.tags.begin() + cell);
}
void add_cell(CheckCase& c, const std::array<std::int64_t, 6>& corners, std::int32_t tag) {
  auto& block = c.mesh.cells[0];
  block.corners.insert(block.corners.end(), corners.begin(), corners.end());
  block.tags.push_back(tag);
}
std::array<std::int64_t, 6> corners_of_cell(CheckCase& c, std::int64_t cell) {
  std::array<std::int64_t, 6> corners;
  for (int i = 0; i < 6; ++i) corners[static_cast<std::size_t>(i)] = corner(c, cell, i);
  return corners;
}
void add_triangle(CheckCase& c, std::array<std::int64_t, 3> corners, std::int32_t tag) {
  auto& block = c.mesh.faces[0];
  block.corners.insert(block.corners.end(), corners.begin(), corners.end());
  block.tags.push_back(tag);
}
/// A copy of the node at the same place (plus `shift` along x).
std::int64_t twin(CheckCase& c, std::int64_t id, double shift = 0) {
  auto place = at(c, id);
  place[0] += shift;
  c.mesh.nodes.push_back(place);
  return static_cast<std::int64_t>(c.mesh.nodes.size()) - 1;
}
/// All cells of the upper layer get nodes of their own on level 2: the layers lie on each other unconnected.
void crack_between_layers(CheckCase& c, double shift) {
  std::vector<std::int64_t> copy(c.mesh.nodes.size(), -1);
  for (std::int64_t cell = prism(0, 0, 2); cell < 150; ++cell) {
    for (int i = 0; i < 3; ++i) {
      std::int64_t& id = corner(c, cell, i);
      std::int64_t& to = copy[static_cast<std::size_t>(id)];
      if (to < 0) to = twin(c, id, shift);
      id = to;
    }
  }
}

TEST(Check, FindsAnInvertedCell) {
  CheckCase c = board();
  std::swap(corner(c, 60, 1), corner(c, 60, 2));
  std::swap(corner(c, 60, 4), corner(c, 60, 5));
  const Report report = expect_found(c, "cell.inverted");
  EXPECT_TRUE(has(report, "face.same_orientation"));
  EXPECT_TRUE(has(report, "volume.not_enclosed"));
  EXPECT_EQ(finding(report, "cell.inverted").places.at(0).cell, 60);
}

TEST(Check, FindsACellTurnedUpsideDown) {
  CheckCase c = board();
  for (int i = 0; i < 3; ++i) std::swap(corner(c, 60, i), corner(c, 60, i + 3));
  expect_found(c, "cell.inverted");
}

TEST(Check, FindsTwoSwappedCorners) {
  CheckCase c = board();
  std::swap(corner(c, 60, 1), corner(c, 60, 2));
  const Report report = expect_found(c, "cell.folded");
  EXPECT_TRUE(has(report, "face.untagged"));
}

TEST(Check, FindsANodeMovedThroughItsNeighbours) {
  CheckCase c = board();
  at(c, node(2, 2, 1))[1] += 1.5e-3;
  const Report report = expect_found(c, "cell.folded");
  EXPECT_TRUE(has(report, "volume.wrong")) << "the strip's neighbours lose area";
}

TEST(Check, FindsANodeMovedUpAnInterface) {
  CheckCase c = board();
  at(c, node(2, 2, 1))[2] += 1e-6;
  const Report report = expect_found(c, "volume.wrong");
  EXPECT_FALSE(has(report, "cell.folded"));
}

TEST(Check, FindsAFlatCell) {
  CheckCase c = board();
  at(c, node(2, 2, 2))[2] = at(c, node(2, 2, 1))[2];
  expect_found(c, "cell.flat");
}

TEST(Check, FindsAMissingCell) {
  CheckCase c = board();
  erase_cell(c, prism(2, 2, 1));
  const Report report = expect_found(c, "face.untagged");
  EXPECT_EQ(finding(report, "face.untagged").count, 5);
  EXPECT_TRUE(has(report, "volume.cell_count"));
}

TEST(Check, FindsACellThatIsThereTwice) {
  CheckCase c = board();
  add_cell(c, corners_of_cell(c, 60), 4);
  const Report report = expect_found(c, "cell.duplicate");
  EXPECT_EQ(finding(report, "cell.duplicate").count, 1);
  EXPECT_EQ(finding(report, "cell.duplicate").places.at(0).cell, 150);
  EXPECT_TRUE(has(report, "face.many_owners"));
  EXPECT_TRUE(has(report, "boundary.open") || has(report, "volume.not_enclosed"));
}

TEST(Check, FindsATwinWithTurnedCorners) {
  CheckCase c = board();
  const auto p = corners_of_cell(c, 60);
  add_cell(c, {p[1], p[2], p[0], p[4], p[5], p[3]}, 4);
  EXPECT_EQ(finding(expect_found(c, "cell.duplicate"), "cell.duplicate").count, 1);
}

TEST(Check, FindsATwinWithNodesOfItsOwn) {
  CheckCase c = board();
  auto p = corners_of_cell(c, 60);
  for (auto& id : p) id = twin(c, id);
  add_cell(c, p, 4);
  EXPECT_EQ(finding(expect_found(c, "node.duplicate"), "node.duplicate").count, 6);
}

TEST(Check, FindsAThirdCellOnAFace) {
  CheckCase c = board();
  auto p = corners_of_cell(c, prism(2, 2, 1));
  for (std::size_t i = 3; i < 6; ++i) p[i] = twin(c, p[i], 1e-4);
  add_cell(c, p, 4);
  const Report report = expect_found(c, "face.many_owners");
  EXPECT_TRUE(has(report, "boundary.open"));
}

TEST(Check, FindsADiagonalMismatchInside) {
  CheckCase c = board();
  const std::int64_t a = node(2, 2, 1), b = node(3, 2, 1), d = node(2, 3, 1), e = node(3, 3, 1);
  erase_cell(c, prism(2, 2, 1, 1));
  erase_cell(c, prism(2, 2, 1, 0));
  add_cell(c, {a, b, d, a + 36, b + 36, d + 36}, 4);
  add_cell(c, {b, e, d, b + 36, e + 36, d + 36}, 4);
  const Report report = expect_found(c, "boundary.overlap");
  EXPECT_FALSE(has(report, "volume.wrong"));
  EXPECT_EQ(finding(report, "face.untagged").count, 8);
}

TEST(Check, FindsADiagonalMismatchWithoutTagsOrExpectation) {
  CheckCase c = board();
  c.mesh.faces.clear();
  c.mesh.names.clear();
  const Report before = check(c.mesh, nullptr);
  EXPECT_TRUE(before.passed());
  EXPECT_TRUE(has(before, "face.none_tagged"));
  EXPECT_TRUE(has(before, "tag.no_names"));
  const std::int64_t a = node(2, 2, 1), b = node(3, 2, 1), d = node(2, 3, 1), e = node(3, 3, 1);
  erase_cell(c, prism(2, 2, 1, 1));
  erase_cell(c, prism(2, 2, 1, 0));
  add_cell(c, {a, b, d, a + 36, b + 36, d + 36}, 4);
  add_cell(c, {b, e, d, b + 36, e + 36, d + 36}, 4);
  const Report report = check(c.mesh, nullptr);
  EXPECT_FALSE(report.passed());
  EXPECT_TRUE(has(report, "boundary.overlap"));
}

/// Cuts prism (2, 2, 1) in two through the middle of its first edge; the neighbours stay whole.
CheckCase hanging_node() {
  CheckCase c = board();
  const auto p = corners_of_cell(c, prism(2, 2, 1));
  erase_cell(c, prism(2, 2, 1));
  std::array<std::int64_t, 2> mid{};
  for (std::size_t k = 0; k < 2; ++k) {
    const auto a = at(c, p[3 * k]), b = at(c, p[3 * k + 1]);
    c.mesh.nodes.push_back({0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), a[2]});
    mid[k] = static_cast<std::int64_t>(c.mesh.nodes.size()) - 1;
  }
  add_cell(c, {p[0], mid[0], p[2], p[3], mid[1], p[5]}, 4);
  add_cell(c, {mid[0], p[1], p[2], mid[1], p[4], p[5]}, 4);
  for (auto& volume : c.expectation.volumes) volume.num_cells = -1;
  return c;
}

TEST(Check, FindsAHangingNode) {
  const CheckCase c = hanging_node();
  const Report report = expect_found(c, "node.hanging");
  EXPECT_EQ(finding(report, "node.hanging").count, 2);
  EXPECT_EQ(finding(report, "node.hanging").places.at(0).node, 144);
  EXPECT_TRUE(has(report, "boundary.overlap"));
  EXPECT_FALSE(has(report, "volume.wrong"));
}

TEST(Check, FindsAHangingNodeWithoutTagsOrExpectation) {
  CheckCase c = hanging_node();
  c.mesh.faces.clear();
  EXPECT_TRUE(has(check(c.mesh, nullptr), "node.hanging"));
}

TEST(Check, FindsANodeInsideAFace) {
  CheckCase c = board();
  // The prism's bottom gets a middle node: three prisms above, one triangle below.
  const auto p = corners_of_cell(c, prism(2, 2, 1));
  erase_cell(c, prism(2, 2, 1));
  std::array<std::int64_t, 2> mid{};
  for (std::size_t k = 0; k < 2; ++k) {
    std::array<double, 3> sum{};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += at(c, p[3 * k + i])[axis] / 3;
    }
    c.mesh.nodes.push_back(sum);
    mid[k] = static_cast<std::int64_t>(c.mesh.nodes.size()) - 1;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    add_cell(c, {p[i], p[j], mid[0], p[3 + i], p[3 + j], mid[1]}, 4);
  }
  const Report report = expect_found(c, "node.hanging");
  EXPECT_EQ(finding(report, "node.hanging").count, 2);
}

TEST(Check, FindsAQuadOnTwoTriangles) {
  CheckCase c = board();
  const auto p = corners_of_cell(c, prism(2, 2, 1));
  erase_cell(c, prism(2, 2, 1));
  mesh::CellBlock tets;
  tets.kind = mesh::CellKind::tetrahedron;
  tets.corners = {p[0], p[4], p[5], p[3], p[0], p[1], p[2], p[5], p[0], p[1], p[5], p[4]};
  tets.tags = {4, 4, 4};
  c.mesh.cells.push_back(tets);
  const Report report = expect_found(c, "boundary.quad_on_triangles");
  EXPECT_EQ(finding(report, "boundary.quad_on_triangles").count, 6);
}

TEST(Check, FindsACrack) {
  CheckCase c = board();
  crack_between_layers(c, 0);
  const Report report = expect_found(c, "boundary.crack");
  EXPECT_EQ(finding(report, "boundary.crack").count, 50);
  EXPECT_EQ(finding(report, "node.duplicate").count, 36);
}

TEST(Check, FindsACrackNarrowerThanTheTolerance) {
  CheckCase c = board();
  crack_between_layers(c, 1e-12);
  const Report report = expect_found(c, "boundary.crack");
  EXPECT_EQ(finding(report, "node.near_duplicate").count, 36);
  EXPECT_FALSE(has(report, "node.duplicate"));
}

TEST(Check, FindsLayersThatDoNotShareNodesAtAll) {
  CheckCase c = board();
  crack_between_layers(c, 0.3e-3);
  const Report report = expect_found(c, "boundary.overlap");
  EXPECT_TRUE(has(report, "node.hanging"));
}

TEST(Check, FindsAnOrphanNode) {
  CheckCase c = board();
  c.mesh.nodes.push_back({1e-3, 1e-3, 5e-5});
  EXPECT_EQ(finding(expect_found(c, "node.orphan"), "node.orphan").places.at(0).node, 144);
}

TEST(Check, FindsACornerOutOfRange) {
  for (const std::int64_t id : {std::int64_t{-1}, std::int64_t{144}, std::numeric_limits<std::int64_t>::max(),
                                std::numeric_limits<std::int64_t>::min()}) {
    CheckCase c = board();
    corner(c, 60, 3) = id;
    const Report report = expect_found(c, "cell.corner_out_of_range");
    EXPECT_FALSE(has(report, "face.untagged")) << "dependent checks are skipped";
    CheckCase d = board();
    d.mesh.faces[1].corners[7] = id;
    expect_found(d, "face.corner_out_of_range");
  }
}

TEST(Check, FindsACornerUsedTwice) {
  CheckCase c = board();
  corner(c, 60, 3) = corner(c, 60, 4);
  const Report report = expect_found(c, "cell.corner_repeated");
  EXPECT_TRUE(has(report, "cell.flat") || has(report, "cell.folded"));
  CheckCase d = board();
  d.mesh.faces[0].corners[1] = d.mesh.faces[0].corners[0];
  expect_found(d, "face.corner_repeated");
}

TEST(Check, FindsACoordinateThatIsNoNumber) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 1e300}) {
    CheckCase c = board();
    at(c, 50)[1] = bad;
    const Report report = expect_found(c, "node.not_finite");
    EXPECT_EQ(finding(report, "node.not_finite").places.at(0).node, 50);
    EXPECT_NE(to_json(report).find("node.not_finite"), std::string::npos);
  }
}

TEST(Check, FindsArraysThatDisagree) {
  CheckCase c = board();
  c.mesh.cells[0].corners.pop_back();
  expect_found(c, "array.size");
  CheckCase d = board();
  d.mesh.faces[0].tags.pop_back();
  expect_found(d, "array.size");
  CheckCase e = board();
  e.mesh.cells[0].kind = static_cast<mesh::CellKind>(9);
  expect_found(e, "array.kind");
}

TEST(Check, FindsAnEmptyMesh) {
  EXPECT_TRUE(has(check({}, nullptr), "mesh.empty"));
  CheckCase c = board();
  c.mesh.cells.clear();
  const Report report = expect_found(c, "mesh.empty");
  EXPECT_TRUE(has(report, "tag.missing"));
  EXPECT_TRUE(has(report, "face.tagged_no_cell"));
}

TEST(Check, FindsAWrongVolumeTag) {
  CheckCase c = board();
  c.mesh.cells[0].tags[60] = 1;
  const Report report = expect_found(c, "volume.wrong");
  EXPECT_TRUE(has(report, "volume.cell_count"));
}

TEST(Check, FindsCellsWithoutATag) {
  CheckCase c = board();
  c.mesh.cells[0].tags[60] = 0;
  c.mesh.cells[0].tags[61] = -7;
  c.mesh.faces[0].tags[3] = 0;
  const Report report = expect_found(c, "tag.not_positive");
  EXPECT_EQ(std::count_if(report.findings.begin(), report.findings.end(),
                          [](const Finding& f) { return f.code == "tag.not_positive"; }),
            3);
}

TEST(Check, SurvivesWildTags) {
  CheckCase c = board();
  std::mt19937 random(3);
  for (auto& tag : c.mesh.cells[0].tags) tag = static_cast<std::int32_t>(random());
  for (auto& tag : c.mesh.faces[0].tags) tag = static_cast<std::int32_t>(random());
  const Report report = expect_found(c, "tag.unexpected");
  EXPECT_LT(report.findings.size(), 400u);
}

TEST(Check, FindsADroppedName) {
  CheckCase c = board();
  c.mesh.names.erase(c.mesh.names.begin() + 1);
  expect_found(c, "tag.unnamed");
}

TEST(Check, FindsNamesThatDisagree) {
  CheckCase c = board();
  c.mesh.names.push_back({3, 2, "another"});
  expect_found(c, "tag.two_names");
  CheckCase d = board();
  d.mesh.names[0].name = d.mesh.names[1].name;
  const Report report = expect_found(d, "tag.name_repeated");
  EXPECT_TRUE(has(report, "tag.name_differs"));
}

TEST(Check, FindsGroupsThatAreMissingEmptyOrTooMany) {
  CheckCase c = board();
  c.mesh.names.push_back({3, 77, "nothing here"});
  const Report report = check(c.mesh, &c.expectation);
  EXPECT_TRUE(report.passed());
  EXPECT_EQ(finding(report, "tag.empty_group").severity, FindingSeverity::warning);
  CheckCase d = board();
  d.expectation.volumes.push_back({9, "lost", "lost", "fr4", "", false});
  expect_found(d, "tag.missing");
  CheckCase e = board();
  e.expectation.volumes.pop_back();
  expect_found(e, "tag.unexpected");
}

TEST(Check, FindsAWrongVolumeInTheExpectation) {
  CheckCase c = board();
  c.expectation.volumes[1].volume_m3 *= 1 + 3e-9;
  expect_found(c, "volume.wrong");
}

TEST(Check, FindsAWrongUnit) {
  CheckCase c = board();
  for (auto& place : c.mesh.nodes) {
    for (double& x : place) x *= 1000;
  }
  expect_found(c, "volume.wrong");
  c.expectation.unit_m = 1e-3;
  EXPECT_TRUE(check(c.mesh, &c.expectation).passed());
}

TEST(Check, FindsAFaceUnderTheWrongTag) {
  CheckCase c = board();
  c.mesh.names.push_back({2, 2, "other"});
  c.expectation.faces.push_back({2, "other", true, 0, 0});
  c.mesh.faces[0].tags[3] = 2;
  const Report report = expect_found(c, "face.count");
  EXPECT_TRUE(has(report, "face.area"));
}

TEST(Check, FindsAMissingFace) {
  CheckCase c = board();
  c.mesh.faces[1].corners.resize(c.mesh.faces[1].corners.size() - 4);
  c.mesh.faces[1].tags.pop_back();
  EXPECT_EQ(finding(expect_found(c, "face.untagged"), "face.untagged").count, 1);
}

TEST(Check, FindsAFaceTaggedTwice) {
  CheckCase c = board();
  const auto& corners = c.mesh.faces[0].corners;
  add_triangle(c, {corners[1], corners[2], corners[0]}, 1);
  EXPECT_EQ(finding(expect_found(c, "face.tagged_twice"), "face.tagged_twice").count, 1);
}

TEST(Check, FindsAnInsideFaceUnderAnOuterTag) {
  CheckCase c = board();
  const auto p = corners_of_cell(c, 60);
  add_triangle(c, {p[0], p[1], p[2]}, 1);
  const Report report = expect_found(c, "face.outer_tag_inside");
  EXPECT_TRUE(has(report, "face.tag_mixes"));
}

TEST(Check, AcceptsInsideFacesOfConductors) {
  CheckCase c = board();
  const auto p = corners_of_cell(c, prism(2, 1, 1));
  add_triangle(c, {p[0], p[1], p[2]}, 2);
  c.mesh.names.push_back({2, 2, "surface|A"});
  c.expectation.faces.push_back({2, "surface|A", false, 1, 5e-7});
  const Report report = check(c.mesh, &c.expectation);
  EXPECT_TRUE(report.findings.empty()) << to_text(report);
}

TEST(Check, FindsATaggedFaceOfNoCell) {
  CheckCase c = board();
  add_triangle(c, {node(0, 0, 0), node(2, 1, 0), node(3, 3, 2)}, 1);
  expect_found(c, "face.tagged_no_cell");
}

TEST(Check, WarnsOfATaggedFaceTurnedInwards) {
  CheckCase c = board();
  std::swap(c.mesh.faces[0].corners[0], c.mesh.faces[0].corners[1]);
  std::swap(c.mesh.faces[1].corners[0], c.mesh.faces[1].corners[2]);
  const Report report = check(c.mesh, &c.expectation);
  EXPECT_TRUE(report.passed()) << to_text(report);
  EXPECT_EQ(finding(report, "face.tagged_inward").count, 2);
}

TEST(Check, WarnsOfADomainThatTouchesItselfAlongAnEdge) {
  tests::BlockPlan plan = tests::board_plan();
  plan.labels[25 + 12] = plan.labels[25 + 18] = tests::empty_label;
  const CheckCase c = tests::build_block(plan);
  const Report report = check(c.mesh, &c.expectation);
  EXPECT_TRUE(report.passed()) << to_text(report);
  EXPECT_EQ(finding(report, "boundary.pinched").count, 1);
}

TEST(Check, FindsANetCutInTwo) {
  CheckCase c = board();
  for (int half = 0; half < 2; ++half) c.mesh.cells[0].tags[static_cast<std::size_t>(prism(2, 1, 1, half))] = 4;
  const Report report = expect_found(c, "net.open");
  EXPECT_NE(finding(report, "net.open").text.find("net A is open: 2 pieces of copper in the mesh, 1 in the layout"),
            std::string::npos);
  ASSERT_EQ(finding(report, "net.open").places.size(), 1u) << "the gap between the two pieces";
  EXPECT_EQ(finding(report, "net.open").nets, std::vector<std::string>{"A"});
  EXPECT_EQ(finding(report, "net.open").layer, "F.Cu");
}

TEST(Check, FindsABridgeBetweenNets) {
  CheckCase c = board();
  for (int half = 0; half < 2; ++half) c.mesh.cells[0].tags[static_cast<std::size_t>(prism(2, 2, 1, half))] = 2;
  const Report report = expect_found(c, "net.short");
  const Finding& found = finding(report, "net.short");
  EXPECT_EQ(found.count, 1);
  EXPECT_NE(found.text.find("copper of nets A and B shares 1 faces, first on layer F.Cu at (0.0025, 0.003, "),
            std::string::npos)
      << found.text;
  EXPECT_FALSE(has(report, "net.open"));
}

TEST(Check, AcceptsNetsThatTouchInTheLayout) {
  CheckCase c = board();
  for (int half = 0; half < 2; ++half) c.mesh.cells[0].tags[static_cast<std::size_t>(prism(2, 2, 1, half))] = 2;
  c.expectation.touching_nets = {{"B", "A"}};
  EXPECT_FALSE(has(check(c.mesh, &c.expectation), "net.short"));
}

TEST(Check, FindsPiecesGrownTogether) {
  CheckCase c = board();
  c.expectation.nets[1].pieces = 2;
  expect_found(c, "net.merged");
  c.expectation.nets[1].pieces = -1;
  EXPECT_TRUE(check(c.mesh, &c.expectation).passed());
}

TEST(Check, SkipsNetsWithoutCopperCells) {
  CheckCase c = board();
  c.expectation.nets.push_back({"hollow", 3});
  EXPECT_TRUE(check(c.mesh, &c.expectation).passed());
}

TEST(Check, SurvivesGarbage) {
  std::mt19937_64 random(11);
  for (int round = 0; round < 300; ++round) {
    CheckCase c = board();
    for (int i = 0; i < 1 + round; ++i) {
      switch (random() % 6) {
        case 0:
          corner(c, static_cast<std::int64_t>(random() % 150), static_cast<int>(random() % 6)) =
              static_cast<std::int64_t>(random() % 144);
          break;
        case 1:
          at(c, static_cast<std::int64_t>(random() % 144))[random() % 3] = static_cast<double>(random() % 1000) * 1e-5;
          break;
        case 2:
          c.mesh.cells[0].tags[random() % 150] = static_cast<std::int32_t>(random() % 7) - 1;
          break;
        case 3:
          c.mesh.faces[random() % 2].corners[random() % 60] = static_cast<std::int64_t>(random() % 144);
          break;
        case 4:
          c.mesh.faces[random() % 2].tags[random() % 20] = static_cast<std::int32_t>(random() % 7) - 1;
          break;
        default:
          at(c, static_cast<std::int64_t>(random() % 144)) = at(c, static_cast<std::int64_t>(random() % 144));
      }
    }
    if (round % 17 == 0) corner(c, 3, 3) = 1000;
    const Report report = check(c.mesh, round % 2 == 0 ? &c.expectation : nullptr, {.num_threads = 2});
    EXPECT_FALSE(to_text(report).empty());
    EXPECT_FALSE(to_json(report).empty());
  }
}

}  // namespace
}  // namespace pcbmesh::validation
