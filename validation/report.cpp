// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/validation/report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace pcbmesh::validation {
namespace {

const char* word_of(FindingSeverity severity) {
  return severity == FindingSeverity::error ? "error" : "warning";
}

/// 1234567 as "1,234,567".
std::string grouped(std::int64_t number) {
  const std::string digits = fmt::format("{}", number);
  std::string text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && digits[i - 1] != '-' && (digits.size() - i) % 3 == 0) text.push_back(',');
    text.push_back(digits[i]);
  }
  return text;
}

std::string plural(std::int64_t count, const char* word) {
  return fmt::format("{} {}{}", grouped(count), word, count == 1 ? "" : "s");
}

std::int64_t kinds_of(const Report& report, FindingSeverity severity) {
  return std::count_if(report.findings.begin(), report.findings.end(),
                       [&](const Finding& finding) { return finding.severity == severity; });
}

std::string verdict_of(const Report& report) {
  std::string text = report.passed() ? "PASSED" : "FAILED";
  const std::int64_t errors = kinds_of(report, FindingSeverity::error), warnings = kinds_of(report, FindingSeverity::warning);
  if (errors + warnings == 0) {
    text += ": no findings";
  } else {
    text += ": ";
    if (errors > 0) text += plural(errors, "kind") + " of error";
    if (errors > 0 && warnings > 0) text += ", ";
    if (warnings > 0) text += plural(warnings, "kind") + " of warning";
  }
  return text + fmt::format(" in {}, {}, {}\n", plural(report.num_cells, "cell"), plural(report.num_nodes, "node"),
                            plural(report.num_faces, "tagged face"));
}

std::string place_text(const Finding::Place& place) {
  std::string text = fmt::format("    at ({:.9g}, {:.9g}, {:.9g})", place.at[0], place.at[1], place.at[2]);
  if (place.cell >= 0) text += fmt::format(", cell {}", place.cell);
  if (place.face >= 0) text += fmt::format(", tagged face {}", place.face);
  if (place.node >= 0) text += fmt::format(", node {}", place.node);
  if (!place.group.empty()) text += fmt::format(", in {}", place.group);
  return text + "\n";
}

}  // namespace

bool Report::passed() const {
  return kinds_of(*this, FindingSeverity::error) == 0;
}

std::string to_text(const Report& report) {
  std::string text = verdict_of(report);
  for (const FindingSeverity severity : {FindingSeverity::error, FindingSeverity::warning}) {
    for (const Finding& finding : report.findings) {
      if (finding.severity != severity) continue;
      text += fmt::format("\n{} {}: {}\n", word_of(severity), finding.code, finding.text);
      for (const Finding::Place& place : finding.places) text += place_text(place);
      const std::int64_t more = finding.count - static_cast<std::int64_t>(finding.places.size());
      if (more > 0 && !finding.places.empty()) text += fmt::format("    and {} more\n", grouped(more));
    }
  }
  text += fmt::format("\n{:<20} {:>14} {:>10}\n", "check", "looked at", "found");
  for (const CheckRun& check : report.checks) {
    text += fmt::format("{:<20} {:>14} {:>10}\n", check.name, grouped(check.num_examined), grouped(check.num_found));
  }
  if (!report.volumes.empty()) {
    text += fmt::format("\n{:>6} {:>14} {:>20}  {}\n", "tag", "cells", "volume", "group");
    for (const GroupVolume& group : report.volumes) {
      text += fmt::format("{:>6} {:>14} {:>20.12g}  {}\n", group.tag, grouped(group.num_cells), group.volume, group.name);
    }
  }
  if (!report.nets.empty()) {
    text += fmt::format("\n{:>6} {:>6} {:>14} {:>20}  {}\n", "pieces", "layout", "cells", "volume", "net");
    for (const NetVerdict& net : report.nets)
      text +=
          fmt::format("{:>6} {:>6} {:>14} {:>20.12g}  {}{}\n", net.pieces,
                      net.expected_pieces >= 0 ? std::to_string(net.expected_pieces) : "?", grouped(net.num_cells), net.volume,
                      net.name, net.ports.empty() ? "" : fmt::format(" (ports {})", fmt::join(net.ports, ", ")));
  }
  return text;
}

std::string to_json(const Report& report) {
  using json = nlohmann::ordered_json;
  json out;
  out["schema_version"] = 1;
  out["passed"] = report.passed();
  out["num_nodes"] = report.num_nodes;
  out["num_cells"] = report.num_cells;
  out["num_faces"] = report.num_faces;
  out["findings"] = json::array();
  for (const Finding& finding : report.findings) {
    json places = json::array();
    for (const Finding::Place& place : finding.places) {
      json entry;
      // JSON has no infinities; null says the coordinate is no number.
      entry["at"] = json::array();
      for (const double x : place.at) entry["at"].push_back(std::isfinite(x) ? json(x) : json(nullptr));
      if (place.cell >= 0) entry["cell"] = place.cell;
      if (place.face >= 0) entry["face"] = place.face;
      if (place.node >= 0) entry["node"] = place.node;
      if (!place.group.empty()) entry["group"] = place.group;
      places.push_back(std::move(entry));
    }
    out["findings"].push_back({{"code", finding.code},
                               {"severity", word_of(finding.severity)},
                               {"text", finding.text},
                               {"count", finding.count},
                               {"places", std::move(places)}});
    if (!finding.nets.empty()) out["findings"].back()["nets"] = finding.nets;
    if (!finding.layer.empty()) out["findings"].back()["layer"] = finding.layer;
  }
  out["checks"] = json::array();
  for (const CheckRun& check : report.checks) {
    out["checks"].push_back(
        {{"name", check.name}, {"num_examined", check.num_examined}, {"num_found", check.num_found}, {"cpu_s", check.cpu_s}});
  }
  out["volumes"] = json::array();
  for (const GroupVolume& group : report.volumes) {
    out["volumes"].push_back(
        {{"tag", group.tag}, {"name", group.name}, {"num_cells", group.num_cells}, {"volume", group.volume}});
  }
  out["nets"] = json::array();
  for (const NetVerdict& net : report.nets) {
    out["nets"].push_back({{"name", net.name},
                           {"pieces", net.pieces},
                           {"pieces_of_layout", net.expected_pieces >= 0 ? json(net.expected_pieces) : json(nullptr)},
                           {"num_cells", net.num_cells},
                           {"volume", net.volume},
                           {"ports", net.ports}});
  }
  // Names come from files: bytes that are no UTF-8 are replaced, not thrown at.
  return out.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

}  // namespace pcbmesh::validation
