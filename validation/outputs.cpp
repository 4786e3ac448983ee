// SPDX-License-Identifier: GPL-3.0-or-later
// Reports for CI systems and browsers.
#include "pcbmesh/validation/outputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "pcbmesh/base/version.hpp"
#include "pcbmesh/validation/codes.hpp"

namespace pcbmesh::validation {
namespace {

using json = nlohmann::ordered_json;

/// Length of the well-formed UTF-8 sequence at the start of `text`, 0 if there is none.
std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(0);
  const std::size_t length = lead < 0x80                   ? 1
                             : lead >= 0xC2 && lead < 0xE0 ? 2
                             : lead >= 0xE0 && lead < 0xF0 ? 3
                             : lead >= 0xF0 && lead < 0xF5 ? 4
                                                           : 0;
  if (length == 0 || length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return 0;
  }
  if (length < 3) return length;
  // Overlong forms, surrogates, beyond U+10FFFF, and the non-characters FFFE and FFFF, which XML forbids.
  const unsigned char next = byte(1);
  if ((lead == 0xE0 && next < 0xA0) || (lead == 0xED && next > 0x9F) || (lead == 0xF0 && next < 0x90) ||
      (lead == 0xF4 && next > 0x8F) || (lead == 0xEF && next == 0xBF && byte(2) >= 0xBE)) {
    return 0;
  }
  return length;
}

/// Text for XML and HTML, in elements and quoted attributes.
std::string escaped(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    const char c = text[0];
    if (length == 0 || (static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t')) {
      out += '?';
    } else if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else if (c == '"') {
      out += "&quot;";
    } else {
      out += text.substr(0, length);
    }
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return out;
}

std::string place_text(const Finding::Place& place) {
  std::string text = fmt::format("at ({:.9g}, {:.9g}, {:.9g})", place.at[0], place.at[1], place.at[2]);
  if (place.cell >= 0) text += fmt::format(", cell {}", place.cell);
  if (place.face >= 0) text += fmt::format(", tagged face {}", place.face);
  if (place.node >= 0) text += fmt::format(", node {}", place.node);
  if (!place.group.empty()) text += ", in " + place.group;
  return text;
}

std::string finding_text(const Finding& finding) {
  std::string text = finding.text;
  for (const Finding::Place& place : finding.places) text += "\n" + place_text(place);
  return text;
}

bool counts(FindingSeverity severity, FindingSeverity threshold) {
  return threshold == FindingSeverity::warning || severity == FindingSeverity::error;
}

/// A file name as a URI reference: everything outside the unreserved characters and '/' as %XX.
std::string uri_of(std::string_view file) {
  std::string out;
  for (const char c : file) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       std::string_view("-._~/").find(c) != std::string_view::npos;
    out += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return file.starts_with('/') ? "file://" + out : out;
}

struct JunitCase {
  std::string body;
  bool failed = false;
};

JunitCase junit_case(const Report& report, std::string_view code, FindingSeverity threshold) {
  std::string failure, mild, first;
  for (const Finding& finding : report.findings) {
    if (finding.code != code) continue;
    std::string& to = counts(finding.severity, threshold) ? failure : mild;
    if (&to == &failure && first.empty()) first = finding.text;
    to += finding_text(finding) + "\n";
  }
  JunitCase out;
  const CheckCode* entry = find_check_code(code);
  const std::string remedy = entry ? fmt::format("Remedy: {}\n", entry->remedy) : "";
  if (!failure.empty()) {
    out.failed = true;
    out.body += fmt::format("      <failure message=\"{}\" type=\"{}\">{}</failure>\n", escaped(first), escaped(code),
                            escaped(failure + remedy));
  }
  if (!mild.empty()) out.body += fmt::format("      <system-out>{}</system-out>\n", escaped(mild + remedy));
  return out;
}

}  // namespace

bool fails_at(const Report& report, FindingSeverity threshold) {
  return std::ranges::any_of(report.findings, [&](const Finding& f) { return counts(f.severity, threshold); });
}

std::string to_junit(const Report& report, std::string_view mesh_file, FindingSeverity threshold) {
  std::string cases;
  int failures = 0;
  double seconds = 0;
  for (const CheckRun& run : report.checks) seconds += run.cpu_s;
  for (const CheckCode& entry : check_codes()) {
    const JunitCase one = junit_case(report, entry.code, threshold);
    failures += one.failed ? 1 : 0;
    cases += fmt::format("    <testcase classname=\"pcbmesh.check.{}\" name=\"{}\" time=\"0\"",
                         entry.code.substr(0, entry.code.find('.')), entry.code);
    cases += one.body.empty() ? "/>\n" : ">\n" + one.body + "    </testcase>\n";
  }
  const std::string totals = fmt::format("tests=\"{}\" failures=\"{}\" errors=\"0\"", check_codes().size(), failures);
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites {0} time=\"{1:.3f}\">\n"
      "  <testsuite name=\"{2}\" {0} skipped=\"0\" time=\"{1:.3f}\">\n{3}  </testsuite>\n</testsuites>\n",
      totals, seconds, escaped(mesh_file), cases);
}

std::string to_sarif(const Report& report, std::string_view mesh_file) {
  json rules = json::array();
  for (const CheckCode& entry : check_codes()) {
    rules.push_back({{"id", entry.code},
                     {"shortDescription", {{"text", entry.meaning}}},
                     {"help", {{"text", entry.remedy}}},
                     {"defaultConfiguration", {{"level", word_of(entry.severity)}}}});
  }
  json results = json::array();
  for (const Finding& finding : report.findings) {
    json location = {{"physicalLocation", {{"artifactLocation", {{"uri", uri_of(mesh_file)}}}}}};
    json logical = json::array();
    for (const Finding::Place& place : finding.places) logical.push_back({{"fullyQualifiedName", place_text(place)}});
    if (!logical.empty()) location["logicalLocations"] = std::move(logical);
    json result = {{"ruleId", finding.code}};
    if (const CheckCode* entry = find_check_code(finding.code)) result["ruleIndex"] = entry - check_codes().data();
    result["level"] = word_of(finding.severity);
    result["message"] = {{"text", finding_text(finding)}};
    result["locations"] = json::array({std::move(location)});
    // SARIF wants at least 1.
    if (finding.count > 0) result["occurrenceCount"] = finding.count;
    results.push_back(std::move(result));
  }
  json driver = {{"name", "pcbmesh"}, {"version", version()}, {"rules", std::move(rules)}};
  json run;
  run["tool"]["driver"] = std::move(driver);
  run["results"] = std::move(results);
  json out;
  out["$schema"] = "https://json.schemastore.org/sarif-2.1.0.json";
  out["version"] = "2.1.0";
  out["runs"] = json::array({std::move(run)});
  return out.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

std::string to_html(const Report& report, std::string_view mesh_file) {
  std::string text = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{0}: {1}</title>\n<style>body{{font:15px "
      "sans-serif;max-width:60em;margin:2em auto}}table{{border-collapse:collapse}}td,th{{border:1px solid #bbb;"
      "padding:.2em .6em;text-align:left}}.error{{color:#b00020}}.warning{{color:#8a5a00}}</style></head><body>\n"
      "<h1>{0}: {1}</h1>\n<p>{2} cells, {3} nodes, {4} tagged faces; pcbmesh {5}</p>\n",
      escaped(mesh_file), report.passed() ? "passed" : "failed", report.num_cells, report.num_nodes, report.num_faces,
      version());
  for (const FindingSeverity severity : {FindingSeverity::error, FindingSeverity::warning}) {
    for (const Finding& finding : report.findings) {
      if (finding.severity != severity) continue;
      text += fmt::format("<h2 class=\"{0}\">{0} {1}</h2>\n<p>{2}</p>\n", word_of(severity), escaped(finding.code),
                          escaped(finding.text));
      if (const CheckCode* entry = find_check_code(finding.code)) {
        text += fmt::format("<p>Remedy: {}</p>\n", escaped(entry->remedy));
      }
      if (finding.places.empty()) continue;
      text += "<ul>";
      for (const Finding::Place& place : finding.places) text += fmt::format("<li>{}</li>\n", escaped(place_text(place)));
      text += "</ul>\n";
    }
  }
  text += "<h2>Checks</h2>\n<table><tr><th>check</th><th>looked at</th><th>found</th></tr>\n";
  for (const CheckRun& run : report.checks) {
    text += fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td></tr>\n", escaped(run.name), run.num_examined, run.num_found);
  }
  text += "</table>\n<h2>Volumes</h2>\n<table><tr><th>tag</th><th>group</th><th>cells</th><th>volume</th></tr>\n";
  for (const GroupVolume& group : report.volumes) {
    text += fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td><td>{:.12g}</td></tr>\n", group.tag, escaped(group.name),
                        group.num_cells, group.volume);
  }
  return text + "</table>\n</body></html>\n";
}

}  // namespace pcbmesh::validation
