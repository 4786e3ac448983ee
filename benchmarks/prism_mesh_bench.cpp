// SPDX-License-Identifier: GPL-3.0-or-later
#include <benchmark/benchmark.h>

#include <cstdint>
#include <vector>

#include "pcbmesh/extrude/extrude.hpp"
#include "pcbmesh/layering/prism_quality.hpp"

namespace pcbmesh {
namespace {

/// How many conductors are missing from the mesh.
enum class Voids { none, half, checkered };

constexpr int side_squares = 500;  // 500,000 triangles, 251,001 vertices

mesh::PlanarMesh bench_planar() {
  mesh::PlanarMeshParts parts;
  const double step = 1e-4;
  for (int j = 0; j <= side_squares; ++j) {
    for (int i = 0; i <= side_squares; ++i) parts.points_m.push_back({i * step, j * step});
  }
  for (int j = 0; j < side_squares; ++j) {
    for (int i = 0; i < side_squares; ++i) {
      const std::int32_t a = j * (side_squares + 1) + i, b = a + 1, c = b + side_squares + 1, d = c - 1;
      parts.triangles.insert(parts.triangles.end(), {{a, b, c}, {a, c, d}});
      parts.regions.insert(parts.regions.end(), 2, (i / 10 + j / 10) % 2);
    }
  }
  parts.region_body_offsets = {0, 2, 5};
  parts.region_bodies = {0, 1, 0, 1, 2};
  return mesh::PlanarMesh::from_parts(std::move(parts));
}

model::Model bench_model(Voids voids) {
  model::ModelParts parts;
  parts.materials = {{"FR4"}, {"copper"}};
  parts.nets = {"GND"};
  for (Nm s = 0; s < 10; ++s) {
    parts.slabs.push_back(
        {std::string(1, static_cast<char>('A' + s)), model::SlabKind::dielectric, s * 100'000, (s + 1) * 100'000, 0, -1});
  }
  parts.bodies = {{"domain", model::BodyKind::domain, -1, board::no_net, 0, 9},
                  {"board", model::BodyKind::board, -1, board::no_net, 0, 9},
                  {"copper", model::BodyKind::copper, 1, 0, voids == Voids::half ? 5 : 0, 9, 1, voids != Voids::none}};
  return model::Model::from_parts(std::move(parts));
}

mesh::LayerPlan bench_plan() {
  mesh::LayerPlanParts parts;
  for (int k = 0; k <= 20; ++k) parts.z_m.push_back(k * 5e-5);
  for (int k = 0; k < 20; ++k) parts.slab.push_back(k / 2);
  return mesh::LayerPlan::from_parts(std::move(parts));
}

const mesh::PrismMesh& bench_mesh(Voids voids) {
  static const mesh::PlanarMesh planar = bench_planar();
  static const std::vector<mesh::PrismMesh> meshes = [] {
    std::vector<mesh::PrismMesh> made;
    for (Voids kind : {Voids::none, Voids::half, Voids::checkered}) {
      made.push_back(extrude::extrude(planar, bench_plan(), bench_model(kind), {}, {}));
    }
    return made;
  }();
  return meshes[static_cast<std::size_t>(voids)];
}

void fill_prisms(benchmark::State& state) {
  const mesh::PrismMesh& mesh = bench_mesh(static_cast<Voids>(state.range(0)));
  std::vector<std::array<std::int64_t, 6>> block(static_cast<std::size_t>(state.range(1)));
  std::vector<std::int32_t> tags(block.size());
  std::int64_t filled = 0;
  for (auto step : state) {
    for (std::int64_t first = 0; first < mesh.num_prisms();) {
      const auto size = static_cast<std::size_t>(std::min<std::int64_t>(state.range(1), mesh.num_prisms() - first));
      mesh.fill_prisms(first, std::span(block).first(size), std::span(tags).first(size));
      benchmark::DoNotOptimize(block.data());
      first += static_cast<std::int64_t>(size);
    }
    filled += mesh.num_prisms();
  }
  state.SetItemsProcessed(filled);
}
BENCHMARK(fill_prisms)->ArgsProduct({{0, 1, 2}, {4096, 65536}})->Unit(benchmark::kMillisecond);

void fill_nodes(benchmark::State& state) {
  const mesh::PrismMesh& mesh = bench_mesh(static_cast<Voids>(state.range(0)));
  std::vector<std::array<double, 3>> block(65536);
  std::int64_t filled = 0;
  for (auto step : state) {
    for (std::int64_t first = 0; first < mesh.num_nodes();) {
      const auto size = static_cast<std::size_t>(std::min<std::int64_t>(65536, mesh.num_nodes() - first));
      mesh.fill_nodes(first, std::span(block).first(size));
      benchmark::DoNotOptimize(block.data());
      first += static_cast<std::int64_t>(size);
    }
    filled += mesh.num_nodes();
  }
  state.SetItemsProcessed(filled);
}
BENCHMARK(fill_nodes)->DenseRange(0, 2)->Unit(benchmark::kMillisecond);

void extrude_board(benchmark::State& state) {
  const auto voids = static_cast<Voids>(state.range(0));
  const mesh::PlanarMesh planar = bench_mesh(voids).planar();
  const model::Model model = bench_model(voids);
  for (auto step : state) benchmark::DoNotOptimize(extrude::extrude(planar, bench_plan(), model, {}, {}));
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()) * planar.num_triangles());
}
BENCHMARK(extrude_board)->DenseRange(0, 2)->Unit(benchmark::kMillisecond);

void quality(benchmark::State& state) {
  const mesh::PrismMesh& mesh = bench_mesh(static_cast<Voids>(state.range(0)));
  for (auto step : state) benchmark::DoNotOptimize(layering::quality_statistics(mesh));
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()) * mesh.planar().num_triangles());
}
BENCHMARK(quality)->DenseRange(0, 2)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace pcbmesh
