// SPDX-License-Identifier: GPL-3.0-or-later
// fault_matrix [FOLDER]: every kind of damage on every kind of cells, and the codes that are found, as JSON. With a folder,
// each damaged mesh of prisms that a file can hold is written there as MSH 2.2 text, for other programs to judge.
// fault_matrix --size N FILE: a good mesh of about N prisms.
#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "fault_list.hpp"
#include "pcbmesh/validation/codes.hpp"

namespace pcbmesh::tests {
namespace {

using Json = nlohmann::ordered_json;
constexpr std::uint64_t num_seeds = 8;

int type_of(mesh::CellKind kind) {
  constexpr int types[] = {4, 7, 6, 5};
  return types[static_cast<int>(kind)];
}

/// Only what every reader knows: coordinates, elements, one number per group.
void write_msh(const mesh::MeshData& mesh, const std::string& file) {
  std::ofstream out(file);
  out << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" << mesh.nodes.size() << "\n";
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    out << fmt::format("{} {} {} {}\n", i + 1, mesh.nodes[i][0], mesh.nodes[i][1], mesh.nodes[i][2]);
  }
  std::int64_t count = 0, number = 0;
  for (const auto& block : mesh.faces) count += block.size();
  for (const auto& block : mesh.cells) count += block.size();
  out << "$EndNodes\n$Elements\n" << count << "\n";
  const auto put = [&](const auto& block, int type) {
    const auto n = static_cast<std::size_t>(corners_of(block.kind));
    for (std::size_t i = 0; i < block.tags.size(); ++i) {
      out << fmt::format("{} {} 2 {} {}", ++number, type, block.tags[i], block.tags[i]);
      for (std::size_t k = 0; k < n; ++k) out << " " << block.corners[i * n + k] + 1;
      out << "\n";
    }
  };
  for (const auto& block : mesh.faces) put(block, block.kind == mesh::FaceKind::triangle ? 2 : 3);
  for (const auto& block : mesh.cells) put(block, type_of(block.kind));
  out << "$EndElements\n";
}

bool fits_in_a_file(const std::string& code) {
  for (const char* other :
       {"array.size", "array.kind", "mesh.empty", "node.not_finite", "cell.corner_out_of_range", "face.corner_out_of_range"}) {
    if (code == other) return false;
  }
  return true;
}

Json judge(const Fault& fault, std::size_t number, const std::string& folder) {
  Json out{{"fault", fault.name}, {"cells", Json::object()}, {"reasons", Json::array()}};
  for (const Consequence& one : fault.consequences) out["reasons"].push_back({one.code, one.is_certain, one.why});
  for (const Cells cells : all_cells) {
    std::set<std::string> found_once, expected;
    bool is_found = true;
    for (std::uint64_t seed = 0; seed < num_seeds; ++seed) {
      Damage damage(cells, seed);
      const std::string code = fault.apply(damage);
      if (code.empty()) continue;
      expected.insert(code);
      std::set<std::string> found;
      for (const auto& finding : damage.check().findings) found.insert(finding.code);
      is_found = is_found && found.contains(code);
      found_once.insert(found.begin(), found.end());
      if (seed == 0 && cells == Cells::prisms && !folder.empty() && fits_in_a_file(code)) {
        const std::string file = fmt::format("{}/{:03}.msh", folder, number);
        write_msh(damage.c.mesh, file);
        out["file"] = file;
      }
    }
    if (expected.empty()) continue;
    out["cells"][name_of(cells)] = {{"expected", expected}, {"is_found", is_found}, {"found", found_once}};
  }
  return out;
}

void write_large(std::int64_t wanted, const std::string& file) {
  BlockPlan plan;
  constexpr int layers = 10;
  while (2LL * plan.nx * plan.nx * layers < wanted) ++plan.nx;
  plan.ny = plan.nx;
  plan.heights.assign(layers, 1e-4);
  plan.tetrahedral.assign(layers, false);
  plan.groups = {{"core", "fr4", "", false}};
  plan.labels.assign(static_cast<std::size_t>(plan.nx) * static_cast<std::size_t>(plan.ny) * layers, 0);
  plan.rising.assign(static_cast<std::size_t>(plan.nx) * static_cast<std::size_t>(plan.ny), true);
  write_msh(build_block(plan).mesh, file);
}

}  // namespace
}  // namespace pcbmesh::tests

int main(int argc, char** argv) {
  using namespace pcbmesh::tests;
  if (argc == 4 && std::string(argv[1]) == "--size") {
    write_large(std::atoll(argv[2]), argv[3]);
    return 0;
  }
  const std::string folder = argc > 1 ? argv[1] : "";
  Json out{{"faults", Json::array()}, {"subjects", Json::object()}};
  for (const auto& entry : pcbmesh::validation::check_codes()) out["subjects"][std::string(entry.code)] = entry.subject;
  if (!folder.empty()) write_msh(Damage(Cells::prisms, 0).c.mesh, folder + "/good.msh");
  const std::vector<Fault> faults = all_faults();
  for (std::size_t i = 0; i < faults.size(); ++i) out["faults"].push_back(judge(faults[i], i, folder));
  fmt::print("{}\n", out.dump(1));
  return 0;
}
