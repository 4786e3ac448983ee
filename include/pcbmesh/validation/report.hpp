// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pcbmesh/mesh/mesh_data.hpp"
#include "pcbmesh/validation/limits.hpp"

namespace pcbmesh::validation {

struct Profile;

/// All findings of one kind: counted in full, with the first few places. Codes are listed in docs/checks.md. A code may
/// come more than once with different texts (e.g. "net.short", once for each pair of nets).
struct Finding {
  std::string code;  ///< stable, e.g. "face.unmatched"
  FindingSeverity severity = FindingSeverity::error;
  std::string text;  ///< what is wrong, in one sentence, with numbers
  std::int64_t count = 0;
  struct Place {
    std::int64_t cell = -1;      ///< index over all cell blocks in order, -1 = none
    std::array<double, 3> at{};  ///< coordinates as in the file (centre of the cell or face)
    std::string group;           ///< name of the volume or face group, may be empty
    std::int64_t face = -1;      ///< index over all tagged face blocks in order, -1 = none
    std::int64_t node = -1;      ///< node index, -1 = none
  };
  std::vector<Place> places;  ///< the first max_places
  static constexpr std::size_t max_places = 8, max_offenders = 100'000;
  /// All that were found, the smallest indices up to max_offenders, ascending. Empty where a finding has no such elements
  /// or only its places are known.
  std::vector<std::int64_t> cells{}, faces{}, nodes{};
  std::vector<std::string> nets{};  ///< findings about nets: which
  std::string layer{};              ///< findings about nets: where the fault is, may be empty
};

/// One check and what it looked at.
struct CheckRun {
  std::string name;  ///< e.g. "faces"
  std::int64_t num_examined = 0;
  std::int64_t num_found = 0;
  double cpu_s = 0;
};

struct GroupVolume {
  std::int32_t tag = 0;
  std::string name;
  std::int64_t num_cells = 0;
  double volume = 0;  ///< cubed unit of the file
};

/// One net as the mesh has it: mesh against layout.
struct NetVerdict {
  std::string name;
  std::int32_t expected_pieces = -1;  ///< by the layout; < 0 = not known
  std::int32_t pieces = 0;            ///< of copper cells, skins of hollow copper and sheets together
  std::int64_t num_cells = 0;
  double volume = 0;                 ///< of its copper cells, cubed unit of the file
  std::vector<std::string> ports{};  ///< names of the port groups that share an edge with it
};

/// Verdict on one mesh. Never throws for a bad mesh: a bad mesh is an answer.
struct Report {
  std::vector<CheckRun> checks;
  std::vector<Finding> findings;
  std::vector<GroupVolume> volumes;
  std::vector<NetVerdict> nets;  ///< nets with copper in the mesh, by name; empty without tags.json
  std::int64_t num_nodes = 0, num_cells = 0, num_faces = 0;
  /// No finding of severity error.
  [[nodiscard]] bool passed() const;
};

/// What the mesh is supposed to be, from tags.json.
struct Expectation {
  struct Volume {
    std::int32_t tag = 0;
    std::string name, layer, material, net;  ///< net empty = none
    bool conductor = false;
    std::int64_t num_cells = -1;
    double volume_m3 = -1;  ///< area x height, < 0 = unknown
  };
  struct Face {
    std::int32_t tag = 0;
    std::string name;
    bool outer = true;
    std::int64_t num_faces = -1;
    double area_m2 = -1;
    std::string kind{};  ///< outer, conductor, sheet, port, wave_port or interface; empty = not said
    std::string port{};  ///< name of its port; empty = none
  };
  struct Net {
    std::string name;
    std::int32_t pieces = -1;  ///< connected pieces of solid copper by the layout; < 0 = unknown
  };
  /// What lies between two heights; a name may come more than once.
  struct Layer {
    std::string name;
    double z_min_m = 0, z_max_m = 0;
  };
  /// The faces of group `b` are those of group `a`, shifted.
  struct Periodic {
    std::string a, b;                              ///< names of face groups
    std::optional<std::array<double, 3>> shift_m;  ///< from a to b; nullopt = as the corners of their boxes lie
  };
  double unit_m = 1.0;  ///< metres per unit of the file
  std::vector<Volume> volumes;
  std::vector<Face> faces;
  std::vector<Net> nets;
  std::vector<std::array<std::string, 2>> touching_nets;  ///< allowed contacts
  std::vector<Layer> layers;                              ///< empty = not known
  std::vector<double> levels_m;                           ///< heights of the levels of nodes, ascending; empty = not known
  std::vector<Periodic> periodic;
  std::vector<std::string> coaxial_ports;  ///< names
};

/// Reads the contract tags.json. @throws Error file_unreadable (201), file_syntax (202).
[[nodiscard]] Expectation read_expectation(const std::string& file);

struct CheckOptions {
  int num_threads = 1;
  Limits limits{};                   ///< none by default
  const Profile* profile = nullptr;  ///< rules of one solver; null = none
  /// Judges connections by the nets and contacts of this one instead: the tags.json of another mesh of the same layout.
  const Expectation* netlist = nullptr;
};

/// Runs every check. Shares no code with the generator. The same mesh gives the same report (but for cpu_s), whatever the
/// number of threads.
/// @param expectation  null: only what the mesh itself promises is checked.
/// @cost about 50 bytes per cell beyond the mesh; face matching about 5 million cells a second.
[[nodiscard]] Report check(const mesh::MeshData& mesh, const Expectation* expectation, const CheckOptions& options = {});

/// For people: verdict, checks with counts, findings grouped with first places.
[[nodiscard]] std::string to_text(const Report& report);
/// For machines: docs/schema/check-report.schema.json.
[[nodiscard]] std::string to_json(const Report& report);

}  // namespace pcbmesh::validation
