// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

#include "pcbmesh/mesh/mesh_data.hpp"
#include "pcbmesh/validation/report.hpp"

namespace pcbmesh::validation {

/// True if the report holds a finding that bad (`threshold` = warning: any finding at all).
[[nodiscard]] bool fails_at(const Report& report, FindingSeverity threshold);

/// JUnit XML: one test case per check code, so that the number of tests does not depend on the mesh. A finding at or above
/// `threshold` is a failure; a milder one is told in system-out of its case. UTF-8; bytes that XML forbids become '?'.
[[nodiscard]] std::string to_junit(const Report& report, std::string_view mesh_file,
                                   FindingSeverity threshold = FindingSeverity::error);

/// SARIF 2.1.0: all codes as rules, one result per finding, places as logical locations and in the message.
[[nodiscard]] std::string to_sarif(const Report& report, std::string_view mesh_file);

/// One self-contained page: verdict, findings with remedies and first places, checks, volumes. Loads nothing.
[[nodiscard]] std::string to_html(const Report& report, std::string_view mesh_file);

/// VTU (ASCII) of every offending cell, tagged face and node: all of a finding, up to Finding::max_offenders of them.
/// Cell data: "finding" (index into Report::findings), "tag", "is_face". Nodes become vertices.
/// REQUIRES `report` to be of `mesh`; elements that do not fit it (ids out of range) are left out.
[[nodiscard]] std::string to_offenders_vtu(const Report& report, const mesh::MeshData& mesh);

}  // namespace pcbmesh::validation
