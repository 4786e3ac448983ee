// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures and pages of meshes of about a million prisms: view_bench [board ...]. Default: the paper's examples in its cases 4
// and 5, cut by floor as the paper does and by this program's own rule. CPU seconds beyond meshing; memory above the mesh's.
#include <fmt/format.h>
#include <malloc.h>
#include <sys/resource.h>

#include <cstdint>
#include <ctime>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pcbmesh/formats/registry.hpp"
#include "pcbmesh/layering/quality_report.hpp"
#include "pcbmesh/pipeline/mesh_board.hpp"
#include "pcbmesh/pipeline/write_outputs.hpp"
#include "pcbmesh/view/cell_render.hpp"
#include "pcbmesh/view/render.hpp"
#include "pcbmesh/view/report.hpp"
#include "pcbmesh/view/skin.hpp"

namespace {

using namespace pcbmesh;

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

template <class Work>
double measured(Work&& work) {
  const double start = cpu_seconds();
  work();
  return cpu_seconds() - start;
}

double peak_mib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

/// The same prisms as a mesh file has them: cells without layers.
void measure_cells(const std::string& name, const mesh::PrismMesh& mesh) {
  const auto data = std::make_shared<mesh::MeshData>(pipeline::expand(mesh));
  std::optional<view::CellMesh> cells;
  const double match_s = measured([&] { cells.emplace(data, 1.0); });
  view::PictureOptions picture;
  for (const view::CellGroup& g : cells->groups()) picture.visibility.hidden_groups.push_back(g.is_air ? 1 : 0);
  std::string png, page;
  const double png_s = measured([&] { png = view::render_png(*cells, picture); });
  const double page_s = measured([&] {
    view::PageContents contents;
    contents.title = name;
    contents.quality.histograms.push_back(cells->quality().histogram);
    page = view::report_html(*cells, contents);
  });
  fmt::print("| {} | {} | {} | {:.2f} | {:.2f} | {:.2f} | {:.2f} |\n", name, cells->num_cells(), cells->faces().size(), match_s,
             png_s, page_s, static_cast<double>(page.size()) / (1 << 20));
}

mesh::PrismMesh measure(const std::string& name, const std::string& board, const study::Study& study) {
  const pipeline::MeshBoardResult result = pipeline::mesh_board(formats::read_board(board).board, study);
  const mesh::PrismMesh& mesh = result.mesh;
  view::PictureOptions picture;
  picture.visibility.hidden_groups = view::air_groups(mesh);
  view::SkinCount outer;
  const double skin_s = measured([&] { outer = view::count_skin(mesh, picture.visibility); });
  std::string png, exploded, page;
  const double png_s = measured([&] { png = view::render_png(mesh, picture); });
  picture.explode = 1;
  picture.visibility.mode = view::SkinMode::layers;
  const double exploded_s = measured([&] { exploded = view::render_png(mesh, picture); });
  const double page_s = measured([&] {
    view::PageContents contents;
    contents.title = name;
    contents.quality = layering::quality_report(mesh);
    page = view::report_html(mesh, contents);
  });
  fmt::print("| {} | {} | {} | {:.3f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.0f} |\n", name, mesh.num_prisms(),
             outer.num_triangles + outer.num_quads, skin_s, png_s, exploded_s, page_s,
             static_cast<double>(page.size()) / (1 << 20), peak_mib());
  return mesh;
}

}  // namespace

int main(int argc, char** argv) {
  fmt::print(
      "Peers for 1,009,391 prisms: VTK 9.1 surface filter 0.89 CPU s, with the first frame 2.0; the paper's program 144 s for\n"
      "13,400 prisms. Pictures are 1600 x 1000.\n\n");
  fmt::print(
      "| mesh | prisms | visible faces | skin, CPU s | picture | exploded picture | page | page, MiB | peak MiB so far |\n");
  fmt::print("|---|---|---|---|---|---|---|---|---|\n");
  std::vector<std::pair<std::string, mesh::PrismMesh>> meshes;
  const auto add = [&](const std::string& name, const std::string& board, const study::Study& study) {
    meshes.emplace_back(name, measure(name, board, study));
  };
  for (int i = 1; i < argc; ++i) add(std::filesystem::path(argv[i]).stem().string(), argv[i], {});
  for (const char* board : {"serpentine", "via"}) {
    if (argc > 1) break;
    for (const auto policy : {study::HeightPolicy::minimum, study::HeightPolicy::thinnest_layer}) {
      for (const bool by_paper : {true, false}) {
        study::Study study = study::read_study("examples/paper.study.json");
        study.policy = policy;
        study.paper_compat = by_paper;
        if (!by_paper) study.sublayers = study::Study{}.sublayers;
        add(fmt::format("{}, case {}, {}", board, policy == study::HeightPolicy::minimum ? 4 : 5,
                        by_paper ? "as in the paper" : study::name_of(study.sublayers)),
            fmt::format("examples/{}.json", board), study);
      }
    }
  }
  // Last, so that the peak memory above is that of the implicit meshes.
  fmt::print(
      "\nThe same as cells of a mesh file:\n\n| mesh | cells | faces kept | matched, CPU s | picture | page | page, MiB |\n"
      "|---|---|---|---|---|---|---|\n");
  constexpr std::int64_t most_cells = 3'000'000;  // a file of more is seldom carried about
  for (const auto& [name, mesh] : meshes)
    if (mesh.num_prisms() <= most_cells) measure_cells(name, mesh);
}
