// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pcbmesh/base/units.hpp"
#include "pcbmesh/geometry/path.hpp"
#include "pcbmesh/study/fabrication.hpp"
#include "pcbmesh/study/physics.hpp"

namespace pcbmesh::study {

/// What part of the board is meshed.
enum class RegionKind {
  whole,   ///< the whole board
  nets,    ///< bounding box of the named nets' copper, grown by the margin
  box,     ///< the given box
  polygon  ///< the given polygon
};

/// How copper enters the mesh.
enum class ConductorMode {
  solid,   ///< copper is a meshed volume
  hollow,  ///< copper is left out; its skin is tagged surface|net
  sheet    ///< copper has no thickness: faces at one level, tagged sheet|net; barrels of the net are hollow
};

/// What holds on the faces of hollow and sheet conductors.
enum class ConductorSurface {
  lossy,  ///< surface impedance of the copper's conductivity
  pec     ///< perfect conductor
};

/// Overrides the conductor mode of one net, one layer, or one net on one layer. Later rules win.
struct ConductorRule {
  std::string net;    ///< empty = every net
  std::string layer;  ///< empty = every layer (barrels of drills included)
  ConductorMode mode = ConductorMode::solid;
  bool operator==(const ConductorRule&) const = default;
};

/// Common prism height h, the paper's CALCULATE_PRISM_HEIGHT. Policies 2 to 6 feed h back as longest edge when h is smaller.
enum class HeightPolicy {
  none,            ///< our own: no common height; every slab stays one sub-layer unless `sublayers` says otherwise
  basic,           ///< case 1: h = thinnest layer, no feedback
  average,         ///< case 2: mean optimal height
  maximum,         ///< case 3: largest optimal height
  minimum,         ///< case 4: smallest optimal height
  thinnest_layer,  ///< case 5: thinnest layer, with feedback
  weighted,        ///< 6, our own: heights averaged by how much quality a triangle loses off its own (F8 of the evidence)
  matched          ///< 7, our own: longest edge and counts together, for a target of quality or a budget
};

/// What the triangulation starts from.
enum class TriangleSeed {
  delaunay,  ///< the outlines alone, as in the paper
  hex        ///< a hexagonal lattice between outlines cut to its edge: nearly equilateral triangles, about half as many
};

/// What the mesh is written as.
enum class ElementSplit {
  none,       ///< prisms
  tetrahedra  ///< three tetrahedra per prism, for solvers without edge elements on prisms
};

/// How a layer of height H is cut by the common height h.
enum class SublayerRule {
  floor,     ///< max(1, floor(H/h)): what the paper's tables imply
  round,     ///< max(1, round(H/h))
  ceil,      ///< ceil(H/h)
  none,      ///< one sub-layer per layer
  optimal,   ///< exact thresholds F10 on the final mesh's mean optimal height
  best_mean  ///< the counts of greatest plain mean quality on the final mesh (Dinkelbach); the plain mean can be gamed
};

/// What a field solver asks of the heights, whatever the policy chose. Unset = no such bound.
struct HeightBounds {
  double elements_per_wavelength = 3;          ///< in the local material, heights and longest edge; needs a frequency
  std::optional<int> elements_per_dielectric;  ///< at least so many sub-layers in every dielectric
  std::optional<int> skin_depth_layers;        ///< so many sub-layers in the first skin depth below a face of meshed copper
  std::optional<double> height_growth;         ///< largest ratio of neighbouring sub-layers; 2 if skin_depth_layers is set
  bool operator==(const HeightBounds&) const = default;
};

/// What policy matched aims at: the fewest prisms of a quality, or the best quality of a budget; with neither, the knee.
struct MatchGoal {
  std::optional<double> target_quality;         ///< mean and volume-weighted q_p at least this
  std::optional<std::int64_t> budget_prisms;    ///< at most so many prisms
  std::optional<std::int64_t> budget_unknowns;  ///< at most so many edges: unknowns of the lowest edge elements
  bool operator==(const MatchGoal&) const = default;
};

/// What the engineer wants to know about a board: everything that steers the mesh. Plain values; parse and
/// resolve check them. Lengths in nanometres.
struct Study {
  static constexpr int schema_version = 1;

  RegionKind region = RegionKind::whole;
  std::vector<std::string> nets;         ///< region nets: at least one
  Nm margin = 2 * nm_per_mm;             ///< region nets: growth of the bounding box
  std::optional<geometry::Box> box;      ///< region box
  std::vector<geometry::Point> polygon;  ///< region polygon: corners of a simple ring; side k runs from corner k to the next

  ConductorMode conductors = ConductorMode::solid;
  std::vector<ConductorRule> conductor_rules;
  ConductorSurface conductor_surface = ConductorSurface::lossy;

  Nm air_above = 1 * nm_per_mm;  ///< 0 = no air: outside the outline is then void
  Nm air_below = 1 * nm_per_mm;
  Nm air_around = 0;  ///< beside the board's bounding box (whole board only)

  std::optional<double> frequency_hz;          ///< bounds edges and heights by the local wavelength
  std::optional<Nm> longest_edge;              ///< empty = from the frequency, else 2 mm as in the paper
  double min_angle_deg = 20.7;                 ///< in (0, 28.6]
  std::optional<Nm> edge_at_copper;            ///< graded size: edge length at copper outlines
  double growth = 0.3;                         ///< graded size: growth of the edge length per distance
  TriangleSeed seed = TriangleSeed::delaunay;  ///< hex excludes edge_at_copper
  bool smooth = false;                         ///< guarded smoothing of the triangles
  HeightPolicy policy = HeightPolicy::average;
  SublayerRule sublayers = SublayerRule::optimal;  ///< not used by policy matched, which chooses the counts itself
  HeightBounds height_bounds;
  MatchGoal match;              ///< policy matched only
  bool paper_compat = false;    ///< the rules the paper's tables imply: docs/decisions/0007
  std::optional<Nm> tolerance;  ///< empty = auto
  geometry::ArcOptions arcs{};
  LengthUnit unit = LengthUnit::metre;
  ElementSplit split = ElementSplit::none;
  int order = 1;         ///< of the elements: 1 or 2; with 2 the middles of chords lie on the arcs of the layout
  int wedge_nodes = 18;  ///< order 2: 18 (with nodes in the middle of quadrangles) or 15
  std::int64_t max_prisms = 200'000'000;  ///< refuse above this forecast

  Problem problem = Problem::driven;
  Solver solver = Solver::none;
  std::vector<Port> ports;
  std::array<Boundary, num_hull_sides> boundaries{};  ///< by HullSide
  /// Region polygon: of sides side_1, side_2 ...; automatic or missing = what `side` has.
  std::vector<Boundary> polygon_boundaries;
  std::optional<Sweep> sweep;
  Modes modes;
  Fabrication fabrication;  ///< the board as it is really made

  bool operator==(const Study&) const;
};

[[nodiscard]] std::string_view name_of(RegionKind value);
[[nodiscard]] std::string_view name_of(ConductorMode value);
[[nodiscard]] std::string_view name_of(ConductorSurface value);
[[nodiscard]] std::string_view name_of(HeightPolicy value);
[[nodiscard]] std::string_view name_of(SublayerRule value);
[[nodiscard]] std::string_view name_of(TriangleSeed value);
[[nodiscard]] std::string_view name_of(ElementSplit value);
/// Inverse of name_of; the numbers "1" to "7" are policies too. @throws Error usage (101) listing the choices.
[[nodiscard]] HeightPolicy parse_height_policy(std::string_view text);
[[nodiscard]] SublayerRule parse_sublayer_rule(std::string_view text);
[[nodiscard]] TriangleSeed parse_triangle_seed(std::string_view text);
[[nodiscard]] ElementSplit parse_element_split(std::string_view text);
[[nodiscard]] ConductorMode parse_conductor_mode(std::string_view text);

/// The conditions of all sides with `automatic` decided.
[[nodiscard]] std::array<Boundary, num_hull_sides> resolved_boundaries(const Study& study);
/// The same for the sides of the polygon, one per corner; empty for other regions.
[[nodiscard]] std::vector<Boundary> resolved_polygon_boundaries(const Study& study);
/// Side of the box opposite to one of the six.
[[nodiscard]] HullSide opposite(HullSide side);

/// Highest frequency of interest: study.frequency_hz, else the end of the sweep, else nothing.
[[nodiscard]] std::optional<double> highest_frequency_hz(const Study& study);

/// Reads a study JSON (docs/schema/study.schema.json). Unknown fields are errors.
/// @throws Error study_invalid (102) with the field's JSON pointer, file_unreadable (201), file_syntax (202) with the line.
[[nodiscard]] Study read_study(const std::filesystem::path& file);
[[nodiscard]] Study parse_study(std::string_view json, std::string_view file_name);

/// Reads a study whose ranges and combinations are looked at later, together with a board: faults_of() is not asked.
[[nodiscard]] Study read_unchecked_study(const std::filesystem::path& file);
/// Faults, one a line as text_of() has them, each with its line in the study file behind it.
[[nodiscard]] std::string with_lines(std::string_view faults, const std::filesystem::path& file);

/// The study as JSON, every default filled in; parse_study(to_json(s)) == s.
[[nodiscard]] std::string to_json(const Study& study);

/// Words that go into a study file and are not read.
struct StudyWords {
  std::string schema;                   ///< where the schema lies, for editors; empty = not said
  std::string note;                     ///< empty = none
  std::vector<std::string> port_notes;  ///< per port; missing or empty = none
};
[[nodiscard]] std::string to_json(const Study& study, const StudyWords& words);
/// The ports alone, as a "ports" member ready to paste.
[[nodiscard]] std::string ports_json(const Study& study, const StudyWords& words);

/// docs/schema/study.schema.json, as this program was built with it.
[[nodiscard]] std::string_view schema_text();

/// One thing wrong with a study, by itself or on a board.
struct Fault {
  std::string field;  ///< JSON pointer, "/ports/1/net"; empty = of no one field
  std::string text;   ///< what, where, what to do
};

/// Everything wrong with ranges and combinations; empty = fine.
[[nodiscard]] std::vector<Fault> faults_of(const Study& study);
/// "/a: text" of one fault; of several, one line each.
[[nodiscard]] std::string text_of(const std::vector<Fault>& faults);
/// @throws Error study_invalid (102) naming every fault at once.
void check(const Study& study);

}  // namespace pcbmesh::study
