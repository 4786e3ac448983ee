// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/exodus/classic_file.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats::exodus {
namespace {

template <class T>
std::string big_endian(T value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

std::int64_t padded(std::int64_t bytes) {
  return (bytes + 3) / 4 * 4;
}

void append_integer(std::string& out, std::int64_t value) {
  out += big_endian(static_cast<std::int32_t>(value));
}

/// Length, bytes, zeros up to a multiple of four.
void append_name(std::string& out, std::string_view name) {
  append_integer(out, static_cast<std::int64_t>(name.size()));
  out += name;
  out.append(static_cast<std::size_t>(padded(static_cast<std::int64_t>(name.size()))) - name.size(), '\0');
}

/// Tag and number of a list; two zeros for an empty one.
void append_list(std::string& out, std::int32_t tag, std::size_t count) {
  append_integer(out, count == 0 ? 0 : tag);
  append_integer(out, static_cast<std::int64_t>(count));
}

constexpr std::int32_t list_of_dimensions = 10, list_of_variables = 11, list_of_attributes = 12;

}  // namespace

std::int32_t ClassicFile::add_dimension(std::string name, std::int64_t size) {
  dimensions_.push_back({std::move(name), size});
  return static_cast<std::int32_t>(dimensions_.size()) - 1;
}

void ClassicFile::add_text(std::string name, std::string value) {
  const auto size = static_cast<std::int32_t>(value.size());
  attributes_.push_back({std::move(name), ClassicType::character, std::move(value), size});
}

void ClassicFile::add_integer(std::string name, std::int32_t value) {
  attributes_.push_back({std::move(name), ClassicType::integer, big_endian(value), 1});
}

void ClassicFile::add_real(std::string name, float value) {
  attributes_.push_back({std::move(name), ClassicType::real, big_endian(value), 1});
}

std::size_t ClassicFile::add_variable(std::string name, ClassicType type, std::vector<std::int32_t> dimensions,
                                      std::string_view attribute, std::string_view text) {
  Variable variable{std::move(name), type, std::move(dimensions), {}};
  if (!attribute.empty())
    variable.attributes.push_back(
        {std::string(attribute), ClassicType::character, std::string(text), static_cast<std::int32_t>(text.size())});
  variables_.push_back(std::move(variable));
  return variables_.size() - 1;
}

std::int64_t ClassicFile::bytes_of(const Variable& variable) const {
  std::int64_t bytes = variable.type == ClassicType::character ? 1 : variable.type == ClassicType::double_real ? 8 : 4;
  bool is_record = false;
  for (const std::int32_t d : variable.dimensions) {
    const std::int64_t size = dimensions_[static_cast<std::size_t>(d)].size;
    is_record = is_record || size == 0;
    bytes *= std::max<std::int64_t>(size, 1);
  }
  return is_record ? -padded(bytes) : padded(bytes);  // negative: takes no place without records
}

std::int64_t ClassicFile::largest_variable() const {
  std::int64_t largest = 0;
  for (const Variable& variable : variables_) largest = std::max(largest, bytes_of(variable));
  return largest;
}

std::string ClassicFile::header(std::int64_t start) const {
  std::string out = "CDF\x02";
  append_integer(out, 0);  // no records
  append_list(out, list_of_dimensions, dimensions_.size());
  for (const Dimension& dimension : dimensions_) {
    append_name(out, dimension.name);
    append_integer(out, dimension.size);
  }
  const auto append_attributes = [&](const std::vector<Attribute>& attributes) {
    append_list(out, list_of_attributes, attributes.size());
    for (const Attribute& attribute : attributes) {
      append_name(out, attribute.name);
      append_integer(out, static_cast<std::int32_t>(attribute.type));
      append_integer(out, attribute.count);
      out += attribute.bytes;
      out.append(static_cast<std::size_t>(padded(static_cast<std::int64_t>(attribute.bytes.size()))) - attribute.bytes.size(),
                 '\0');
    }
  };
  append_attributes(attributes_);
  append_list(out, list_of_variables, variables_.size());
  for (const Variable& variable : variables_) {
    append_name(out, variable.name);
    append_integer(out, static_cast<std::int64_t>(variable.dimensions.size()));
    for (const std::int32_t d : variable.dimensions) append_integer(out, d);
    append_attributes(variable.attributes);
    append_integer(out, static_cast<std::int32_t>(variable.type));
    const std::int64_t bytes = bytes_of(variable);
    out += big_endian(static_cast<std::uint32_t>(std::abs(bytes)));
    out += big_endian(start);
    start += std::max<std::int64_t>(bytes, 0);
  }
  return out;
}

void ClassicFile::write_header() {
  const auto size = static_cast<std::int64_t>(header(0).size());
  sink_.put(header(size));
}

void ClassicFile::put(std::int32_t value) {
  sink_.put_raw(static_cast<std::int32_t>(__builtin_bswap32(static_cast<std::uint32_t>(value))));
  written_ += 4;
}

void ClassicFile::put(double value) {
  sink_.put_raw(__builtin_bswap64(std::bit_cast<std::uint64_t>(value)));
  written_ += 8;
}

void ClassicFile::put_text(std::string_view text, std::size_t width) {
  text = text.substr(0, width);
  sink_.put(text);
  for (std::size_t i = text.size(); i < width; ++i) sink_.put_raw('\0');
  written_ += static_cast<std::int64_t>(width);
}

void ClassicFile::end_variable() {
  const std::int64_t expected = std::max<std::int64_t>(bytes_of(variables_.at(next_++)), 0);
  while (written_ % 4 != 0) {
    sink_.put_raw('\0');
    ++written_;
  }
  PCBMESH_ASSERT(written_ == expected);
  written_ = 0;
}

}  // namespace pcbmesh::formats::exodus
