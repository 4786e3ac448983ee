// SPDX-License-Identifier: GPL-3.0-or-later
// The whole run beside Gmsh's on the same generated board. Gmsh is given our arrangement for free (every face as a plane
// surface), then does what a user would ask of it: mesh in 2D with the same edge bound, extrude with layers, recombine to
// prisms, write MSH 4.1. usage: gmsh_bench [columns rows] [folder]
#include <fmt/format.h>
#include <gmsh.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <numeric>
#include <vector>

#include "benchmarks/generated_board.hpp"
#include "pcbmesh/compose/compose.hpp"
#include "pcbmesh/formats/registry.hpp"
#include "pcbmesh/overlay/overlay.hpp"
#include "pcbmesh/pipeline/mesh_board.hpp"

namespace {

using namespace pcbmesh;

constexpr double longest_edge_mm = 0.5;

struct Cost {
  double cpu_s = 0, peak_mib = 0;
  std::int64_t prisms = 0;
};

/// Runs a job in a process of its own, so that time and memory are its alone. The job returns its number of prisms.
Cost measured(const std::function<std::int64_t()>& job) {
  int pipe_ends[2];
  if (pipe(pipe_ends) != 0) std::abort();
  const pid_t child = fork();
  if (child == 0) {
    const std::int64_t prisms = job();
    if (write(pipe_ends[1], &prisms, sizeof prisms) != sizeof prisms) _exit(1);
    _exit(0);
  }
  int status = 0;
  rusage usage{};
  wait4(child, &status, 0, &usage);
  Cost cost;
  if (status != 0 || read(pipe_ends[0], &cost.prisms, sizeof cost.prisms) != sizeof cost.prisms) {
    fmt::print(stderr, "a job failed\n");
    std::exit(1);
  }
  const auto seconds = [](timeval t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); };
  cost.cpu_s = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  cost.peak_mib = static_cast<double>(usage.ru_maxrss) / 1024;
  return cost;
}

/// A face of the arrangement: signed edge ids (1-based) of its loops, the outer one first.
struct Face {
  std::vector<std::vector<int>> loops;
};

/// Walks the faces of a planar graph; loops of nested components go to the face around them.
std::vector<Face> faces_of(const mesh::PlanarGraph& graph) {
  const auto vertices = graph.vertices();
  const auto edges = graph.edges();
  // Half-edge 2e runs u->v, 2e+1 runs v->u.
  const auto from = [&](std::size_t h) { return edges[h / 2][h % 2]; };
  const auto to = [&](std::size_t h) { return edges[h / 2][1 - h % 2]; };
  std::vector<std::vector<std::size_t>> leaving(vertices.size());
  for (std::size_t h = 0; h < 2 * edges.size(); ++h) leaving[static_cast<std::size_t>(from(h))].push_back(h);
  const auto angle = [&](std::size_t h) {
    const geometry::Point a = vertices[static_cast<std::size_t>(from(h))], b = vertices[static_cast<std::size_t>(to(h))];
    return std::atan2(static_cast<double>(b.y - a.y), static_cast<double>(b.x - a.x));
  };
  std::vector<std::size_t> position(2 * edges.size());
  for (auto& fan : leaving) {
    std::sort(fan.begin(), fan.end(), [&](std::size_t a, std::size_t b) { return angle(a) < angle(b); });
    for (std::size_t i = 0; i < fan.size(); ++i) position[fan[i]] = i;
  }
  // Next half-edge of the face on the left: the one just clockwise of the way back.
  const auto next = [&](std::size_t h) {
    const auto& fan = leaving[static_cast<std::size_t>(to(h))];
    return fan[(position[h ^ 1] + fan.size() - 1) % fan.size()];
  };
  std::vector<int> loop_of(2 * edges.size(), -1);
  std::vector<std::vector<std::size_t>> loops;
  std::vector<double> area;
  for (std::size_t start = 0; start < 2 * edges.size(); ++start) {
    if (loop_of[start] >= 0) continue;
    loops.emplace_back();
    double sum = 0;
    for (std::size_t h = start; loop_of[h] < 0; h = next(h)) {
      loop_of[h] = static_cast<int>(loops.size()) - 1;
      loops.back().push_back(h);
      const geometry::Point a = vertices[static_cast<std::size_t>(from(h))], b = vertices[static_cast<std::size_t>(to(h))];
      sum += static_cast<double>(a.x) * static_cast<double>(b.y) - static_cast<double>(b.x) * static_cast<double>(a.y);
    }
    area.push_back(sum);
  }
  std::vector<Face> faces;
  std::vector<int> face_of_loop(loops.size(), -1);
  const auto signed_ids = [&](int loop) {
    std::vector<int> ids;
    for (std::size_t h : loops[static_cast<std::size_t>(loop)])
      ids.push_back((static_cast<int>(h / 2) + 1) * (h % 2 == 0 ? 1 : -1));
    return ids;
  };
  for (std::size_t l = 0; l < loops.size(); ++l)
    if (area[l] > 0) {
      face_of_loop[l] = static_cast<int>(faces.size());
      faces.push_back({{signed_ids(static_cast<int>(l))}});
    }
  // An outer contour (negative area) lies in the face left of the nearest edge straight below its lowest vertex; chains of
  // contours are followed.
  const auto loop_below = [&](std::size_t l) -> int {
    geometry::Point low = vertices[static_cast<std::size_t>(from(loops[l][0]))];
    for (std::size_t h : loops[l])
      low = std::min(low, vertices[static_cast<std::size_t>(from(h))],
                     [](auto a, auto b) { return a.y < b.y || (a.y == b.y && a.x < b.x); });
    double best = -1e300;
    int found = -1;
    for (std::size_t h = 0; h < 2 * edges.size(); ++h) {
      const geometry::Point a = vertices[static_cast<std::size_t>(from(h))], b = vertices[static_cast<std::size_t>(to(h))];
      if (!(a.x <= low.x && low.x < b.x) || loop_of[h] == static_cast<int>(l))
        continue;  // left of a rightward edge is above it
      const double y = static_cast<double>(a.y) +
                       static_cast<double>(b.y - a.y) * static_cast<double>(low.x - a.x) / static_cast<double>(b.x - a.x);
      if (y < static_cast<double>(low.y) && y > best) {
        best = y;
        found = loop_of[h];
      }
    }
    return found;
  };
  for (std::size_t l = 0; l < loops.size(); ++l) {
    if (area[l] > 0) continue;
    int at = loop_below(l);
    while (at >= 0 && area[static_cast<std::size_t>(at)] <= 0) at = loop_below(static_cast<std::size_t>(at));
    if (at >= 0)
      faces[static_cast<std::size_t>(face_of_loop[static_cast<std::size_t>(at)])].loops.push_back(
          signed_ids(static_cast<int>(l)));
  }
  return faces;
}

std::int64_t mesh_with_gmsh(const mesh::PlanarGraph& graph, const std::vector<Face>& faces, const mesh::LayerPlan& plan,
                            const std::string& file) {
  gmsh::initialize();
  gmsh::option::setNumber("General.Verbosity", 1);
  gmsh::option::setNumber("General.NumThreads", 1);
  gmsh::option::setNumber("Mesh.MeshSizeMax", longest_edge_mm);
  gmsh::option::setNumber("Mesh.Algorithm", 5);
  for (std::size_t v = 0; v < graph.vertices().size(); ++v)
    gmsh::model::geo::addPoint(static_cast<double>(graph.vertices()[v].x) * 1e-6,
                               static_cast<double>(graph.vertices()[v].y) * 1e-6, 0, 0, static_cast<int>(v) + 1);
  for (std::size_t e = 0; e < graph.edges().size(); ++e)
    gmsh::model::geo::addLine(graph.edges()[e][0] + 1, graph.edges()[e][1] + 1, static_cast<int>(e) + 1);
  gmsh::vectorpair surfaces;
  int loop_tag = 0, surface_tag = 0;
  for (const Face& face : faces) {
    std::vector<int> loop_tags;
    for (const std::vector<int>& loop : face.loops) loop_tags.push_back(gmsh::model::geo::addCurveLoop(loop, ++loop_tag));
    surfaces.emplace_back(2, gmsh::model::geo::addPlaneSurface(loop_tags, ++surface_tag));
  }
  std::vector<int> counts;
  std::vector<double> heights;
  const double total = plan.z_m().back() - plan.z_m().front();
  for (std::int32_t k = 0; k < plan.num_sublayers(); ++k) {
    counts.push_back(1);
    heights.push_back((plan.z_m()[static_cast<std::size_t>(k) + 1] - plan.z_m().front()) / total);
  }
  gmsh::vectorpair out;
  gmsh::model::geo::extrude(surfaces, 0, 0, total * 1e3, out, counts, heights, true);
  gmsh::model::geo::synchronize();
  std::vector<int> volumes;
  for (const auto& [dimension, tag] : out)
    if (dimension == 3) volumes.push_back(tag);
  gmsh::model::addPhysicalGroup(3, volumes, 1);
  gmsh::model::mesh::generate(3);
  gmsh::option::setNumber("Mesh.Binary", 1);
  gmsh::write(file);
  std::vector<int> types;
  std::vector<std::vector<std::size_t>> tags, nodes;
  gmsh::model::mesh::getElements(types, tags, nodes, 3);
  std::int64_t prisms = 0;
  for (const auto& list : tags) prisms += static_cast<std::int64_t>(list.size());
  return prisms;
}

}  // namespace

int main(int argc, char** argv) {
  const int columns = argc > 2 ? std::atoi(argv[1]) : 30, rows = argc > 2 ? std::atoi(argv[2]) : 30;
  const std::string folder = argc > 3 ? argv[3] : "/tmp";
  const board::Board board = benchmarks::generated_board(columns, rows);
  study::Study study;
  study.air_above = study.air_below = 0;
  study.longest_edge = static_cast<Nm>(longest_edge_mm * 1e6);
  study.policy = study::HeightPolicy::basic;
  study.sublayers = study::SublayerRule::floor;

  // The arrangement and the levels, for Gmsh; not part of its bill.
  Diagnostics diagnostics;
  const model::Model model = compose::compose(board, study, diagnostics);
  const overlay::OverlayResult arrangement = overlay::overlay(model, {}, diagnostics);
  const std::vector<Face> faces = faces_of(arrangement.graph);
  const pipeline::MeshBoardResult once = pipeline::mesh_board(board, study);

  const Cost ours = measured([&] {
    const pipeline::MeshBoardResult result = pipeline::mesh_board(board, study);
    formats::write_mesh(result.mesh, folder + "/bench_pcbmesh.msh", {});
    return result.mesh.num_prisms();
  });
  const Cost idle = measured([] { return std::int64_t{0}; });  // what the parent itself occupies
  const Cost theirs =
      measured([&] { return mesh_with_gmsh(arrangement.graph, faces, once.mesh.plan(), folder + "/bench_gmsh.msh"); });

  fmt::print(
      "generated board {} x {} mm, {} arrangement edges, {} faces, {} sub-layers; memory above the idle process ({:.0f} MiB)\n",
      columns, rows, arrangement.graph.edges().size(), faces.size(), once.mesh.plan().num_sublayers(), idle.peak_mib);
  fmt::print("{:<10} {:>10} {:>12} {:>10} {:>14}\n", "", "CPU s", "prisms", "peak MiB", "prisms per s");
  for (const auto& [name, cost] : {std::pair{"pcbmesh", ours}, {"Gmsh", theirs}})
    fmt::print("{:<10} {:>10.2f} {:>12} {:>10.1f} {:>14.0f}\n", name, cost.cpu_s, cost.prisms, cost.peak_mib - idle.peak_mib,
               static_cast<double>(cost.prisms) / cost.cpu_s);
  fmt::print("Gmsh / pcbmesh: {:.1f} x CPU time, {:.1f} x CPU time per prism, {:.1f} x memory\n", theirs.cpu_s / ours.cpu_s,
             (theirs.cpu_s / static_cast<double>(theirs.prisms)) / (ours.cpu_s / static_cast<double>(ours.prisms)),
             (theirs.peak_mib - idle.peak_mib) / std::max(1.0, ours.peak_mib - idle.peak_mib));
  return 0;
}
