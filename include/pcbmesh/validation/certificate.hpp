// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "pcbmesh/validation/report.hpp"

namespace pcbmesh::validation {

/// What was made of what, and what was found: written beside a mesh (docs/schema/certificate.schema.json). Holds neither
/// time nor path, so that the same run gives the same bytes.
struct Certificate {
  struct File {
    std::string role;    ///< board, study, tags, mesh, or part: a file or folder that belongs to a mesh beside it
    std::string name;    ///< without its folder
    std::string sha256;  ///< 64 lower-case hexadecimal digits
    std::string of{};    ///< part: name of its mesh
  };
  struct Check {
    std::string name;
    std::int64_t num_examined = 0, num_found = 0;
  };
  struct Problem {
    std::string code;
    FindingSeverity severity = FindingSeverity::error;
    std::int64_t count = 0;
  };
  struct Volume {
    std::int32_t tag = 0;
    std::string name, material;
    std::int64_t num_cells = 0;
    double volume_m3 = 0;     ///< sum over the cells of the mesh
    double analytic_m3 = -1;  ///< area times height by the layout, < 0 = unknown
  };
  std::string version;  ///< of the program
  std::vector<File> files;
  std::vector<Check> checks;
  std::vector<Problem> findings;
  std::vector<Volume> volumes;
};

/// The file's name and hash under a role. @throws Error file_unreadable (201).
[[nodiscard]] Certificate::File certified_file(std::string role, const std::filesystem::path& file);
/// @param report  of the mesh among `files`. @param unit_m  metres per unit of the report's volumes.
[[nodiscard]] Certificate certify(const Report& report, const Expectation& expectation, double unit_m,
                                  std::vector<Certificate::File> files);
[[nodiscard]] std::string to_json(const Certificate& certificate);
/// @throws Error file_unreadable (201), file_syntax (202).
[[nodiscard]] Certificate read_certificate(const std::string& file);
/// Compares the mesh, its parts, its tags and its report with the certificate, board and study too if they lie beside the mesh;
/// adds the check "certificate" to the report. @param tags  the tags.json of the report.
/// @throws Error file_unreadable (201).
void check_certificate(const Certificate& certificate, const std::filesystem::path& mesh, const std::filesystem::path& tags,
                       double unit_m, Report& report);

}  // namespace pcbmesh::validation
