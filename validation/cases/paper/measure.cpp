// SPDX-License-Identifier: GPL-3.0-or-later
// Measures what docs/evidence/paper.md tells; prints JSON. `run` beside it drives this program and pcbmesh itself.
#include "validation/cases/paper/measure.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <exception>
#include <fstream>
#include <string>
#include <vector>

namespace {

namespace paper = pcbmesh::validation::paper;

constexpr const char* usage =
    "usage: paper_measure table1 SEED COUNT | figure4 SEED | cases BOARD.json COMPAT.json\n"
    "COMPAT.json: {\"layer_heights_mm\": [...], \"case1_sublayers\": [...]}\n";

paper::CompatLayers read_compat(const std::string& file) {
  std::ifstream in(file);
  const nlohmann::json json = nlohmann::json::parse(in);
  paper::CompatLayers layers;
  for (const double height_mm : json.at("layer_heights_mm").get<std::vector<double>>())
    layers.heights_m.push_back(height_mm * 1e-3);
  layers.first_counts = json.at("case1_sublayers").get<std::vector<std::int32_t>>();
  if (layers.first_counts.size() != layers.heights_m.size()) throw std::runtime_error("one count per layer height is needed");
  return layers;
}

nlohmann::ordered_json measure(const std::vector<std::string>& words) {
  if (words.size() == 3 && words[0] == "table1")
    return paper::measure_random_triangles(std::stoull(words[1]), std::stoi(words[2]));
  if (words.size() == 2 && words[0] == "figure4") return paper::sample_sensitivity(std::stoull(words[1]));
  if (words.size() == 3 && words[0] == "cases") return paper::measure_cases(words[1], read_compat(words[2]));
  throw std::invalid_argument(usage);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    fmt::print("{}\n", measure({argv + 1, argv + argc}).dump());
    return EXIT_SUCCESS;
  } catch (const std::exception& error) {
    fmt::print(stderr, "paper_measure: {}\n", error.what());
    return 2;
  }
}
