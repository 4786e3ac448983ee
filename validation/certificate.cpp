// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/validation/certificate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "pcbmesh/base/sha256.hpp"
#include "pcbmesh/base/version.hpp"
#include "pcbmesh/validation/codes.hpp"
#include "validation/json_field.hpp"

namespace pcbmesh::validation {
namespace {

using Json = nlohmann::ordered_json;

Json relative_error(double found, double analytic) {
  return analytic > 0 ? Json(found / analytic - 1) : Json(nullptr);
}

Json analytic_or_null(double analytic) {
  return analytic < 0 ? Json(nullptr) : Json(analytic);
}

struct MaterialSum {
  double found = 0, analytic = 0;
  bool is_known = true;
};

std::map<std::string, MaterialSum> materials_of(const Certificate& certificate) {
  std::map<std::string, MaterialSum> sums;
  for (const Certificate::Volume& volume : certificate.volumes) {
    if (volume.material.empty()) continue;
    MaterialSum& sum = sums[volume.material];
    sum.found += volume.volume_m3;
    sum.analytic += volume.analytic_m3;
    sum.is_known = sum.is_known && volume.analytic_m3 >= 0;
  }
  return sums;
}

Finding finding_of(const char* code, std::string text) {
  return {code, FindingSeverity::error, std::move(text), 1, {}};
}

/// A file of the certificate's role and name that lies in `folder`, compared.
void compare_file(const Certificate& certificate, const char* role, const std::filesystem::path& file,
                  std::vector<Finding>& findings) {
  const Certificate::File now = certified_file(role, file);
  std::string names;
  for (const Certificate::File& known : certificate.files) {
    if (known.role != role) continue;
    if (known.sha256 == now.sha256) return;
    names += (names.empty() ? "" : ", ") + known.name;
  }
  findings.push_back(finding_of("certificate.file_differs",
                                names.empty() ? fmt::format("the certificate names no {} file, so that {} is not certified",
                                                            role, file.filename().string())
                                              : fmt::format("{} ({}) is not the file of the certificate ({}): SHA-256 {}",
                                                            file.filename().string(), role, names, now.sha256)));
}

void compare_part(const Certificate::File& known, const std::filesystem::path& file, std::vector<Finding>& findings) {
  if (!std::filesystem::exists(file)) {
    findings.push_back(
        finding_of("certificate.file_differs", fmt::format("{}, a part of {}, is not beside it", known.name, known.of)));
  } else if (const Certificate::File now = certified_file(known.role, file); now.sha256 != known.sha256) {
    findings.push_back(finding_of(
        "certificate.file_differs",
        fmt::format("{}, a part of {}, is not the one of the certificate: SHA-256 {}", known.name, known.of, now.sha256)));
  }
}

void compare_checks(const Certificate& certificate, const Report& report, std::vector<Finding>& findings) {
  for (const Certificate::Check& known : certificate.checks) {
    const auto run = std::ranges::find(report.checks, known.name, &CheckRun::name);
    if (run == report.checks.end()) {
      findings.push_back(
          finding_of("certificate.verdict_differs", fmt::format("check '{}' of the certificate was not run", known.name)));
    } else if (run->num_examined != known.num_examined || run->num_found != known.num_found) {
      findings.push_back(
          finding_of("certificate.verdict_differs",
                     fmt::format("check '{}' looked at {} and found {}; by the certificate it looked at {} and found {}",
                                 known.name, run->num_examined, run->num_found, known.num_examined, known.num_found)));
    }
  }
}

void compare_volumes(const Certificate& certificate, const Report& report, double unit_m, std::vector<Finding>& findings) {
  const double cubed = unit_m * unit_m * unit_m;
  for (const Certificate::Volume& known : certificate.volumes) {
    const auto found = std::ranges::find(report.volumes, known.tag, &GroupVolume::tag);
    const double volume = found == report.volumes.end() ? 0 : found->volume * cubed;
    // The same cells give the same sum to the last bit or two, whatever the program's version.
    if (std::abs(volume - known.volume_m3) <= 1e-12 * std::max(std::abs(volume), std::abs(known.volume_m3))) continue;
    findings.push_back(
        finding_of("certificate.volume_differs", fmt::format("group {} '{}' fills {:.15g} m3, by the certificate {:.15g} m3",
                                                             known.tag, known.name, volume, known.volume_m3)));
  }
}

bool is_sha256(const std::string& text) {
  return text.size() == 64 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

void read_volumes(const Field& list, Certificate& out) {
  for (const Field& field : list.list()) {
    Certificate::Volume volume;
    volume.tag = static_cast<std::int32_t>(field["tag"].integer(1, std::numeric_limits<std::int32_t>::max()));
    volume.name = field["name"].text();
    volume.material = field["material"].text_or_empty();
    volume.num_cells = field["num_cells"].count_or_unknown();
    volume.volume_m3 = field["volume_m3"].number();
    volume.analytic_m3 = field["analytic_m3"].measure_or_unknown();
    out.volumes.push_back(std::move(volume));
  }
}

}  // namespace

Certificate::File certified_file(std::string role, const std::filesystem::path& file) {
  return {std::move(role), file.filename().string(), sha256_of_file(file)};
}

Certificate certify(const Report& report, const Expectation& expectation, double unit_m, std::vector<Certificate::File> files) {
  Certificate out;
  out.version = version();
  out.files = std::move(files);
  for (const CheckRun& run : report.checks) out.checks.push_back({run.name, run.num_examined, run.num_found});
  for (const Finding& finding : report.findings) out.findings.push_back({finding.code, finding.severity, finding.count});
  for (const GroupVolume& group : report.volumes) {
    Certificate::Volume volume{group.tag, group.name, "", group.num_cells, group.volume * unit_m * unit_m * unit_m, -1};
    const auto expected = std::ranges::find(expectation.volumes, group.tag, &Expectation::Volume::tag);
    if (expected != expectation.volumes.end()) {
      volume.material = expected->material;
      volume.analytic_m3 = expected->volume_m3;
    }
    out.volumes.push_back(std::move(volume));
  }
  return out;
}

std::string to_json(const Certificate& certificate) {
  Json out;
  out["schema_version"] = 1;
  out["pcbmesh"] = certificate.version;
  out["passed"] = std::ranges::none_of(
      certificate.findings, [](const Certificate::Problem& problem) { return problem.severity == FindingSeverity::error; });
  out["files"] = Json::array();
  for (const auto& file : certificate.files)
    out["files"].push_back({{"role", file.role},
                            {"name", file.name},
                            {"sha256", file.sha256},
                            {"of", file.of.empty() ? Json(nullptr) : Json(file.of)}});
  out["checks"] = Json::array();
  for (const auto& check : certificate.checks)
    out["checks"].push_back({{"name", check.name}, {"num_examined", check.num_examined}, {"num_found", check.num_found}});
  out["findings"] = Json::array();
  for (const auto& problem : certificate.findings)
    out["findings"].push_back({{"code", problem.code}, {"severity", word_of(problem.severity)}, {"count", problem.count}});
  out["volumes"] = Json::array();
  for (const auto& volume : certificate.volumes)
    out["volumes"].push_back({{"tag", volume.tag},
                              {"name", volume.name},
                              {"material", volume.material},
                              {"num_cells", volume.num_cells},
                              {"volume_m3", volume.volume_m3},
                              {"analytic_m3", analytic_or_null(volume.analytic_m3)},
                              {"relative_error", relative_error(volume.volume_m3, volume.analytic_m3)}});
  out["materials"] = Json::array();
  for (const auto& [name, sum] : materials_of(certificate))
    out["materials"].push_back({{"name", name},
                                {"volume_m3", sum.found},
                                {"analytic_m3", analytic_or_null(sum.is_known ? sum.analytic : -1)},
                                {"relative_error", relative_error(sum.found, sum.is_known ? sum.analytic : -1)}});
  return out.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Certificate read_certificate(const std::string& file) {
  const JsonSource source{file, "the file is damaged or not a certificate of pcbmesh"};
  const nlohmann::json document = parse_json(source);
  const Field top(&document, "", source);
  if (top["schema_version"].integer(0, 1000) != 1) top["schema_version"].fail("1, the only version this program knows");
  constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
  Certificate out;
  out.version = top["pcbmesh"].text();
  for (const Field& field : top["files"].list()) {
    out.files.push_back({field["role"].text(), field["name"].text(), field["sha256"].text(), field["of"].text_or_empty()});
    if (!is_sha256(out.files.back().sha256)) field["sha256"].fail("64 lower-case hexadecimal digits");
  }
  for (const Field& field : top["checks"].list()) {
    out.checks.push_back({field["name"].text(), field["num_examined"].integer(0, most), field["num_found"].integer(0, most)});
  }
  for (const Field& field : top["findings"].list()) {
    const bool is_error = field["severity"].text() == "error";
    out.findings.push_back(
        {field["code"].text(), is_error ? FindingSeverity::error : FindingSeverity::warning, field["count"].integer(0, most)});
  }
  read_volumes(top["volumes"], out);
  return out;
}

void check_certificate(const Certificate& certificate, const std::filesystem::path& mesh, const std::filesystem::path& tags,
                       double unit_m, Report& report) {
  std::vector<Finding> findings;
  compare_file(certificate, "mesh", mesh, findings);
  compare_file(certificate, "tags", tags, findings);
  for (const Certificate::File& known : certificate.files) {
    const std::filesystem::path file = mesh.parent_path() / known.name;
    const bool is_input = known.role == "board" || known.role == "study";
    if (is_input && std::filesystem::is_regular_file(file)) compare_file(certificate, known.role.c_str(), file, findings);
    if (known.role == "part" && known.of == mesh.filename()) compare_part(known, file, findings);
  }
  compare_checks(certificate, report, findings);
  compare_volumes(certificate, report, unit_m, findings);
  const auto num_examined =
      static_cast<std::int64_t>(certificate.files.size() + certificate.checks.size() + certificate.volumes.size());
  report.checks.push_back({"certificate", num_examined, static_cast<std::int64_t>(findings.size()), 0});
  std::ranges::move(findings, std::back_inserter(report.findings));
}

}  // namespace pcbmesh::validation
