// SPDX-License-Identifier: GPL-3.0-or-later
// Streams 10 million prisms to a file and compares with a raw write() of as many bytes to the same folder.
// write_bench [folder = /dev/shm] [millions of prisms = 10] [text | json] [part of a case's name]
// With "json" one line of JSON per format follows, for write_peers.py.
#include <fcntl.h>
#include <fmt/format.h>
#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <tuple>
#include <vector>

#include "pcbmesh/formats/registry.hpp"
#include "pcbmesh/layering/prism_quality.hpp"
#include "pcbmesh/mesh/prism_mesh.hpp"
#include "pcbmesh/mesh/prism_source.hpp"

namespace {

using namespace pcbmesh;

constexpr int num_sublayers = 20, num_slabs = 5, num_pairs = 5;

std::size_t index(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

/// n x n squares of two triangles in blocks of 8 x 8 that are regions; 5 slabs of 4 sub-layers; 40 volume tags.
/// With voids every seventh block of the odd slabs is missing.
mesh::PrismMesh synthetic_mesh(std::int64_t num_prisms, bool with_voids) {
  std::int32_t n = 8;
  while (2LL * (n + 8) * (n + 8) * num_sublayers <= num_prisms) n += 8;
  const std::int32_t blocks = n / 8, num_regions = blocks * blocks;
  mesh::PlanarMeshParts plane;
  for (std::int32_t j = 0; j <= n; ++j)
    for (std::int32_t i = 0; i <= n; ++i) plane.points_m.push_back({i * 1e-4 / 3, j * 1e-4 / 7});
  for (std::int32_t j = 0; j < n; ++j)
    for (std::int32_t i = 0; i < n; ++i) {
      const std::int32_t a = j * (n + 1) + i;
      plane.triangles.insert(plane.triangles.end(), {{a, a + 1, a + n + 2}, {a, a + n + 2, a + n + 1}});
      plane.regions.insert(plane.regions.end(), 2, i / 8 + blocks * (j / 8));
    }
  plane.region_body_offsets.assign(index(num_regions) + 1, 0);
  mesh::LayerPlanParts plan;
  for (int k = 0; k <= num_sublayers; ++k) plan.z_m.push_back(k * 1e-5);
  for (int k = 0; k < num_sublayers; ++k) plan.slab.push_back(k / (num_sublayers / num_slabs));

  mesh::PrismMeshParts parts;
  parts.plan = mesh::LayerPlan::from_parts(std::move(plan));
  parts.layers = {"1", "2", "3", "4", "5"};
  parts.materials = {{"m"}};
  constexpr std::int32_t tags_per_slab = 8, num_tags = tags_per_slab * num_slabs;
  for (std::int32_t i = 0; i < num_tags; ++i)
    parts.volume_tags.push_back({i + 1, fmt::format("volume {}", i), i / tags_per_slab, 0, -1, 0, 0});
  parts.face_tags = {{1, "outer"}};
  for (std::int32_t r = 0; r < num_regions; ++r)
    for (std::int32_t s = 0; s < num_slabs; ++s) {
      const bool is_void = with_voids && s % 2 == 1 && r % 7 == 3;
      const std::int32_t tag = tags_per_slab * s + r % tags_per_slab;
      parts.column_tags.push_back(is_void ? -1 : tag);
      if (!is_void) parts.volume_tags[index(tag)].num_prisms += 128 * (num_sublayers / num_slabs);
    }
  const auto present = [&](std::int32_t slab, std::int32_t i, std::int32_t j) {
    if (slab < 0 || slab >= num_slabs || i < 0 || j < 0 || i >= n || j >= n) return false;
    return parts.column_tags[index((i / 8 + blocks * (j / 8)) * num_slabs + slab)] >= 0;
  };
  for (std::int32_t f = 0; f <= num_slabs; ++f)
    for (std::int32_t j = 0; j < n; ++j)
      for (std::int32_t i = 0; i < n; ++i) {
        if (present(f - 1, i, j) == present(f, i, j)) continue;
        for (std::int32_t t = 0; t < 2; ++t)
          parts.caps.push_back({0, f * (num_sublayers / num_slabs), 2 * (j * n + i) + t, present(f - 1, i, j)});
      }
  for (std::int32_t s = 0; s < num_slabs; ++s)
    for (std::int32_t j = 0; j < n; ++j)
      for (std::int32_t i = 0; i < n; ++i) {
        if (!present(s, i, j)) continue;
        const std::int32_t a = j * (n + 1) + i, b = a + 1, c = a + n + 2, d = a + n + 1;
        if (!present(s, i, j - 1)) parts.walls.push_back({0, s, a, b});
        if (!present(s, i + 1, j)) parts.walls.push_back({0, s, b, c});
        if (!present(s, i, j + 1)) parts.walls.push_back({0, s, c, d});
        if (!present(s, i - 1, j)) parts.walls.push_back({0, s, d, a});
      }
  std::ranges::sort(parts.walls, {}, [](const mesh::Wall& w) { return std::tuple(w.tag, w.slab, w.a, w.b); });
  parts.planar = mesh::PlanarMesh::from_parts(std::move(plane));
  return mesh::PrismMesh::from_parts(std::move(parts));
}

double cpu_s(int who = RUSAGE_SELF) {
  rusage usage{};
  ::getrusage(who, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
         1e-6 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

struct Seconds {
  double wall = 0, cpu = 0;
  double main_cpu = 0;  ///< of the calling thread: on a busy machine it tells how the work is shared, wall time does not
};

Seconds seconds_of(const auto& action) {
  const auto start = std::chrono::steady_clock::now();
  const double cpu = cpu_s(), main_cpu = cpu_s(RUSAGE_THREAD);
  action();
  return {std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), cpu_s() - cpu,
          cpu_s(RUSAGE_THREAD) - main_cpu};
}

void write_raw(const std::filesystem::path& file, std::uint64_t size) {
  static const std::vector<char> block(std::size_t{1} << 20, 'x');
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
  for (std::uint64_t done = 0; done < size;) {
    const ssize_t count = ::write(descriptor, block.data(), std::min<std::uint64_t>(block.size(), size - done));
    if (count <= 0) std::abort();
    done += static_cast<std::uint64_t>(count);
  }
  if (::fsync(descriptor) != 0) std::abort();
  ::close(descriptor);
}

/// Peak resident memory since reset_peak(), MB.
double peak_mb() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return std::strtod(line.c_str() + 6, nullptr) / 1024;
  return 0;
}
void reset_peak() {
  std::ofstream("/proc/self/clear_refs") << "5";
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

struct Case {
  std::string name, format;
  formats::WriteMeshOptions options;
};

std::vector<Case> cases() {
  formats::WriteMeshOptions old, wide, packed, packed_twice;
  old.version = "2.2";
  wide.index_bits = 64;
  packed.compression = formats::Compression::zlib;
  packed_twice = packed;
  packed_twice.num_threads = 2;
  formats::WriteMeshOptions lz4 = packed_twice;
  lz4.compression = formats::Compression::lz4;
  return {{"MSH 4.1 binary", "msh", {}},
          {"MSH 2.2 binary", "msh", old},
          {"VTU raw", "vtu", {}},
          {"VTU raw, 64 bits", "vtu", wide},
          {"VTU LZ4, 2 threads", "vtu", lz4},
          {"VTU zlib, 1 thread", "vtu", packed},
          {"VTU zlib, 2 threads", "vtu", packed_twice},
          {"HDF5 contiguous", "vtkhdf", {}},
          {"HDF5 deflate, 1 thread", "vtkhdf", packed},
          {"HDF5 deflate, 2 threads", "vtkhdf", packed_twice},
          {"native", "native", {}}};
}

void measure(const mesh::PrismMesh& mesh, const Case& what, const std::filesystem::path& folder, bool as_json) {
  const auto mesh_file = folder / "pcbmesh_write_bench.mesh", raw_file = folder / "pcbmesh_write_bench.raw";
  std::vector<Seconds> written, raw;
  std::vector<double> ratios, cpu_ratios;
  double growth = 0;
  std::uint64_t size = 0;
  const bool is_packed = what.options.compression == formats::Compression::zlib;
  const int pairs = is_packed ? 1 : num_pairs;
  for (int pair = 0; pair < pairs; ++pair) {
    std::filesystem::remove(mesh_file);
    ::malloc_trim(0);  // memory kept from the run before would hide this one's
    reset_peak();
    const double before = peak_mb();
    written.push_back(seconds_of([&] {
      mesh::PrismSource source(mesh, layering::prism_qualities);
      formats::write_mesh(source, mesh_file, what.options, what.format, Progress{});
    }));
    growth = std::max(growth, peak_mb() - before);
    size = std::filesystem::file_size(mesh_file);
    std::filesystem::remove(mesh_file);
    raw.push_back(seconds_of([&] { write_raw(raw_file, size); }));
    std::filesystem::remove(raw_file);
    ratios.push_back(written.back().wall / raw.back().wall);
    cpu_ratios.push_back(written.back().cpu / raw.back().cpu);
  }
  const auto median_of = [](const std::vector<Seconds>& all, double Seconds::*member) {
    std::vector<double> values;
    for (const Seconds& s : all) values.push_back(s.*member);
    return median(values);
  };
  const double cpu = median_of(written, &Seconds::cpu);
  fmt::print(
      "{:<24} {:>7.1f} MB  CPU {:.3f} s (first thread {:.3f})  raw CPU {:.3f} s  CPU ratio {:.2f}  wall ratio {:.2f}  growth "
      "{:.1f} MB\n",
      what.name, static_cast<double>(size) * 1e-6, cpu, median_of(written, &Seconds::main_cpu), median_of(raw, &Seconds::cpu),
      median(cpu_ratios), median(ratios), growth);
  if (as_json)
    fmt::print("{{\"case\": \"{}\", \"cpu_s\": {:.4f}, \"growth_mb\": {:.2f}, \"prisms\": {}}}\n", what.name, cpu, growth,
               mesh.num_prisms());
  std::fflush(stdout);
}

}  // namespace

int main(int count, char** arguments) {
  const std::filesystem::path folder = count > 1 ? arguments[1] : "/dev/shm";
  const double millions = count > 2 ? std::strtod(arguments[2], nullptr) : 10;
  const std::string wanted = count > 4 ? arguments[4] : "";
  const bool as_json = count > 3 && std::string(arguments[3]) == "json";
  for (const bool with_voids : {false, true}) {
    const mesh::PrismMesh mesh = synthetic_mesh(static_cast<std::int64_t>(millions * 1e6), with_voids);
    fmt::print("{} prisms{}, {} nodes, {} triangles in the plane; medians of {} pairs, folder {}\n", mesh.num_prisms(),
               with_voids ? " with voids" : "", mesh.num_nodes(), mesh.planar().num_triangles(), num_pairs, folder.string());
    for (const Case& what : cases()) {
      if (what.name.find(wanted) == std::string::npos) continue;
      if (with_voids && what.options.compression != formats::Compression::none) continue;
      measure(mesh, what, folder, as_json && !with_voids);
    }
  }
}
