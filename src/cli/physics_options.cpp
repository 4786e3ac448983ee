// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/cli/physics_options.hpp"

#include <fmt/format.h>

#include <charconv>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/base/near_miss.hpp"

namespace pcbmesh::cli {
namespace {

constexpr const char* port_form =
    "NAME,net=NET,at=PLACE[,reference=NET][,z=OHMS][,kind=lumped|wave][,shape=auto|vertical|gap|coaxial][,width=LENGTH]"
    "[,height=LENGTH][,edge=LENGTH][,layer=LAYER][,passive]";

double number_in(std::string_view text, std::string_view what) {
  double value = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (fault != std::errc() || end != text.data() + text.size())
    throw Error(ErrorCode::usage, fmt::format("{}: '{}' is no number", what, text.substr(0, 60)));
  return value;
}

std::vector<std::string> split_at(const std::string& text, char mark) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == mark)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

/// "xmin", "10mm:5mm", "10mm:5mm:F.Cu" or a pin, "J1.2".
study::PortPlace port_place(const std::string& text) {
  study::PortPlace place;
  for (const auto side : {study::HullSide::xmin, study::HullSide::xmax, study::HullSide::ymin, study::HullSide::ymax})
    if (text == study::name_of(side)) place.side = side;
  if (place.side) return place;
  const std::vector<std::string> parts = split_at(text, ':');
  if (parts.size() == 1) {
    place.pin = text;
  } else if (parts.size() <= 3) {
    place.point = geometry::Point{parse_length(parts[0]), parse_length(parts[1])};
    if (parts.size() == 3) place.layer = parts[2];
  } else {
    throw Error(ErrorCode::usage, fmt::format("--port: place '{}' is none; give a pin (J1.2), X:Y, X:Y:LAYER or a side (xmin)",
                                              text.substr(0, 60)));
  }
  return place;
}

study::Port parse_port(const std::string& text) {
  const std::vector<std::string> parts = split_at_commas(text);
  if (parts.empty() || parts.front().find('=') != std::string::npos)
    throw Error(ErrorCode::usage, fmt::format("--port '{}' begins with no name; expected {}", text, port_form));
  study::Port port;
  port.name = parts.front();
  const std::vector<std::string> keys{"net",   "at",     "reference", "z",     "kind",   "shape",
                                      "width", "height", "edge",      "layer", "passive"};
  for (std::size_t i = 1; i < parts.size(); ++i) {
    const std::size_t equals = parts[i].find('=');
    const std::string key = parts[i].substr(0, equals);
    const std::string value = equals == std::string::npos ? "" : parts[i].substr(equals + 1);
    if (key == "net") {
      port.net = value;
    } else if (key == "at") {
      port.at = port_place(value);
    } else if (key == "reference") {
      port.reference = value;
    } else if (key == "z") {
      port.impedance_ohm = number_in(value, "--port z");
    } else if (key == "kind") {
      port.kind = study::parse_port_kind(value);
    } else if (key == "shape") {
      port.shape = study::parse_port_shape(value);
    } else if (key == "width") {
      port.width = parse_length(value);
    } else if (key == "height") {
      port.height = parse_length(value);
    } else if (key == "layer") {
      port.at.layer = value;
    } else if (key == "edge") {
      port.max_edge = parse_length(value);
    } else if (key == "passive" && value.empty()) {
      port.excited = false;
    } else {
      throw Error(ErrorCode::usage, fmt::format("--port '{}': unknown part '{}'{}; expected {}", port.name,
                                                parts[i].substr(0, 60), did_you_mean(key, keys), port_form));
    }
  }
  return port;
}

/// "SIDE=KIND", "impedance" with its ohms and "pml" with its thickness after a colon; SIDE may be "all".
void take_boundary(const std::string& text, study::Study& study) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos)
    throw Error(ErrorCode::usage,
                fmt::format("--boundary '{}': expected SIDE=KIND, e.g. zmin=pec or all=absorbing or xmin=impedance:377", text));
  const std::vector<std::string> parts = split_at(text.substr(equals + 1), ':');
  study::Boundary boundary{.kind = study::parse_boundary_kind(parts[0])};
  if (parts.size() == 2 && boundary.kind == study::BoundaryKind::impedance)
    boundary.ohms = number_in(parts[1], "--boundary");
  else if (parts.size() == 2 && boundary.kind == study::BoundaryKind::pml)
    boundary.thickness = parse_length(parts[1]);
  else if (parts.size() != 1 || boundary.kind == study::BoundaryKind::pml)
    throw Error(ErrorCode::usage,
                fmt::format("--boundary '{}': an impedance has its ohms (impedance:377), a pml its thickness (pml:3mm), the "
                            "others have nothing",
                            text));
  if (const std::string side = text.substr(0, equals); side == "all")
    study.boundaries.fill(boundary);
  else
    study.boundaries[static_cast<std::size_t>(study::parse_hull_side(side))] = boundary;
}

/// "FROM:TO:POINTS" or a list "F1,F2,...".
study::Sweep parse_sweep(const std::string& text) {
  study::Sweep sweep;
  if (const std::vector<std::string> parts = split_at(text, ':'); parts.size() == 3) {
    sweep.from_hz = parse_frequency_hz(parts[0]);
    sweep.to_hz = parse_frequency_hz(parts[1]);
    sweep.points = static_cast<std::int64_t>(number_in(parts[2], "--sweep"));
  } else if (parts.size() == 1) {
    for (const std::string& part : split_at_commas(text)) sweep.list_hz.push_back(parse_frequency_hz(part));
  } else {
    throw Error(ErrorCode::usage, fmt::format("--sweep '{}': expected FROM:TO:POINTS, e.g. 1GHz:10GHz:91, or a list, e.g. "
                                              "1GHz,2.5GHz",
                                              text));
  }
  return sweep;
}

}  // namespace

std::vector<std::string> split_at_commas(const std::string& text) {
  std::vector<std::string> parts(1);
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\\' && i + 1 < text.size())
      parts.back() += text[++i];
    else if (text[i] == ',')
      parts.emplace_back();
    else
      parts.back() += text[i];
  }
  std::erase(parts, "");
  return parts;
}

void add_physics_options(CLI::App& command, StudyOptions& o) {
  constexpr const char* group = "Ports and boundaries";
  command
      .add_option("--for", o.solver, "Solver: palace, getdp, elmer, dolfinx or mfem; sets version, unit and rules of the mesh")
      ->group(group);
  command.add_option("--problem", o.problem, "driven (default), eigenmode or electrostatic")->group(group);
  command
      .add_option("--port", o.ports,
                  "Port NAME,net=NET,at=PLACE, where PLACE is a pin (J1.2), X:Y, X:Y:LAYER or a side of the region (xmin); "
                  "further reference=NET, z=OHMS, kind=wave, shape=..., width=..., height=..., passive; repeatable")
      ->allow_extra_args(false)
      ->group(group);
  command
      .add_option(
          "--boundary", o.boundaries,
          "SIDE=KIND: side xmin..zmax, side or all; kind absorbing (default), pec, pmc, impedance:OHMS or none; repeatable")
      ->allow_extra_args(false)
      ->group(group);
  command.add_option("--sweep", o.sweep, "Frequencies FROM:TO:POINTS, e.g. 1GHz:10GHz:91, or a list, e.g. 1GHz,2.5GHz")
      ->group(group);
}

void take_physics_options(const StudyOptions& o, study::Study& s) {
  if (!o.problem.empty()) s.problem = study::parse_problem(o.problem);
  if (!o.solver.empty()) s.solver = study::parse_solver(o.solver);
  for (const std::string& text : o.ports) s.ports.push_back(parse_port(text));
  for (const std::string& text : o.boundaries) take_boundary(text, s);
  if (!o.sweep.empty()) s.sweep = parse_sweep(o.sweep);
}

}  // namespace pcbmesh::cli
