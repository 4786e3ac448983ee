// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/deck/field_problem.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "formats/deck/adjacent_media.hpp"
#include "formats/tags_json/tags_json.hpp"
#include "pcbmesh/base/error.hpp"
#include "pcbmesh/mesh/group_names.hpp"

namespace pcbmesh::formats::deck {
namespace {

using mesh::BoundaryCondition;
using mesh::FaceTagKind;

template <class Tags>
std::vector<std::string> names_of(const Tags& tags) {
  std::vector<std::string> names;
  for (const auto& tag : tags) names.push_back(tag.name);
  return mesh::group_names(names);
}

std::vector<Volume> volumes_of(const mesh::PrismMesh& mesh) {
  std::vector<Volume> volumes;
  const std::vector<std::string> names = names_of(mesh.volume_tags());
  for (std::size_t i = 0; i < names.size(); ++i) {
    const mesh::VolumeTag& tag = mesh.volume_tags()[i];
    if (tag.num_prisms == 0) continue;
    const board::Material& material = mesh.materials()[static_cast<std::size_t>(tag.material)];
    volumes.push_back({tag.id, names[i], tag.net, material,
                       tag.net >= 0 || material.sigma_s_per_m >= tags_json::conductor_sigma_s_per_m, tag.stretched});
  }
  return volumes;
}

/// Copper without a word about it conducts ideally; the hull without one is left to the solver's natural condition.
BoundaryCondition resolve(const mesh::FaceTag& tag) {
  if (tag.condition != BoundaryCondition::none) return tag.condition;
  switch (tag.kind) {
    case FaceTagKind::conductor:
    case FaceTagKind::sheet:
      return tag.material >= 0 ? BoundaryCondition::conductor : BoundaryCondition::pec;
    case FaceTagKind::port:
    case FaceTagKind::wave_port:
      return BoundaryCondition::port;
    default:
      return BoundaryCondition::pmc;
  }
}

std::vector<Face> faces_of(const mesh::PrismMesh& mesh, std::int32_t first_face_id) {
  std::vector<Face> faces;
  const std::vector<std::string> names = names_of(mesh.face_tags());
  const std::vector<std::vector<Medium>> media = adjacent_media(mesh);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const mesh::FaceTag& tag = mesh.face_tags()[i];
    if (tag.num_triangles + tag.num_quads == 0 || tag.kind == FaceTagKind::interface) continue;
    Face face;
    face.id = tag.id + first_face_id;
    face.name = names[i];
    face.kind = tag.kind;
    face.condition = resolve(tag);
    face.is_inner = tag.is_inner;
    face.net = tag.net;
    face.impedance_ohm = tag.impedance_ohm;
    face.thickness_m = tag.thickness_m;
    face.media = media[i];
    if (tag.partner >= 0) face.partner = mesh.face_tags()[static_cast<std::size_t>(tag.partner)].id + first_face_id;
    if (tag.material >= 0) face.metal = mesh.materials()[static_cast<std::size_t>(tag.material)];
    faces.push_back(std::move(face));
  }
  return faces;
}

/// Ports that have faces, and the faces' port numbers among them.
void add_ports(const mesh::PrismMesh& mesh, std::int32_t first_face_id, FieldProblem& problem) {
  std::vector<std::int32_t> number(mesh.ports().size(), -1);
  for (const mesh::FaceTag& tag : mesh.face_tags()) {
    if (tag.port < 0 || tag.num_triangles + tag.num_quads == 0) continue;
    std::int32_t& n = number[static_cast<std::size_t>(tag.port)];
    if (n < 0) n = 0;
  }
  for (std::size_t p = 0; p < number.size(); ++p) {
    if (number[p] < 0) continue;
    number[p] = static_cast<std::int32_t>(problem.ports.size());
    problem.ports.push_back({mesh.ports()[p], {}});
  }
  for (const mesh::FaceTag& tag : mesh.face_tags()) {
    if (tag.port < 0 || tag.num_triangles + tag.num_quads == 0) continue;
    const std::int32_t n = number[static_cast<std::size_t>(tag.port)];
    problem.ports[static_cast<std::size_t>(n)].faces.push_back(tag.id + first_face_id);
    for (Face& face : problem.faces)
      if (face.id == tag.id + first_face_id) face.port = n;
  }
}

void add_conductors(const mesh::PrismMesh& mesh, FieldProblem& problem) {
  std::map<std::int32_t, Conductor> by_net;
  for (const Volume& volume : problem.volumes) {
    if (!volume.is_conductor) continue;
    if (volume.net < 0)
      problem.floating.push_back(volume.id);
    else
      by_net[volume.net].volumes.push_back(volume.id);
  }
  for (const Face& face : problem.faces)
    if (face.net >= 0 && (face.kind == FaceTagKind::conductor || face.kind == FaceTagKind::sheet))
      by_net[face.net].faces.push_back(face.id);
  for (auto& [net, conductor] : by_net) {
    conductor.name = mesh.nets()[static_cast<std::size_t>(net)];
    problem.conductors.push_back(std::move(conductor));
  }
}

void note_assumptions(const FieldProblem& problem, Diagnostics& diagnostics) {
  if (problem.options.problem == Problem::electrostatic) return;
  std::string solid, ideal, open;
  const auto add = [](std::string& list, const std::string& name) { list += (list.empty() ? "" : ", ") + name; };
  for (const Volume& volume : problem.volumes)
    if (volume.is_conductor) add(solid, volume.name);
  for (const Face& face : problem.faces) {
    if (face.kind != FaceTagKind::outer && face.condition == BoundaryCondition::pec) add(ideal, face.name);
    if (face.kind == FaceTagKind::outer && face.condition == BoundaryCondition::pmc) add(open, face.name);
  }
  if (!solid.empty())
    diagnostics.note("deck.solid_copper",
                     "solid copper is an ideal conductor in the deck, for no mesh resolves its skin; to count its loss, make "
                     "it hollow or a sheet: " +
                         solid);
  if (!ideal.empty()) diagnostics.note("deck.ideal_copper", "ideal conductors in the deck: " + ideal);
  if (!open.empty()) diagnostics.note("deck.magnetic_wall", "no field crosses these sides, they are magnetic walls: " + open);
}

/// A wall that absorbs goes on carrying the wave beside a lumped port on it: a matched load in parallel to the port.
void warn_of_loaded_ports(const mesh::PrismMesh& mesh, const FieldProblem& problem, Diagnostics& diagnostics) {
  if (problem.options.problem != Problem::driven || mesh.planar().points_m().empty()) return;
  std::array<double, 2> min = mesh.planar().points_m().front(), max = min;
  for (const auto& point : mesh.planar().points_m())
    for (std::size_t axis = 0; axis < 2; ++axis) {
      min[axis] = std::min(min[axis], point[axis]);
      max[axis] = std::max(max[axis], point[axis]);
    }
  constexpr double on_side_m = 1e-9;
  constexpr std::array<std::array<const char*, 2>, 2> sides{{{"xmin", "xmax"}, {"ymin", "ymax"}}};
  for (const Face& face : problem.faces) {
    if (face.kind != FaceTagKind::outer || face.condition != BoundaryCondition::absorbing) continue;
    for (const FieldPort& port : problem.ports)
      for (std::size_t axis = 0; axis < 2; ++axis)
        for (const bool far : {false, true})
          if (face.name == sides[axis][far ? 1 : 0] && port.port.kind == mesh::PortKind::lumped &&
              std::abs(port.port.at_m[axis] - (far ? max : min)[axis]) < on_side_m)
            diagnostics.warn(
                "deck.loaded_port",
                fmt::format("lumped port '{}' lies on side {}, which absorbs: the side loads the port like a second "
                            "termination; make it none (--boundary {}=none)",
                            port.port.name, face.name, face.name));
  }
}

/// Everything that makes the problem ill posed, one sentence each.
std::vector<std::string> flaws(const FieldProblem& problem) {
  std::vector<std::string> out;
  const DeckOptions& options = problem.options;
  const bool has_dielectric = std::ranges::any_of(problem.volumes, [](const Volume& v) { return !v.is_conductor; });
  if (!has_dielectric) out.emplace_back("the mesh holds no dielectric or air in which a field could be");
  switch (options.problem) {
    case Problem::driven:
      if (problem.ports.empty()) out.emplace_back("a driven problem needs a port: add one to the study (ports, --port)");
      if (!problem.ports.empty() && std::ranges::none_of(problem.ports, [](const FieldPort& p) { return p.port.is_excited; }))
        out.emplace_back("no port is excited");
      if (options.frequencies_hz.empty())
        out.emplace_back("a driven problem needs frequencies: add a sweep to the study (sweep, --sweep)");
      for (const double f : options.frequencies_hz)
        if (!(f > 0 && std::isfinite(f))) out.push_back(fmt::format("{} Hz is no frequency of a sweep", f));
      break;
    case Problem::eigenmode:
      if (options.modes.number < 1) out.emplace_back("at least one mode must be asked for");
      if (!(options.modes.above_hz > 0)) out.emplace_back("the frequency near which modes are sought must be above 0");
      break;
    case Problem::electrostatic: {
      const bool has_ground =
          !problem.faces_with(BoundaryCondition::pec).empty() && std::ranges::any_of(problem.faces, [](const Face& face) {
            return face.kind == FaceTagKind::outer && face.condition == BoundaryCondition::pec;
          });
      if (problem.conductors.size() + (has_ground ? 1 : 0) < 2)
        out.push_back(fmt::format(
            "a capacitance needs two conductors, and the mesh holds {}; mesh more nets, or make a side of the domain pec",
            problem.conductors.size()));
    }
  }
  for (const FieldPort& port : problem.ports)
    if (!(port.port.impedance_ohm > 0) ||
        (port.port.kind != mesh::PortKind::wave && !(port.port.length_m > 0 && port.port.width_m > 0)))
      out.push_back(fmt::format("port '{}' has no size or no impedance", port.port.name));
  for (const Face& face : problem.faces) {
    if (face.condition == BoundaryCondition::port && face.port < 0)
      out.push_back(fmt::format("face group '{}' is a port's, but belongs to none", face.name));
    if (face.condition == BoundaryCondition::impedance && !(face.impedance_ohm > 0))
      out.push_back(fmt::format("face group '{}' has a surface impedance of {} ohm", face.name, face.impedance_ohm));
    if (face.condition == BoundaryCondition::conductor && !(face.metal.sigma_s_per_m > 0))
      out.push_back(fmt::format("face group '{}' is a lossy conductor, but its material '{}' does not conduct", face.name,
                                face.metal.name));
  }
  return out;
}

}  // namespace

std::vector<std::int32_t> FieldProblem::faces_with(BoundaryCondition condition) const {
  std::vector<std::int32_t> ids;
  for (const Face& face : faces)
    if (face.condition == condition) ids.push_back(face.id);
  return ids;
}

std::string FieldProblem::stem() const {
  return std::filesystem::path(options.mesh).stem().string();
}

namespace {

std::array<double, 2> extent_of(const mesh::PlanarMesh& planar) {
  std::array<double, 2> extent{};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const auto [low, high] = std::ranges::minmax_element(planar.points_m(), {}, [&](const auto& p) { return p[axis]; });
    if (low != planar.points_m().end()) extent[axis] = (*high)[axis] - (*low)[axis];
  }
  return extent;
}

}  // namespace

FieldProblem state(const mesh::PrismMesh& mesh, const DeckOptions& options, std::int32_t first_face_id,
                   Diagnostics& diagnostics) {
  FieldProblem problem{.options = options,
                       .volumes = volumes_of(mesh),
                       .faces = faces_of(mesh, first_face_id),
                       .ports = {},
                       .conductors = {},
                       .floating = {}};
  problem.shell = mesh.shell();
  problem.period_m = extent_of(mesh.planar());
  add_ports(mesh, first_face_id, problem);
  add_conductors(mesh, problem);
  if (const std::vector<std::string> found = flaws(problem); !found.empty())
    throw Error(ErrorCode::study_invalid,
                fmt::format("no deck for a {} problem: {}", study::name_of(options.problem), fmt::join(found, "; ")));
  note_assumptions(problem, diagnostics);
  warn_of_loaded_ports(mesh, problem, diagnostics);
  return problem;
}

void refuse(std::string_view solver, std::string_view what, std::string_view nearest) {
  throw Error(ErrorCode::format_limit, fmt::format("{} can't do this: {}. The nearest it can do: {}", solver, what, nearest));
}

std::string plain(std::string_view text) {
  std::string out;
  for (const char c : text) out += c >= 0x20 && c < 0x7F && c != '"' && c != '\\' && c != '%' ? c : '_';
  return out;
}

std::string shell_word(std::string_view text) {
  const bool is_plain = !text.empty() && std::ranges::all_of(text, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("_-./+=:,@").find(c) != std::string_view::npos;
  });
  if (is_plain) return std::string(text);
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace pcbmesh::formats::deck
