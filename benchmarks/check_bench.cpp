// SPDX-License-Identifier: GPL-3.0-or-later
// Speed and memory of the checker on blocks of prisms: check_bench [cells [threads]]. Default: 1e6 and 1e7 cells.
#include <fmt/format.h>
#include <malloc.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <random>
#include <string>

#include "pcbmesh/validation/report.hpp"
#include "validation/checks/checks.hpp"

namespace {

std::atomic<std::int64_t> bytes_now{0}, bytes_peak{0};

void* counted(std::size_t size) {
  void* block = std::malloc(size == 0 ? 1 : size);
  if (block == nullptr) throw std::bad_alloc();
  const std::int64_t now = bytes_now += static_cast<std::int64_t>(malloc_usable_size(block));
  std::int64_t peak = bytes_peak;
  while (now > peak && !bytes_peak.compare_exchange_weak(peak, now)) {
  }
  return block;
}

}  // namespace

// Counting allocations is the one way to tell the checker's memory from the mesh's.
void* operator new(std::size_t size) {
  return counted(size);
}
void* operator new[](std::size_t size) {
  return counted(size);
}
void operator delete(void* block) noexcept {
  if (block != nullptr) bytes_now -= static_cast<std::int64_t>(malloc_usable_size(block));
  std::free(block);
}
void operator delete[](void* block) noexcept {
  operator delete(block);
}
void operator delete(void* block, std::size_t) noexcept {
  operator delete(block);
}
void operator delete[](void* block, std::size_t) noexcept {
  operator delete(block);
}

namespace {

using namespace pcbmesh;

/// n x n squares, cut in two triangles each, times `layers`; copper in the odd layers. With tagged outer faces.
mesh::MeshData prism_block(std::int64_t n, std::int64_t layers, validation::Expectation& expectation) {
  mesh::MeshData mesh;
  const std::int64_t per_level = (n + 1) * (n + 1);
  const double step = 0.3 / static_cast<double>(n), height = 1e-4;
  for (std::int64_t k = 0; k <= layers; ++k) {
    for (std::int64_t j = 0; j <= n; ++j) {
      for (std::int64_t i = 0; i <= n; ++i) {
        mesh.nodes.push_back({static_cast<double>(i) * step, static_cast<double>(j) * step, static_cast<double>(k) * height});
      }
    }
  }
  mesh::CellBlock cells;
  mesh::FaceBlock triangles, quads;
  triangles.kind = mesh::FaceKind::triangle;
  quads.kind = mesh::FaceKind::quadrangle;
  const auto node = [&](std::int64_t i, std::int64_t j, std::int64_t k) { return k * per_level + j * (n + 1) + i; };
  cells.corners.reserve(static_cast<std::size_t>(12 * n * n * layers));
  cells.tags.reserve(static_cast<std::size_t>(2 * n * n * layers));
  for (std::int64_t k = 0; k < layers; ++k) {
    for (std::int64_t j = 0; j < n; ++j) {
      for (std::int64_t i = 0; i < n; ++i) {
        const std::int64_t a = node(i, j, k), b = node(i + 1, j, k), c = node(i + 1, j + 1, k), d = node(i, j + 1, k);
        for (const auto& t : {std::array{a, b, c}, std::array{a, c, d}}) {
          cells.corners.insert(cells.corners.end(), {t[0], t[1], t[2], t[0] + per_level, t[1] + per_level, t[2] + per_level});
          cells.tags.push_back(static_cast<std::int32_t>(1 + k % 2));
          if (k == 0) triangles.corners.insert(triangles.corners.end(), {t[0], t[2], t[1]});
          if (k == layers - 1) {
            triangles.corners.insert(triangles.corners.end(), {t[0] + per_level, t[1] + per_level, t[2] + per_level});
          }
        }
      }
    }
    for (std::int64_t i = 0; i < n; ++i) {
      const auto wall = [&](std::int64_t a, std::int64_t b) {
        quads.corners.insert(quads.corners.end(), {a, b, b + per_level, a + per_level});
      };
      wall(node(i, 0, k), node(i + 1, 0, k));
      wall(node(i + 1, n, k), node(i, n, k));
      wall(node(0, i + 1, k), node(0, i, k));
      wall(node(n, i, k), node(n, i + 1, k));
    }
  }
  triangles.tags.assign(triangles.corners.size() / 3, 1);
  quads.tags.assign(quads.corners.size() / 4, 1);
  mesh.cells.push_back(std::move(cells));
  mesh.faces = {std::move(triangles), std::move(quads)};
  mesh.names = {{3, 1, "core|fr4|none"}, {3, 2, "Cu|copper|GND"}, {2, 1, "outer"}};
  expectation.volumes = {{1, "core|fr4|none", "core", "fr4", "", false}, {2, "Cu|copper|GND", "Cu", "copper", "GND", true}};
  expectation.faces = {{1, "outer"}};
  expectation.nets = {{"GND", static_cast<std::int32_t>(layers / 2)}};
  return mesh;
}

void shuffle(mesh::MeshData& mesh) {
  std::vector<std::int64_t> to(mesh.nodes.size());
  for (std::size_t i = 0; i < to.size(); ++i) to[i] = static_cast<std::int64_t>(i);
  std::mt19937_64 random(1);
  std::shuffle(to.begin(), to.end(), random);
  auto nodes = mesh.nodes;
  for (std::size_t i = 0; i < to.size(); ++i) nodes[static_cast<std::size_t>(to[i])] = mesh.nodes[i];
  mesh.nodes = std::move(nodes);
  for (auto& block : mesh.cells) {
    for (auto& corner : block.corners) corner = to[static_cast<std::size_t>(corner)];
    for (std::int64_t i = block.size() - 1; i > 0; --i) {
      const auto j = static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(i + 1));
      std::swap(block.tags[static_cast<std::size_t>(i)], block.tags[static_cast<std::size_t>(j)]);
      std::swap_ranges(block.corners.begin() + 6 * i, block.corners.begin() + 6 * i + 6, block.corners.begin() + 6 * j);
    }
  }
  for (auto& block : mesh.faces) {
    for (auto& corner : block.corners) corner = to[static_cast<std::size_t>(corner)];
  }
}

/// Takes a chequerboard of 4 x 4 squares out of every copper layer, as hollow conductors do: a large inner boundary.
mesh::MeshData hollowed(const mesh::MeshData& mesh, std::int64_t n) {
  mesh::MeshData out = mesh;
  mesh::CellBlock& cells = out.cells[0];
  std::int64_t kept = 0;
  for (std::int64_t i = 0; i < cells.size(); ++i) {
    const std::int64_t square = i / 2 % (n * n);
    const std::int32_t tag = cells.tags[static_cast<std::size_t>(i)];
    if (tag == 2 && i < cells.size() - 2 * n * n && (square % n / 4 + square / n / 4) % 2 == 0) continue;
    std::copy_n(cells.corners.begin() + 6 * i, 6, cells.corners.begin() + 6 * kept);
    cells.tags[static_cast<std::size_t>(kept++)] = tag;
  }
  cells.corners.resize(static_cast<std::size_t>(6 * kept));
  cells.tags.resize(static_cast<std::size_t>(kept));
  out.faces.clear();
  return out;
}

template <class Work>
void measure(const std::string& what, std::int64_t cells, Work&& work) {
  const std::int64_t before = bytes_now;
  bytes_peak = before;
  rusage start{}, stop{};
  getrusage(RUSAGE_SELF, &start);
  const auto begin = std::chrono::steady_clock::now();
  work();
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  getrusage(RUSAGE_SELF, &stop);
  const auto seconds = [](const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); };
  const double cpu = seconds(stop.ru_utime) + seconds(stop.ru_stime) - seconds(start.ru_utime) - seconds(start.ru_stime);
  const auto n = static_cast<double>(cells);
  fmt::print("{:<46} {:>8.2f} Mcell/s wall {:>8.2f} Mcell/s per CPU {:>7.1f} extra bytes/cell\n", what, n / wall * 1e-6,
             n / cpu * 1e-6, static_cast<double>(bytes_peak - before) / n);
}

void check_all(const mesh::MeshData& mesh, const validation::Expectation* expectation, const std::string& label, int threads) {
  validation::Report report;
  measure(label + ": all", mesh.cells[0].size(),
          [&] { report = validation::check(mesh, expectation, {.num_threads = threads}); });
  for (const auto& check : report.checks) {
    fmt::print("    {:<20} {:>12} {:>7.3f} s CPU\n", check.name, check.num_examined, check.cpu_s);
  }
  if (!report.passed()) fmt::print("{}", validation::to_text(report));
}

void run(std::int64_t wanted, int threads) {
  constexpr std::int64_t layers = 20;
  std::int64_t n = 1;
  while (2 * (n + 1) * (n + 1) * layers <= wanted) ++n;
  validation::Expectation expectation;
  mesh::MeshData mesh = prism_block(n, layers, expectation);
  const std::int64_t cells = mesh.cells[0].size();
  {
    const mesh::MeshData hollow = hollowed(mesh, n);
    check_all(hollow, nullptr, fmt::format("{} prisms, hollow, {} threads", hollow.cells[0].size(), threads), threads);
  }
  for (const char* order : {"natural", "shuffled"}) {
    if (order[0] == 's') shuffle(mesh);
    const std::string label = fmt::format("{} prisms, {} order, {} threads", cells, order, threads);
    const validation::checks::Context context(mesh, nullptr, {.num_threads = threads});
    measure(label + ": faces", cells, [&] {
      const auto match = validation::checks::match_faces(context, nullptr);
      if (match.untagged.count() != 0) std::abort();
    });
    check_all(mesh, &expectation, label, threads);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const int threads = argc > 2 ? std::atoi(argv[2]) : 2;
  if (argc > 1) {
    run(static_cast<std::int64_t>(std::atof(argv[1])), threads);
    return 0;
  }
  for (const int t : {1, 2}) run(1'000'000, t);
  for (const int t : {1, 2}) run(10'000'000, t);
}
