// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/msh/periodic.hpp"

#include <fmt/format.h>

#include <charconv>
#include <string_view>

namespace pcbmesh::formats::msh {
namespace {

using syntax::ByteSource;
using syntax::Numbers;

/// Sixteen numbers of a matrix of homogeneous coordinates; the last row is 0 0 0 1.
std::optional<std::array<double, 12>> affine_of(std::span<const double> numbers, const ByteSource& source) {
  if (numbers.empty()) return std::nullopt;
  if (numbers.size() != 16) source.fail(fmt::format("a transformation of {} numbers, not of 16", numbers.size()));
  std::array<double, 12> rows{};
  std::copy_n(numbers.begin(), rows.size(), rows.begin());
  return rows;
}

std::int64_t count_22(ByteSource& source, const Numbers& numbers, std::string_view word) {
  std::int64_t value = 0;
  const auto parsed = std::from_chars(word.data(), word.data() + word.size(), value);
  if (parsed.ec != std::errc() || parsed.ptr != word.data() + word.size())
    source.fail(fmt::format("'{}' is no count of nodes", word.substr(0, 30)));
  return numbers.justified(value, 8, 4, "nodes of a link");
}

SurfaceLink read_link(ByteSource& source, Numbers& numbers, bool is_41, bool& is_surface) {
  SurfaceLink link;
  const std::int32_t dimension = numbers.integer();
  if (dimension < 0 || dimension > 2) source.fail(fmt::format("a link between entities of dimension {}", dimension));
  is_surface = dimension == 2;
  link.surface = numbers.integer();
  link.partner = numbers.integer();
  std::vector<double> affine;
  std::int64_t count = 0;
  if (is_41) {
    affine.resize(static_cast<std::size_t>(numbers.count(8, 2, "numbers of a transformation")));
    for (double& number : affine) number = numbers.real();
    count = numbers.count(16, 4, "nodes of a link");
  } else {
    std::string_view word = source.word();
    if (word == "Affine") {
      affine.resize(16);
      for (double& number : affine) number = numbers.real();
      word = source.word();
    }
    count = count_22(source, numbers, word);
  }
  link.from_partner = affine_of(affine, source);
  link.node_numbers.resize(static_cast<std::size_t>(count));
  for (auto& [node, partner] : link.node_numbers) {
    node = numbers.size();
    partner = numbers.size();
  }
  return link;
}

}  // namespace

void SurfaceFaces::add(mesh::ElementKind kind, std::int32_t surface, std::int64_t in_mesh,
                       std::span<const std::int64_t> corners) {
  if (last_ == nullptr || last_tag_ != surface) {
    last_ = &surfaces_[surface];
    last_tag_ = surface;
  }
  if (in_mesh < 0) {
    const auto n = static_cast<std::size_t>(mesh::corners_of(kind));
    auto& list = n == 3 ? last_->triangles : last_->quadrangles;
    list.insert(list.end(), corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(n));
    return;
  }
  auto& runs = last_->runs;
  if (!runs.empty() && runs.back().kind == kind && runs.back().first + runs.back().count == in_mesh)
    ++runs.back().count;
  else
    runs.push_back({kind, in_mesh, 1});
}

std::vector<mesh::FaceBlock> SurfaceFaces::of(std::int32_t surface, const MeshBuilder& builder) const {
  mesh::FaceBlock triangles{mesh::FaceKind::triangle, {}, {}}, quadrangles{mesh::FaceKind::quadrangle, {}, {}};
  const auto found = surfaces_.find(surface);
  if (found == surfaces_.end()) return {};
  for (const Run& run : found->second.runs) {
    auto& block = mesh::corners_of(run.kind) == 3 ? triangles : quadrangles;
    const auto corners = builder.corners_of_faces(run.kind, run.first, run.count);
    block.corners.insert(block.corners.end(), corners.begin(), corners.end());
  }
  for (const std::int64_t number : found->second.triangles) triangles.corners.push_back(builder.numbers().find(number));
  for (const std::int64_t number : found->second.quadrangles) quadrangles.corners.push_back(builder.numbers().find(number));
  std::vector<mesh::FaceBlock> blocks;
  for (mesh::FaceBlock* block : {&triangles, &quadrangles}) {
    if (block->corners.empty()) continue;
    block->tags.assign(block->corners.size() / static_cast<std::size_t>(mesh::corners_of(block->kind)), 0);
    blocks.push_back(std::move(*block));
  }
  return blocks;
}

std::vector<SurfaceLink> read_periodic(ByteSource& source, Numbers numbers, bool is_41) {
  const std::int64_t count = numbers.count(12 + (is_41 ? 16 : 0), 8, "periodic links");
  std::vector<SurfaceLink> links;
  for (std::int64_t i = 0; i < count; ++i) {
    bool is_surface = false;
    SurfaceLink link = read_link(source, numbers, is_41, is_surface);
    if (is_surface) links.push_back(std::move(link));
  }
  return links;
}

std::vector<mesh::PeriodicLink> resolve(std::span<const SurfaceLink> links, const SurfaceFaces& faces,
                                        const MeshBuilder& builder) {
  std::vector<mesh::PeriodicLink> out;
  for (const SurfaceLink& link : links) {
    mesh::PeriodicLink& one = out.emplace_back();
    one.name = fmt::format("surface {} of surface {}", link.surface, link.partner);
    one.from_partner = link.from_partner;
    one.faces = faces.of(link.surface, builder);
    one.partner_faces = faces.of(link.partner, builder);
    for (const auto& [node, partner] : link.node_numbers)
      one.nodes.push_back({builder.numbers().find(node), builder.numbers().find(partner)});
  }
  return out;
}

}  // namespace pcbmesh::formats::msh
