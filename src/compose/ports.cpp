// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/compose/ports.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "src/compose/port_placer.hpp"
#include "src/compose/port_words.hpp"

namespace pcbmesh::compose {

namespace {

/// Whether the study itself says something impossible about a port.
bool is_at_fault(const study::Study& study, std::size_t port) {
  const std::string field = fmt::format("/ports/{}/", port);
  return std::ranges::any_of(study::faults_of(study), [&](const study::Fault& f) { return f.field.starts_with(field); });
}

}  // namespace

void add_ports(const board::Board& board, const study::Study& study, const std::vector<ResolvedRule>& rules,
               const Footprint& footprint, const Stack& stack, model::ModelParts& parts, std::vector<study::Fault>& faults) {
  if (study.ports.empty()) return;
  const PortPlacer placer(board, study, rules, footprint, stack);
  std::vector<Placed> placed;
  for (std::size_t i = 0; i < study.ports.size(); ++i) {
    const study::Port& wanted = study.ports[i];
    if (!board.find_net(wanted.net) || (!wanted.reference.empty() && !board.find_net(wanted.reference))) continue;
    if (is_at_fault(study, i)) continue;  // told already
    Outcome outcome = placer.place(wanted);
    if (!outcome.placed) {
      faults.push_back({fmt::format("/ports/{}", i), fmt::format("port '{}': {}", wanted.name, outcome.fault)});
      continue;
    }
    outcome.placed->port.study_index = static_cast<std::int64_t>(i);
    for (const Placed& other : placed)
      if (overlap(*outcome.placed, other))
        faults.push_back(
            {fmt::format("/ports/{}", i),
             fmt::format("port '{}' would share faces with port '{}' near ({:.6g}, {:.6g}) mm; make them narrower or "
                         "move one",
                         wanted.name, other.port.name, other.port.at_m[0] * 1e3, other.port.at_m[1] * 1e3)});
    placed.push_back(std::move(*outcome.placed));
  }
  for (Placed& one : placed) {
    one.port.body = static_cast<std::int32_t>(parts.bodies.size());
    parts.bodies.push_back({.name = "port " + one.port.name,
                            .kind = model::BodyKind::port,
                            .first_slab = one.first_slab,
                            .last_slab = one.last_slab});
    parts.shapes.push_back({.body = one.port.body, .rings = std::move(one.footprint), .simple = true});
    parts.ports.push_back(std::move(one.port));
  }
}

namespace {

bool is_coaxial(const study::Port& port) {
  return port.shape == study::PortShape::coaxial;
}

/// Pads, cuts and vias of a net where a port may be, and what to call the place.
struct Candidate {
  study::PortPlace at;
  std::string about;
  study::PortShape shape = study::PortShape::automatic;
};

std::vector<Candidate> candidates_of(const board::Board& board, const study::Study& study, std::int32_t net,
                                     const Footprint& footprint) {
  const bool with_sides = study.region != study::RegionKind::nets && study.region != study::RegionKind::polygon;
  std::vector<Candidate> candidates;
  std::vector<std::string> met;
  for (const board::Pin& pin : board.pins()) {
    const std::string name = pin.component + "." + pin.number;
    if (pin.net != net || !footprint.contains(pin.at) || std::ranges::count(met, name) > 0) continue;
    met.push_back(name);
    candidates.push_back({{.pin = name}, fmt::format("pin {}", name)});
  }
  if (!with_sides) return candidates;
  for (const auto side : {study::HullSide::xmin, study::HullSide::xmax, study::HullSide::ymin, study::HullSide::ymax})
    if (const auto kind = study.boundaries[static_cast<std::size_t>(side)].kind;
        kind != study::BoundaryKind::pml && kind != study::BoundaryKind::periodic)
      candidates.push_back({{.side = side}, fmt::format("the cut at {}", study::name_of(side))});
  return candidates;
}

/// Every layer that a plated hole of the net passes, as a coaxial port; most have no antipad.
void add_vias(const board::Board& board, std::int32_t net, const Footprint& footprint, std::vector<Candidate>& candidates) {
  std::vector<geometry::Point> met;
  for (const board::Drill& drill : board.drills()) {
    if (!drill.plated || drill.net != net || drill.figure.path.points.size() != 1) continue;
    const geometry::Point centre = drill.figure.path.points.front();
    if (!footprint.contains(centre) || std::ranges::count(met, centre) > 0) continue;
    met.push_back(centre);
    for (std::int32_t layer = drill.first_copper; layer <= drill.last_copper; ++layer)
      candidates.push_back({{.point = centre, .layer = board.copper_name(layer)},
                            fmt::format("the via at {}, in its antipad on {}", place_text(centre), board.copper_name(layer)),
                            study::PortShape::coaxial});
  }
}

bool is_plane(const board::Board& board, std::int32_t net) {
  return std::ranges::any_of(
      board.shapes(), [&](const board::Shape& shape) { return shape.net == net && shape.kind == board::ShapeKind::fill; });
}

}  // namespace

std::vector<PortProposal> find_ports(const board::Board& board, const study::Study& study,
                                     const std::vector<ResolvedRule>& rules, const Footprint& footprint, const Stack& stack,
                                     std::span<const std::int32_t> nets, PortPlaces places) {
  const PortPlacer placer(board, study, rules, footprint, stack);
  std::vector<PortProposal> proposals;
  std::vector<Placed> placed;
  for (const std::int32_t net : nets) {
    const std::string name(board.net_name(net));
    if (is_plane(board, net)) {
      proposals.push_back({.port = {.name = "", .net = name, .at = {}},
                           .about = "",
                           .why_not = "a net with filled areas is a reference, not a line"});
      continue;
    }
    std::vector<Candidate> candidates = candidates_of(board, study, net, footprint);
    if (places == PortPlaces::ends_and_vias) add_vias(board, net, footprint, candidates);
    for (Candidate& candidate : candidates) {
      PortProposal proposal{.port = {.name = "P", .net = name, .at = std::move(candidate.at), .shape = candidate.shape},
                            .about = candidate.about};
      Outcome outcome = placer.place(proposal.port);
      // A net that ends inside has no cut, and a layer without a plane no antipad: that needs no word.
      if (!outcome.placed && proposal.port.at.side && outcome.fault.find("is not cut") != std::string::npos) continue;
      if (!outcome.placed && is_coaxial(proposal.port) && outcome.fault.find("no copper surrounds") != std::string::npos)
        continue;
      proposal.why_not = outcome.fault;
      if (outcome.placed) {
        const model::Port& found = outcome.placed->port;
        proposal.port.reference = board.net_name(found.negative_net);
        proposal.how = found.is_coaxial ? "coaxial" : found.faces == model::PortFaces::wall ? "vertical" : "gap";
        proposal.at_mm = {found.at_m[0] * 1e3, found.at_m[1] * 1e3};
        for (const Placed& other : placed)
          if (overlap(*outcome.placed, other)) proposal.why_not = "another port is there already";
        if (proposal.why_not.empty()) placed.push_back(std::move(*outcome.placed));
      }
      proposals.push_back(std::move(proposal));
    }
  }
  // Ports of one end side by side: along the longer extent of the region first, then in the order of the nets.
  const bool along_x = footprint.box.max.x - footprint.box.min.x >= footprint.box.max.y - footprint.box.min.y;
  const double low = static_cast<double>(along_x ? footprint.box.min.x : footprint.box.min.y) * 1e-6,
               high = static_cast<double>(along_x ? footprint.box.max.x : footprint.box.max.y) * 1e-6;
  const auto quarter = [&](const PortProposal& p) {
    return std::floor(4 * ((along_x ? p.at_mm[0] : p.at_mm[1]) - low) / (high - low));
  };
  std::stable_sort(proposals.begin(), proposals.end(), [&](const PortProposal& a, const PortProposal& b) {
    if (a.why_not.empty() != b.why_not.empty()) return a.why_not.empty();
    if (is_coaxial(a.port) != is_coaxial(b.port)) return is_coaxial(b.port);
    return a.why_not.empty() && quarter(a) < quarter(b);
  });
  name_ports(proposals);
  return proposals;
}

void name_ports(std::vector<PortProposal>& proposals) {
  int ends = 0, rings = 0;
  for (PortProposal& proposal : proposals)
    if (proposal.why_not.empty())
      proposal.port.name = is_coaxial(proposal.port) ? fmt::format("C{}", ++rings) : fmt::format("P{}", ++ends);
}

}  // namespace pcbmesh::compose
