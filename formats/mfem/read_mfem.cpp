// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/mfem/read_mfem.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "formats/mesh_builder/mesh_builder.hpp"
#include "formats/syntax/byte_source.hpp"

namespace pcbmesh::formats::mfem {
namespace {

using mesh::ElementKind;

constexpr std::int64_t items_per_report = 1 << 16;

std::optional<ElementKind> kind_of(std::int32_t geometry) {
  switch (geometry) {
    case 2:
      return ElementKind::triangle;
    case 3:
      return ElementKind::quadrangle;
    case 4:
      return ElementKind::tetrahedron;
    case 5:
      return ElementKind::hexahedron;
    case 6:
      return ElementKind::wedge;
    case 7:
      return ElementKind::pyramid;
    default:
      return std::nullopt;
  }
}

/// An element waits for the vertices, which come last in the file.
struct Waiting {
  ElementKind kind;
  std::int32_t tag;
  std::size_t first;  ///< in the list of all corners
};

class Reader {
 public:
  Reader(const std::filesystem::path& file, const Progress& progress)
      : source_(file), progress_(progress), builder_(source_), numbers_(source_, false) {}

  mesh::MeshData read(std::string name) {
    if (source_.size() == 0) source_.fail("the file is empty", ErrorCode::file_truncated);
    read_head();
    while (next_word()) {
      const std::string section(source_.word());
      source_.enter(section, true);
      if (section == "dimension")
        read_dimension();
      else if ((section == "elements" || section == "boundary") && !builder_.has_nodes())
        read_elements(section == "elements" ? 3 : 2);
      else if (section == "attribute_sets" || section == "bdr_attribute_sets")
        read_sets(section == "attribute_sets" ? 3 : 2);
      else if (section == "vertices")
        read_vertices();
      else if (section == "nodes")
        source_.fail("curved meshes, whose nodes are a grid function, are not read; save the mesh without them");
      else if (section.starts_with("mfem_"))  // the end of the serial mesh
        break;
      else
        source_.fail("this section is not known here; dimension, elements, boundary, vertices and attribute sets are read");
    }
    source_.enter("", true);
    if (!builder_.has_nodes()) source_.fail("the file ends without vertices", ErrorCode::file_truncated);
    std::int64_t number = 1;
    for (const Waiting& element : waiting_)
      builder_.add_element(element.kind, number++, element.tag,
                           std::span(corners_).subspan(element.first, static_cast<std::size_t>(mesh::nodes_of(element.kind))));
    return builder_.take(std::move(name));
  }

 private:
  void read_head() {
    const std::string head(source_.line());
    const std::string_view start = "MFEM mesh v";
    for (const std::string_view kind : {"NURBS", "NC", "INLINE"})
      if (head.starts_with(fmt::format("MFEM {} mesh", kind)))
        source_.fail(
            fmt::format("MFEM meshes of the kind {} are not read, only plain ones; let MFEM save it as a plain mesh", kind));
    if (!head.starts_with(start)) source_.fail("this is no MFEM mesh: it does not start with 'MFEM mesh v1.0'");
    std::string version = head.substr(start.size());
    while (!version.empty() && (version.back() == ' ' || version.back() == '\r')) version.pop_back();
    if (version != "1.0" && version != "1.2" && version != "1.3")
      source_.fail(fmt::format("MFEM mesh version '{}' is not read, only 1.0, 1.2 and 1.3", version.substr(0, 20)));
  }

  /// Comments run from '#' to the end of the line.
  bool next_word() {
    while (source_.skip_blanks()) {
      if (source_.peek() != '#') return true;
      static_cast<void>(source_.line());
    }
    return false;
  }

  void read_dimension() {
    if (const std::int32_t dimension = numbers_.integer(); dimension != 3)
      source_.fail(fmt::format("the mesh has dimension {}; only 3 is read", dimension));
  }

  void read_elements(int dimension) {
    const std::int64_t count = numbers_.count(8, 8, "elements");
    for (std::int64_t i = 0; i < count; ++i) {
      const std::int32_t tag = numbers_.integer(), geometry = numbers_.integer();
      const std::optional<ElementKind> kind = kind_of(geometry);
      if (!kind || mesh::dimension_of(*kind) != dimension)
        source_.fail(fmt::format("geometry {} is none of an element of dimension {}", geometry, dimension));
      if (tag < 1) source_.fail(fmt::format("attribute {}; attributes are numbered from 1", tag));
      waiting_.push_back({*kind, tag, corners_.size()});
      for (int k = 0; k < mesh::nodes_of(*kind); ++k) corners_.push_back(numbers_.size());
      tick();
    }
  }

  void read_sets(int dimension) {
    const std::int64_t count = numbers_.count(5, 5, "attribute sets");
    static_cast<void>(source_.line());
    for (std::int64_t i = 0; i < count; ++i) {
      if (!next_word()) break;
      const std::string line(source_.line());
      const std::size_t first = line.find('"'), last = line.rfind('"');
      if (first == std::string::npos || last == first) source_.fail("the name of an attribute set needs double quotes");
      std::int64_t size = 0;
      std::int32_t tag = 0;
      const char *at = line.data() + last + 1, *end = line.data() + line.size();
      const auto number = [&](auto& into) {
        while (at < end && *at == ' ') ++at;
        const auto [stop, error] = std::from_chars(at, end, into);
        if (error != std::errc()) source_.fail("an attribute set needs its size and its attributes behind the name");
        at = stop;
      };
      number(size);
      if (size < 1) continue;
      number(tag);
      if (size == 1 && tag > 0) builder_.add_name(dimension, tag, line.substr(first + 1, last - first - 1));
    }
  }

  void read_vertices() {
    if (builder_.has_nodes()) source_.fail("the file has two sections of vertices");
    const std::int64_t count = numbers_.count(6, 6, "vertices");
    if (next_word() && source_.peek() == 'n')
      source_.fail("curved meshes, whose nodes are a grid function, are not read; save the mesh without them");
    if (const std::int32_t dimension = numbers_.integer(); dimension != 3)
      source_.fail(fmt::format("vertices have {} coordinates; only 3 are read", dimension));
    builder_.reserve_nodes(count);
    for (std::int64_t i = 0; i < count; ++i) {
      const double x = numbers_.real(), y = numbers_.real(), z = numbers_.real();
      builder_.add_node(i + 1, {x, y, z});
      tick();
    }
    builder_.finish_nodes();
    for (std::int64_t& corner : corners_) {
      if (corner < 0 || corner >= count) source_.fail(fmt::format("an element names vertex {}; there are {}", corner, count));
      ++corner;  // numbers of MeshBuilder start at 1
    }
  }

  void tick() {
    if (++ticks_ % items_per_report == 0)
      progress_.at("read", static_cast<double>(source_.offset()) / static_cast<double>(source_.size()));
  }

  syntax::ByteSource source_;
  const Progress& progress_;
  MeshBuilder builder_;
  syntax::Numbers numbers_;
  std::vector<Waiting> waiting_;
  std::vector<std::int64_t> corners_;
  std::int64_t ticks_ = 0;
};

}  // namespace

mesh::MeshData read_mfem(const std::filesystem::path& file, const Progress& progress) {
  progress.check();
  return Reader(file, progress).read(file.string());
}

}  // namespace pcbmesh::formats::mfem
