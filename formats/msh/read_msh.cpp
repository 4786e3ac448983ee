// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/msh/read_msh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/mesh_builder/mesh_builder.hpp"
#include "formats/msh/periodic.hpp"
#include "formats/syntax/byte_source.hpp"

namespace pcbmesh::formats::msh {
namespace {

using mesh::ElementKind;
using syntax::ByteSource;
using syntax::Numbers;

constexpr std::int64_t items_per_report = 1 << 16;
constexpr std::size_t most_nodes = 18;

/// What a type number of the format means. Points and lines have no kind: they are counted alone.
struct ElementType {
  std::int32_t number = 0;
  int dimension = 0;
  int num_nodes = 0;
  std::optional<ElementKind> kind{};
};

constexpr ElementType solid(std::int32_t number, ElementKind kind) {
  return {number, mesh::dimension_of(kind), mesh::nodes_of(kind), kind};
}

constexpr std::array element_types{
    ElementType{15, 0, 1},
    ElementType{1, 1, 2},
    ElementType{8, 1, 3},
    solid(2, ElementKind::triangle),
    solid(3, ElementKind::quadrangle),
    solid(4, ElementKind::tetrahedron),
    solid(5, ElementKind::hexahedron),
    solid(6, ElementKind::wedge),
    solid(7, ElementKind::pyramid),
    solid(9, ElementKind::triangle6),
    solid(10, ElementKind::quadrangle9),
    solid(11, ElementKind::tetrahedron10),
    solid(13, ElementKind::wedge18),
    solid(16, ElementKind::quadrangle8),
    solid(18, ElementKind::wedge15),
};

class Reader {
 public:
  Reader(const std::filesystem::path& file, const Progress& progress)
      : source_(file), progress_(progress), builder_(source_), numbers_(source_, false) {}
  mesh::MeshData read(std::string source_name);

 private:
  void read_format();
  void read_names();
  void read_entities();
  void read_entity(int dimension);
  void read_nodes_22();
  void read_nodes_41();
  void read_node_block_41();
  void read_elements_22_text(std::int64_t count);
  void read_elements_22_binary(std::int64_t count);
  void read_elements_22();
  void read_elements_41();
  std::int64_t read_element_block_41(std::int64_t most);
  [[nodiscard]] ElementType type_of(std::int32_t number) const;
  void add_element(const ElementType& type, std::int64_t number, std::int32_t tag, std::int32_t entity,
                   std::span<const std::int64_t> nodes) {
    if (!type.kind) {
      builder_.add_other(type.dimension, tag);
    } else if (const bool is_in = builder_.add_element(*type.kind, number, tag, nodes); type.dimension == 2) {
      faces_.add(*type.kind, entity, is_in ? builder_.num_faces(*type.kind) - 1 : -1, nodes);
    }
    tick();
  }
  [[nodiscard]] std::int32_t tag_of_entity(std::int32_t dimension, std::int32_t tag) const;
  void end_section(std::string_view name);
  void tick() {
    if (++ticks_ % items_per_report == 0)
      progress_.at("read",
                   static_cast<double>(source_.offset()) / static_cast<double>(std::max<std::int64_t>(source_.size(), 1)));
  }

  ByteSource source_;
  const Progress& progress_;
  MeshBuilder builder_;
  Numbers numbers_;
  bool is_41_ = false, binary_ = false, has_format_ = false, has_elements_ = false;
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> entities_;  ///< (dimension, tag) -> physical tag or 0
  std::vector<std::int64_t> node_tags_;
  SurfaceFaces faces_;
  std::vector<SurfaceLink> links_;
  std::int64_t ticks_ = 0;
};

mesh::MeshData Reader::read(std::string source_name) {
  if (source_.size() == 0) source_.fail("the file is empty", ErrorCode::file_truncated);
  while (source_.skip_blanks()) {
    source_.enter("", !binary_);
    const std::string section(source_.line());
    std::string_view name = section;
    while (name.ends_with(' ')) name.remove_suffix(1);
    if (!has_format_ && name != "$MeshFormat" && name != "$Comments")
      source_.fail(name == "$NOD" ? "MSH version 1 is not read; convert it with Gmsh to 4.1 or 2.2"
                                  : "this is no MSH file: it does not start with $MeshFormat");
    if (!name.starts_with('$') || name.size() < 2) source_.fail("a section that starts with '$' was expected");
    source_.enter(std::string(name), !binary_ || name == "$PhysicalNames" || name == "$MeshFormat");
    if (name == "$MeshFormat") {
      read_format();
    } else if (name == "$PhysicalNames") {
      read_names();
    } else if (name == "$Entities" && is_41_) {
      read_entities();
    } else if (name == "$Nodes") {
      is_41_ ? read_nodes_41() : read_nodes_22();
      builder_.finish_nodes();
    } else if (name == "$Elements") {
      if (!builder_.has_nodes()) source_.fail("elements come before nodes");
      if (std::exchange(has_elements_, true)) source_.fail("the file has two sections of elements");
      is_41_ ? read_elements_41() : read_elements_22();
      builder_.finish_elements();
    } else if (name == "$PartitionedEntities") {
      source_.fail("partitioned meshes are not read; write the mesh in one piece");
    } else if (name == "$Periodic") {
      if (!is_41_) source_.enter("$Periodic", true);
      links_ = read_periodic(source_, is_41_ ? numbers_ : Numbers(source_, false), is_41_);
    } else {  // $NodeData, ...: nothing that changes the mesh
      source_.skip_past("$End" + std::string(name.substr(1)));
      continue;
    }
    end_section(name);
  }
  source_.enter("", !binary_);
  if (!builder_.has_nodes() || !has_elements_)
    source_.fail(fmt::format("the file ends without {}", builder_.has_nodes() ? "$Elements" : "$Nodes"),
                 ErrorCode::file_truncated);
  builder_.set_periodic(resolve(links_, faces_, builder_));
  return builder_.take(std::move(source_name));
}

void Reader::end_section(std::string_view name) {
  const std::string expected = "$End" + std::string(name.substr(1));
  if (source_.word() != expected) source_.fail(fmt::format("{} was expected here; a count above it is wrong", expected));
}

ElementType Reader::type_of(std::int32_t number) const {
  const auto found = std::ranges::find(element_types, number, &ElementType::number);
  if (found != element_types.end()) return *found;
  if (number < 8 || number > 140) source_.fail(fmt::format("there is no element type {}", number));
  source_.fail(
      fmt::format("element type {} is not read; of second order these are: triangles of 6 nodes, quadrangles of 8 or 9, "
                  "tetrahedra of 10, prisms of 15 or 18. Write the mesh with order 1 or as one of these",
                  number));
}

void Reader::read_format() {
  if (std::exchange(has_format_, true)) source_.fail("the file has two headers");
  const std::string version(source_.word());
  // Netgen writes "2.000000": the number counts, not its spelling.
  double number = 0;
  const auto parsed = std::from_chars(version.data(), version.data() + version.size(), number);
  const bool is_number = parsed.ec == std::errc() && parsed.ptr == version.data() + version.size();
  is_41_ = is_number && number == 4.1;
  if (!is_41_ && !(is_number && number >= 2 && number <= 2.2))
    source_.fail(fmt::format("MSH version '{}' is not read, only 4.1 and 2.2; convert it with Gmsh", version.substr(0, 20)));
  const std::int32_t kind = numbers_.integer(), data_size = numbers_.integer();
  if (kind != 0 && kind != 1) source_.fail(fmt::format("file type {} is neither 0 (text) nor 1 (binary)", kind));
  if (data_size != 8) source_.fail(fmt::format("numbers of {} bytes are not read, only of 8", data_size));
  source_.end_line();
  builder_.set_format(is_41_ ? "4.1" : fmt::format("{:.1f}", number), kind == 1);
  if (kind == 0) return;
  binary_ = true;
  numbers_ = Numbers(source_, true);
  const auto one = source_.raw<std::int32_t>();
  if (one == 0x01000000)
    source_.fail("the file is big-endian and only little-endian files are read; convert it with Gmsh on this machine");
  if (one != 1) source_.fail("the mark of the byte order is neither big- nor little-endian");
}

void Reader::read_names() {
  Numbers words(source_, false);
  const std::int64_t count = words.count(6, 6, "physical names");
  for (std::int64_t i = 0; i < count; ++i) {
    const std::int32_t dimension = words.integer(), tag = words.integer();
    const std::string_view rest = source_.line();
    const std::size_t first = rest.find('"'), last = rest.rfind('"');
    if (first == std::string_view::npos || last == first) source_.fail("a physical name needs double quotes");
    builder_.add_name(dimension, tag, std::string(rest.substr(first + 1, last - first - 1)));
  }
}

void Reader::read_entities() {
  std::array<std::int64_t, 4> counts{};
  for (std::int64_t& count : counts) count = numbers_.count(36, 10, "entities");
  for (int dimension = 0; dimension < 4; ++dimension)
    for (std::int64_t i = 0; i < counts[static_cast<std::size_t>(dimension)]; ++i) read_entity(dimension);
}

void Reader::read_entity(int dimension) {
  const std::int32_t tag = numbers_.integer();
  const int num_reals = dimension == 0 ? 3 : 6;
  for (int i = 0; i < num_reals; ++i) static_cast<void>(numbers_.real());
  std::int32_t group = 0;
  const std::int64_t num_groups = numbers_.count(4, 2, "physical groups");
  for (std::int64_t i = 0; i < num_groups; ++i) {
    const std::int32_t one = numbers_.integer();
    if (i == 0) group = one;
  }
  const std::int64_t num_bounding = dimension == 0 ? 0 : numbers_.count(4, 2, "bounding entities");
  for (std::int64_t i = 0; i < num_bounding; ++i) static_cast<void>(numbers_.integer());
  if (!entities_.emplace(std::pair(dimension, tag), group).second)
    source_.fail(fmt::format("entity {} of dimension {} is given twice", tag, dimension));
}

std::int32_t Reader::tag_of_entity(std::int32_t dimension, std::int32_t tag) const {
  const auto found = entities_.find({dimension, tag});
  if (found == entities_.end())
    source_.fail(fmt::format("elements belong to entity {} of dimension {}, which $Entities does not list", tag, dimension));
  return found->second;
}

void Reader::read_nodes_22() {
  Numbers words(source_, false);
  const std::int64_t count = numbers_.justified(words.size(), 28, 8, "nodes");
  source_.end_line();
  builder_.reserve_nodes(count);
  for (std::int64_t i = 0; i < count; ++i) {
    const std::int64_t number = binary_ ? numbers_.integer() : numbers_.size();
    const double x = numbers_.real(), y = numbers_.real(), z = numbers_.real();
    builder_.add_node(number, {x, y, z});
    tick();
  }
}

void Reader::read_nodes_41() {
  const std::int64_t num_blocks = numbers_.count(20, 8, "blocks of nodes");
  const std::int64_t num_nodes = numbers_.count(32, 8, "nodes");
  const std::int64_t least = numbers_.size(), greatest = numbers_.size();
  builder_.reserve_nodes(num_nodes);
  std::int64_t found = 0;
  for (std::int64_t block = 0; block < num_blocks; ++block) {
    read_node_block_41();
    found += static_cast<std::int64_t>(node_tags_.size());
    for (const std::int64_t tag : node_tags_)
      if (tag < least || tag > greatest)
        source_.fail(fmt::format("node {} is outside the announced range {} to {}", tag, least, greatest));
  }
  if (found != num_nodes) source_.fail(fmt::format("{} nodes are announced, but the blocks hold {}", num_nodes, found));
}

void Reader::read_node_block_41() {
  const std::int32_t dimension = numbers_.integer();
  static_cast<void>(numbers_.integer());  // entity: which one holds a node changes nothing here
  const std::int32_t parametric = numbers_.integer();
  if (dimension < 0 || dimension > 3 || (parametric != 0 && parametric != 1))
    source_.fail(fmt::format("a block of nodes has dimension {} and parametric flag {}", dimension, parametric));
  const int num_parameters = parametric == 1 ? dimension : 0;
  const std::int64_t count = numbers_.count(32 + 8 * num_parameters, 8 + 2 * num_parameters, "nodes of a block");
  node_tags_.resize(static_cast<std::size_t>(count));
  for (std::int64_t& tag : node_tags_) {
    tag = numbers_.size();
    tick();
  }
  for (const std::int64_t tag : node_tags_) {
    const double x = numbers_.real(), y = numbers_.real(), z = numbers_.real();
    for (int i = 0; i < num_parameters; ++i) static_cast<void>(numbers_.real());
    builder_.add_node(tag, {x, y, z});
    tick();
  }
}

void Reader::read_elements_22() {
  Numbers words(source_, false);
  const std::int64_t count = numbers_.justified(words.size(), 8, 6, "elements");
  source_.end_line();
  binary_ ? read_elements_22_binary(count) : read_elements_22_text(count);
}

void Reader::read_elements_22_text(std::int64_t count) {
  std::array<std::int64_t, most_nodes> nodes{};
  for (std::int64_t i = 0; i < count; ++i) {
    const std::int64_t number = numbers_.size();
    const ElementType type = type_of(numbers_.integer());
    const std::int64_t num_tags = numbers_.count(4, 2, "tags of an element");
    std::int32_t tag = 0, entity = 0;
    for (std::int64_t j = 0; j < num_tags; ++j) {
      const std::int32_t one = numbers_.integer();
      if (j < 2) (j == 0 ? tag : entity) = one;
    }
    const auto corners = std::span(nodes).first(static_cast<std::size_t>(type.num_nodes));
    for (std::int64_t& node : corners) node = numbers_.size();
    add_element(type, number, tag, entity, corners);
  }
}

void Reader::read_elements_22_binary(std::int64_t count) {
  std::array<std::int64_t, most_nodes> nodes{};
  for (std::int64_t done = 0; done < count;) {
    const ElementType type = type_of(numbers_.integer());
    const std::int32_t block = numbers_.integer(), num_tags = numbers_.integer();
    if (block <= 0 || block > count - done)
      source_.fail(fmt::format("a block announces {} elements where {} are left", block, count - done));
    if (num_tags < 0) source_.fail(fmt::format("elements with {} tags", num_tags));
    const std::int64_t row = 4 * (std::int64_t{1} + num_tags + type.num_nodes);
    static_cast<void>(numbers_.justified(block, row, row, "elements of a block"));
    if (type.kind) builder_.reserve(*type.kind, block);
    const auto corners = std::span(nodes).first(static_cast<std::size_t>(type.num_nodes));
    for (std::int32_t i = 0; i < block; ++i) {
      const std::int32_t number = numbers_.integer();
      std::int32_t tag = 0, entity = 0;
      for (std::int32_t j = 0; j < num_tags; ++j) {
        const std::int32_t one = numbers_.integer();
        if (j < 2) (j == 0 ? tag : entity) = one;
      }
      for (std::int64_t& node : corners) node = numbers_.integer();
      add_element(type, number, tag, entity, corners);
    }
    done += block;
  }
}

void Reader::read_elements_41() {
  const std::int64_t num_blocks = numbers_.count(20, 8, "blocks of elements");
  const std::int64_t num_elements = numbers_.count(16, 4, "elements");
  static_cast<void>(numbers_.size());  // least and greatest tag: elements are told apart by their place
  static_cast<void>(numbers_.size());
  std::int64_t found = 0;
  for (std::int64_t block = 0; block < num_blocks; ++block) found += read_element_block_41(num_elements - found);
  if (found != num_elements)
    source_.fail(fmt::format("{} elements are announced, but the blocks hold {}", num_elements, found));
}

std::int64_t Reader::read_element_block_41(std::int64_t most) {
  const std::int32_t dimension = numbers_.integer(), entity = numbers_.integer();
  const ElementType type = type_of(numbers_.integer());
  if (type.dimension != dimension)
    source_.fail(fmt::format("elements of type {} stand in a block of dimension {}", type.number, dimension));
  const std::int32_t tag = tag_of_entity(dimension, entity);
  const std::int64_t count = numbers_.count(8 * (1 + type.num_nodes), 2 * (1 + type.num_nodes), "elements of a block");
  if (count > most) source_.fail(fmt::format("a block announces {} elements where {} are left", count, most));
  if (type.kind) builder_.reserve(*type.kind, count);
  std::array<std::int64_t, most_nodes> nodes{};
  const auto corners = std::span(nodes).first(static_cast<std::size_t>(type.num_nodes));
  for (std::int64_t i = 0; i < count; ++i) {
    const std::int64_t number = numbers_.size();
    for (std::int64_t& node : corners) node = numbers_.size();
    add_element(type, number, tag, entity, corners);
  }
  return count;
}

}  // namespace

mesh::MeshData read_msh(const std::filesystem::path& file, const Progress& progress) {
  progress.check();
  return Reader(file, progress).read(file.string());
}

}  // namespace pcbmesh::formats::msh
