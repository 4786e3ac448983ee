// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/xdmf/topology.hpp"

#include <fmt/format.h>

#include "formats/vtk/cells.hpp"
#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats::xdmf {
namespace {

using mesh::ElementKind;

struct Kind {
  std::string_view name;  ///< lower case
  std::int64_t code;      ///< in a mixed stream
  ElementKind kind;
};
constexpr Kind kinds[] = {{"triangle", 4, ElementKind::triangle},
                          {"quadrilateral", 5, ElementKind::quadrangle},
                          {"tetrahedron", 6, ElementKind::tetrahedron},
                          {"pyramid", 7, ElementKind::pyramid},
                          {"wedge", 8, ElementKind::wedge},
                          {"hexahedron", 9, ElementKind::hexahedron},
                          {"triangle_6", 36, ElementKind::triangle6},
                          {"tri_6", 36, ElementKind::triangle6},
                          {"quadrilateral_8", 37, ElementKind::quadrangle8},
                          {"quad_8", 37, ElementKind::quadrangle8},
                          {"quadrilateral_9", 35, ElementKind::quadrangle9},
                          {"quad_9", 35, ElementKind::quadrangle9},
                          {"tetrahedron_10", 38, ElementKind::tetrahedron10},
                          {"tet_10", 38, ElementKind::tetrahedron10},
                          {"wedge_15", 40, ElementKind::wedge15},
                          {"wedge_18", 41, ElementKind::wedge18}};

std::string lower_case(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

std::int32_t tag_at(std::span<const std::int64_t> tags, std::size_t i) {
  return tags.empty() ? 0 : static_cast<std::int32_t>(tags[i]);
}

void add_mixed(vtk::MeshAssembly& mesh, std::span<const std::int64_t> numbers, std::span<const std::int64_t> tags,
               const std::function<void(const std::string&)>& fail, std::int64_t first_node) {
  std::size_t element = 0;
  for (std::size_t at = 0; at < numbers.size(); ++element) {
    const std::int64_t code = numbers[at++];
    if (!tags.empty() && element >= tags.size()) fail(fmt::format("holds more elements than the {} tags", tags.size()));
    if (code == 1 || code == 2) {  // points and lines say how many nodes they have
      const std::int64_t count = at < numbers.size() ? numbers[at++] : -1;
      if (count < 0 || count > static_cast<std::int64_t>(numbers.size() - at))
        fail(fmt::format("element {} of a mixed topology is cut off", element));
      at += static_cast<std::size_t>(count);
      mesh.add_point_or_line(code == 2);
      continue;
    }
    const Kind* found = nullptr;
    for (const Kind& kind : kinds)
      if (kind.code == code) found = &kind;
    if (found == nullptr) fail(fmt::format("element {} of a mixed topology has the code {}, which is not read", element, code));
    const auto width = static_cast<std::size_t>(mesh::nodes_of(found->kind));
    if (width > numbers.size() - at) fail(fmt::format("element {} of a mixed topology is cut off", element));
    mesh.add_element(found->kind, numbers.subspan(at, width), vtk::node_order(found->kind, VtkWedge::parametric),
                     tag_at(tags, element), first_node);
    at += width;
  }
  if (!tags.empty() && element != tags.size())
    fail(fmt::format("holds {} elements, but there are {} tags", element, tags.size()));
}

}  // namespace

std::optional<ElementKind> kind_of(std::string_view topology) {
  const std::string name = lower_case(topology);
  for (const Kind& known : kinds)
    if (known.name == name) return known.kind;
  return std::nullopt;
}

void add_elements(vtk::MeshAssembly& mesh, std::string_view topology, std::span<const std::int64_t> numbers,
                  std::span<const std::int64_t> tags, const std::function<void(const std::string&)>& fail,
                  std::int64_t first_node) {
  const std::string name = lower_case(topology);
  if (name == "mixed") return add_mixed(mesh, numbers, tags, fail, first_node);
  const std::optional<ElementKind> kind = kind_of(topology);
  if (!kind) {
    fail(fmt::format("topology '{}' is not read", topology.substr(0, 40)));
    return;
  }
  const auto width = static_cast<std::size_t>(mesh::nodes_of(*kind));
  if (numbers.size() % width != 0) fail(fmt::format("{} node numbers make no whole {}s", numbers.size(), name));
  const std::size_t count = numbers.size() / width;
  if (!tags.empty() && tags.size() != count) fail(fmt::format("holds {} elements, but there are {} tags", count, tags.size()));
  mesh.reserve(*kind, static_cast<std::int64_t>(count));
  for (std::size_t i = 0; i < count; ++i)
    mesh.add_element(*kind, numbers.subspan(i * width, width), vtk::node_order(*kind, VtkWedge::parametric), tag_at(tags, i),
                     first_node);
}

}  // namespace pcbmesh::formats::xdmf
