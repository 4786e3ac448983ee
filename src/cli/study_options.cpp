// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/cli/study_options.hpp"

#include <fmt/format.h>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/study/solver_needs.hpp"
#include "src/cli/physics_options.hpp"

namespace pcbmesh::cli {
namespace {

/// "NET", "NET@LAYER" or "@LAYER".
study::ConductorRule conductor_rule(const std::string& text, study::ConductorMode mode) {
  const std::size_t at = text.rfind('@');
  if (at == std::string::npos) return {text, "", mode};
  return {text.substr(0, at), text.substr(at + 1), mode};
}

geometry::Box parse_box(const std::string& text) {
  const std::vector<std::string> parts = split_at_commas(text);
  if (parts.size() != 4)
    throw Error(ErrorCode::usage,
                fmt::format("--region '{}': expected four lengths xmin,ymin,xmax,ymax, e.g. 10mm,5mm,30mm,20mm", text));
  geometry::Box box;
  box.add(geometry::Point{parse_length(parts[0]), parse_length(parts[1])});
  box.add(geometry::Point{parse_length(parts[2]), parse_length(parts[3])});
  if (box.min.x >= box.max.x || box.min.y >= box.max.y)
    throw Error(ErrorCode::usage, fmt::format("--region '{}' has no area", text));
  return box;
}

geometry::Ring parse_polygon(const std::string& text) {
  const std::vector<std::string> parts = split_at_commas(text);
  if (parts.size() < 6 || parts.size() % 2 != 0)
    throw Error(ErrorCode::usage, fmt::format("--polygon '{}': expected at least three corners x1,y1,x2,y2,x3,y3 ..., e.g. "
                                              "10mm,5mm,30mm,5mm,20mm,20mm; {} lengths were given",
                                              text, parts.size()));
  geometry::Ring ring;
  for (std::size_t i = 0; i < parts.size(); i += 2) ring.push_back({parse_length(parts[i]), parse_length(parts[i + 1])});
  return ring;
}

}  // namespace

std::shared_ptr<StudyOptions> add_study_options(CLI::App& command) {
  auto o = std::make_shared<StudyOptions>();
  constexpr const char* region = "Region of interest";
  command.add_option("--study", o->file, "Study JSON; flags override its fields")->check(CLI::ExistingFile)->group(region);
  command
      .add_option("--nets", o->nets,
                  "Mesh around these nets, e.g. /USB_P,/USB_N; with --region or --polygon: the nets of interest in it")
      ->group(region);
  command.add_option("--margin", o->margin, "Growth of the nets' bounding box (default 2mm)")->group(region);
  CLI::Option* box =
      command.add_option("--region", o->region, "Mesh a box: xmin,ymin,xmax,ymax; y is up, as inspect prints it")
          ->group(region);
  command
      .add_option("--polygon", o->polygon,
                  "Mesh inside a polygon: its corners x1,y1,x2,y2,x3,y3 ... along the outline; y is up")
      ->excludes(box)
      ->group(region);
  constexpr const char* domain = "Conductors and air";
  command
      .add_option("--conductors", o->conductors,
                  "solid (copper is meshed), hollow (its skin is tagged surface|net) or sheet (no thickness, tagged sheet|net)")
      ->group(domain);
  command.add_option("--hollow", o->hollow, "Make NET, NET@LAYER or @LAYER hollow; repeatable")
      ->allow_extra_args(false)
      ->group(domain);
  command.add_option("--solid", o->solid, "Make NET, NET@LAYER or @LAYER solid; repeatable")
      ->allow_extra_args(false)
      ->group(domain);
  command.add_option("--sheet", o->sheet, "Make NET, NET@LAYER or @LAYER a sheet; repeatable")
      ->allow_extra_args(false)
      ->group(domain);
  command.add_option("--air", o->air, "Air above and below (default 1mm; 0 = none)")->group(domain);
  command.add_option("--air-above", o->air_above, "Air above the board")->group(domain);
  command.add_option("--air-below", o->air_below, "Air below the board")->group(domain);
  command.add_option("--air-around", o->air_around, "Air beside the whole board (default 0)")->group(domain);
  o->fabrication = add_fabrication_options(command);
  add_physics_options(command, *o);
  constexpr const char* sizes = "Sizes and heights";
  command
      .add_option("--frequency", o->frequency, "Highest frequency, e.g. 10GHz: edges at most a third of the local wavelength")
      ->group(sizes);
  command.add_option("--longest-edge", o->longest_edge, "Longest triangle edge (default 2mm)")->group(sizes);
  command.add_option("--min-angle", o->min_angle, "Angle bound in degrees (default 20.7)")->group(sizes);
  command.add_option("--edge-at-copper", o->edge_at_copper, "Graded size: edge length at copper outlines")->group(sizes);
  command.add_option("--growth", o->growth, "Graded size: edge length gained per distance (default 0.3)")->group(sizes);
  command.add_option("--seed", o->seed, "Triangles start from: delaunay (the outlines alone) or hex (a hexagonal lattice)")
      ->group(sizes);
  command.add_flag("--smooth", o->smooth, "Smooth the triangles; angle bound, size bound and outlines hold")->group(sizes);
  command
      .add_option("--policy", o->policy,
                  "Common prism height: none, basic, average, maximum, minimum, thinnest_layer (the paper's cases 1 to 5), "
                  "weighted (6), matched (7: longest edge and counts for a target or a budget)")
      ->group(sizes);
  command.add_option("--target-quality", o->target_quality, "Policy matched: mean and by volume at least this, fewest prisms")
      ->group(sizes);
  command.add_option("--budget-prisms", o->budget_prisms, "Policy matched: at most so many prisms")->group(sizes);
  command.add_option("--budget-unknowns", o->budget_unknowns, "Policy matched: at most so many edges (lowest edge elements)")
      ->group(sizes);
  command.add_option("--sublayers", o->sublayers, "Cutting of layers: floor, round, ceil, none, optimal, best_mean")
      ->group(sizes);
  command.add_option("--elements-per-wavelength", o->elements_per_wavelength, "Edges and heights, local material (default 3)")
      ->group(sizes);
  command.add_option("--elements-per-dielectric", o->elements_per_dielectric, "At least so many sub-layers in a dielectric")
      ->group(sizes);
  command
      .add_option("--skin-depth-layers", o->skin_depth_layers,
                  "So many sub-layers in the first skin depth of meshed copper, growing from its faces, outside too")
      ->group(sizes);
  command
      .add_option("--height-growth", o->height_growth,
                  "Largest ratio of neighbouring sub-layers, at least 1.1 (default: no limit; 2 with --skin-depth-layers)")
      ->group(sizes);
  command.add_flag("--paper-compat", o->paper_compat, "The rules the tables of Ye and Daniels imply, slips included")
      ->group(sizes);
  command.add_option("--tolerance", o->tolerance, "Snapping tolerance: auto or a length (default auto)")->group(sizes);
  command.add_option("--arc-sagitta", o->arc_sagitta, "Largest distance of chord and arc (default 5um)")->group(sizes);
  command.add_option("--unit", o->unit, "Unit written to the mesh: m (default), mm, um")->group(sizes);
  command
      .add_option("--split", o->split,
                  "Write tets: three tetrahedra per prism, same nodes and tags (default: none; tets for full wave in dolfinx)")
      ->group(sizes);
  command.add_option("--order", o->order, "Order of the elements, 1 (default) or 2: arcs of the layout become curved")
      ->group(sizes);
  CLI::Option* wedge15 =
      command.add_flag("--wedge15", o->wedge15, "Order 2: prisms of 15 nodes (CalculiX, Elmer, Nastran)")->group(sizes);
  command.add_flag("--wedge18", o->wedge18, "Order 2: prisms of 18 nodes (default)")->excludes(wedge15)->group(sizes);
  command.add_option("--max-prisms", o->max_prisms, "Refuse a mesh larger than this (default 2e8)")->group(sizes);
  return o;
}

study::Study unchecked_study_from(const StudyOptions& o) {
  study::Study s = o.file.empty() ? study::Study{} : study::read_unchecked_study(o.file);
  if (!o.nets.empty()) {
    s.region = study::RegionKind::nets;
    s.nets = split_at_commas(o.nets);
  }
  if (!o.margin.empty()) s.margin = parse_length(o.margin);
  if (!o.region.empty()) {
    s.region = study::RegionKind::box;
    s.box = parse_box(o.region);
  }
  if (!o.polygon.empty()) {
    s.region = study::RegionKind::polygon;
    s.polygon = parse_polygon(o.polygon);
  }
  if (!o.conductors.empty()) s.conductors = study::parse_conductor_mode(o.conductors);
  for (const std::string& text : o.hollow) s.conductor_rules.push_back(conductor_rule(text, study::ConductorMode::hollow));
  for (const std::string& text : o.solid) s.conductor_rules.push_back(conductor_rule(text, study::ConductorMode::solid));
  for (const std::string& text : o.sheet) s.conductor_rules.push_back(conductor_rule(text, study::ConductorMode::sheet));
  if (!o.air.empty()) s.air_above = s.air_below = parse_length(o.air);
  if (!o.air_above.empty()) s.air_above = parse_length(o.air_above);
  if (!o.air_below.empty()) s.air_below = parse_length(o.air_below);
  if (!o.air_around.empty()) s.air_around = parse_length(o.air_around);
  if (!o.frequency.empty()) s.frequency_hz = parse_frequency_hz(o.frequency);
  if (!o.longest_edge.empty()) s.longest_edge = parse_length(o.longest_edge);
  if (o.min_angle != 0) s.min_angle_deg = o.min_angle;
  if (!o.edge_at_copper.empty()) s.edge_at_copper = parse_length(o.edge_at_copper);
  if (o.growth != 0) s.growth = o.growth;
  if (!o.seed.empty()) s.seed = study::parse_triangle_seed(o.seed);
  if (o.smooth) s.smooth = true;
  if (!o.policy.empty()) s.policy = study::parse_height_policy(o.policy);
  if (!o.sublayers.empty()) s.sublayers = study::parse_sublayer_rule(o.sublayers);
  const auto count = [](const char* flag, double value) {
    if (!(value >= 1 && value < 1e15)) throw Error(ErrorCode::usage, fmt::format("{} {} is no count", flag, value));
    return static_cast<std::int64_t>(value);
  };
  study::HeightBounds& bounds = s.height_bounds;
  if (o.elements_per_wavelength) bounds.elements_per_wavelength = *o.elements_per_wavelength;
  if (o.elements_per_dielectric) bounds.elements_per_dielectric = o.elements_per_dielectric;
  if (o.skin_depth_layers) bounds.skin_depth_layers = o.skin_depth_layers;
  if (o.height_growth) bounds.height_growth = o.height_growth;
  if (o.target_quality) s.match.target_quality = o.target_quality;
  if (o.budget_prisms) s.match.budget_prisms = count("--budget-prisms", *o.budget_prisms);
  if (o.budget_unknowns) s.match.budget_unknowns = count("--budget-unknowns", *o.budget_unknowns);
  if (o.paper_compat) s.paper_compat = true;
  if (o.tolerance == "auto")
    s.tolerance.reset();
  else if (!o.tolerance.empty())
    s.tolerance = parse_length(o.tolerance);
  if (!o.arc_sagitta.empty()) s.arcs.sagitta_nm = parse_length(o.arc_sagitta);
  if (!o.unit.empty()) s.unit = parse_length_unit(o.unit);
  if (!o.split.empty()) s.split = study::parse_element_split(o.split);
  if (o.order != 0) s.order = o.order;
  if (o.wedge15 || o.wedge18) s.wedge_nodes = o.wedge15 ? 15 : 18;
  if (o.max_prisms != 0) s.max_prisms = count("--max-prisms", o.max_prisms);
  take_fabrication_options(*o.fabrication, s.fabrication);
  take_physics_options(o, s);
  const bool is_posed_here = !o.solver.empty() || !o.problem.empty();
  if (is_posed_here && o.split.empty() && study::needs_tetrahedra(s)) s.split = study::ElementSplit::tetrahedra;
  return s;
}

study::Study study_from(const StudyOptions& o) {
  study::Study s = unchecked_study_from(o);
  try {
    study::check(s);
  } catch (const Error& error) {
    if (o.file.empty()) throw;
    throw Error(error.code(), study::with_lines(error.text(), o.file), {.file = o.file});
  }
  return s;
}

}  // namespace pcbmesh::cli
