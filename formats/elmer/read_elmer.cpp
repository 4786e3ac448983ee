// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/elmer/read_elmer.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "formats/elements/element_walk.hpp"
#include "formats/mesh_builder/mesh_builder.hpp"
#include "formats/syntax/byte_source.hpp"

namespace pcbmesh::formats::elmer {
namespace {

using mesh::ElementKind;
using syntax::ByteSource;
using syntax::Numbers;

constexpr std::int64_t items_per_report = 1 << 16;
constexpr int most_nodes = 27;

struct ElementType {
  int number = 0;
  std::optional<ElementKind> kind{};  ///< nothing for points and lines
};

/// The number is a hundred times the family (1 point, 2 line, 3 triangle ... 8 hexahedron) plus the nodes.
constexpr std::array element_types{
    ElementType{101, {}},
    ElementType{202, {}},
    ElementType{203, {}},
    ElementType{303, ElementKind::triangle},
    ElementType{404, ElementKind::quadrangle},
    ElementType{504, ElementKind::tetrahedron},
    ElementType{605, ElementKind::pyramid},
    ElementType{706, ElementKind::wedge},
    ElementType{808, ElementKind::hexahedron},
    ElementType{306, ElementKind::triangle6},
    ElementType{408, ElementKind::quadrangle8},
    ElementType{409, ElementKind::quadrangle9},
    ElementType{510, ElementKind::tetrahedron10},
    ElementType{715, ElementKind::wedge15},
    ElementType{718, ElementKind::wedge18},
};

ElementType type_of(const ByteSource& source, std::int32_t number) {
  for (const ElementType& type : element_types) {
    if (type.number == number) return type;
  }
  source.fail(
      fmt::format("element type {} is not read; 303, 404, 504, 605, 706, 808 are, and of second order 306, 408, 409, "
                  "510, 715, 718. Write the mesh with one of these",
                  number));
}

struct Counts {
  std::int64_t nodes = 0, elements = 0, boundary = 0;
};

class Reader {
 public:
  Reader(std::filesystem::path folder, const Progress& progress)
      : folder_(std::move(folder)), progress_(progress), header_(folder_ / "mesh.header"), builder_(header_) {}

  mesh::MeshData read(std::string name) {
    Numbers numbers(header_, false);
    const Counts counts{numbers.size(), numbers.size(), numbers.size()};
    read_nodes(counts.nodes);
    read_rows("mesh.elements", counts.elements, true);
    read_rows("mesh.boundary", counts.boundary, false);
    if (std::filesystem::exists(folder_ / "mesh.names")) read_names();
    mesh::MeshData mesh = builder_.take(std::move(name));
    mesh.format = {"elmer", "", false};
    return mesh;
  }

 private:
  void read_nodes(std::int64_t announced) {
    ByteSource source(folder_ / "mesh.nodes");
    builder_.now_reading(source);
    Numbers numbers(source, false);
    const std::int64_t count = numbers.justified(announced, 12, 10, "nodes");
    builder_.reserve_nodes(count);
    for (std::int64_t i = 0; i < count; ++i) {
      const std::int64_t number = numbers.size();
      static_cast<void>(numbers.integer());  // -1, or a tag that nobody uses
      const double x = numbers.real(), y = numbers.real(), z = numbers.real();
      builder_.add_node(number, {x, y, z});
      tick(source, 0);
    }
    require_end(source);
    builder_.finish_nodes();
  }

  void read_rows(const char* file, std::int64_t announced, bool is_body) {
    ByteSource source(folder_ / file);
    builder_.now_reading(source);
    Numbers numbers(source, false);
    const std::int64_t count = numbers.justified(announced, 10, 10, "elements");
    for (std::int64_t i = 0; i < count; ++i) {
      static_cast<void>(
          numbers.size());  // its number, of which bodies and boundaries have their own: they are told apart by place
      const std::int32_t tag = numbers.integer();
      if (!is_body) {
        static_cast<void>(numbers.size());
        static_cast<void>(numbers.size());
      }
      const std::int32_t type_number = numbers.integer();
      read_element(source, numbers, type_of(source, type_number), tag, is_body);
      tick(source, is_body ? 1 : 2);
    }
    require_end(source);
  }

  void read_element(const ByteSource& source, Numbers& numbers, const ElementType& type, std::int32_t tag, bool is_body) {
    std::array<std::int64_t, most_nodes> read{}, in_order{};
    const auto num_nodes = static_cast<std::size_t>(type.number % 100);
    for (std::size_t k = 0; k < num_nodes; ++k) read[k] = numbers.size();
    if (!type.kind) {
      builder_.add_other(type.number / 100 - 1, tag);
      return;
    }
    if (is_body != (mesh::dimension_of(*type.kind) == 3))
      source.fail(is_body
                      ? fmt::format("an element of type {}, a surface, is a body; only bodies of volume are read", type.number)
                      : fmt::format("an element of type {}, a volume, stands in the boundary", type.number));
    const auto order = node_order(*type.kind, NodeOrder::exodus);
    for (std::size_t k = 0; k < num_nodes; ++k) in_order[order[k]] = read[k];
    builder_.add_element(*type.kind, next_number_++, tag, std::span(in_order).first(num_nodes));
  }

  /// "$ name = number" under a heading "! ----- names for bodies -----" or "... boundaries".
  void read_names() {
    ByteSource source(folder_ / "mesh.names");
    builder_.now_reading(source);
    bool is_of_volumes = true, is_of_faces = true;
    while (source.skip_blanks()) {
      const std::string line(source.line());
      if (line.starts_with('!')) {
        const bool bodies = line.find("bodies") != std::string::npos, sides = line.find("boundaries") != std::string::npos;
        if (bodies != sides) {
          is_of_volumes = bodies;
          is_of_faces = sides;
        }
        continue;
      }
      const std::size_t equals = line.find('=');
      const std::size_t first = line.find_first_not_of("$ \t"), last = line.find_last_not_of(" \t", equals - 1);
      if (!line.starts_with('$') || equals == std::string::npos || first >= equals)
        source.fail("a line '$ name = number' was expected");
      const std::size_t digits = line.find_first_not_of(" \t", equals + 1);
      std::int32_t tag = 0;
      if (digits == std::string::npos ||
          std::from_chars(line.data() + digits, line.data() + line.size(), tag).ec != std::errc())
        source.fail("a number was expected behind the '='");
      const std::string name = line.substr(first, last - first + 1);
      if (is_of_volumes) builder_.add_name(3, tag, name);
      if (is_of_faces) builder_.add_name(2, tag, name);
    }
  }

  void require_end(ByteSource& source) {
    if (source.skip_blanks()) source.fail("the file goes on beyond the count in mesh.header");
  }

  void tick(const ByteSource& source, int part) {
    if (++ticks_ % items_per_report == 0)
      progress_.at(
          "read",
          (part + static_cast<double>(source.offset()) / static_cast<double>(std::max<std::int64_t>(source.size(), 1))) / 3);
  }

  std::filesystem::path folder_;
  const Progress& progress_;
  ByteSource header_;
  MeshBuilder builder_;
  std::int64_t next_number_ = 1, ticks_ = 0;
};

}  // namespace

mesh::MeshData read_elmer(const std::filesystem::path& file, const Progress& progress) {
  progress.check();
  const bool is_header = file.filename() == "mesh.header";
  return Reader(is_header ? file.parent_path() : file, progress).read(file.string());
}

}  // namespace pcbmesh::formats::elmer
