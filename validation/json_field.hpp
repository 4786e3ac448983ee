// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pcbmesh/base/error.hpp"

namespace pcbmesh::validation {

/// A JSON file and what to do if it is not as it should be, for messages.
struct JsonSource {
  std::string file, advice;
};

/// The whole file. @throws Error file_unreadable (201), file_syntax (202) with the line.
[[nodiscard]] nlohmann::json parse_json(const JsonSource& source);

/// One value of the file and the way to it, for messages: "volumes[3].num_cells".
class Field {
 public:
  Field(const nlohmann::json* value, std::string path, const JsonSource& source)
      : value_(value), path_(std::move(path)), source_(&source) {}

  [[noreturn]] void fail(std::string_view expected) const {
    throw Error(ErrorCode::file_syntax,
                fmt::format("{} must be {}; {}", path_.empty() ? "the top level" : path_, expected, source_->advice),
                Spot{.file = source_->file});
  }
  [[nodiscard]] bool is_absent() const { return value_ == nullptr || value_->is_null(); }
  [[nodiscard]] Field operator[](const char* key) const {
    if (value_ == nullptr || !value_->is_object()) fail("an object");
    const auto member = value_->find(key);
    return {member == value_->end() ? nullptr : &*member, path_.empty() ? key : path_ + "." + key, *source_};
  }
  /// Names and values of an object, ascending by name.
  [[nodiscard]] std::vector<std::pair<std::string, Field>> members() const {
    if (value_ == nullptr || !value_->is_object()) fail("an object");
    std::vector<std::pair<std::string, Field>> fields;
    for (const auto& [key, value] : value_->items()) {
      fields.emplace_back(key, Field(&value, path_.empty() ? key : path_ + "." + key, *source_));
    }
    return fields;
  }
  [[nodiscard]] bool is_object() const { return value_ != nullptr && value_->is_object(); }
  [[nodiscard]] std::vector<Field> list() const {
    if (value_ == nullptr || !value_->is_array()) fail("a list");
    std::vector<Field> fields;
    for (std::size_t i = 0; i < value_->size(); ++i)
      fields.emplace_back(&(*value_)[i], fmt::format("{}[{}]", path_, i), *source_);
    return fields;
  }
  [[nodiscard]] std::string text() const {
    if (value_ == nullptr || !value_->is_string()) fail("a text");
    return value_->get<std::string>();
  }
  [[nodiscard]] std::string text_or_empty() const { return is_absent() ? std::string() : text(); }
  [[nodiscard]] bool flag() const {
    if (value_ == nullptr || !value_->is_boolean()) fail("true or false");
    return value_->get<bool>();
  }
  [[nodiscard]] std::int64_t integer(std::int64_t low, std::int64_t high) const {
    const std::string expected = fmt::format("a whole number in {}..{}", low, high);
    if (value_ == nullptr || !value_->is_number_integer()) fail(expected);
    if (value_->is_number_unsigned() && value_->get<std::uint64_t>() > static_cast<std::uint64_t>(high)) fail(expected);
    const auto number = value_->get<std::int64_t>();
    if (number < low || number > high) fail(expected);
    return number;
  }
  [[nodiscard]] double number() const {
    if (value_ == nullptr || !value_->is_number() || !std::isfinite(value_->get<double>())) fail("a finite number");
    return value_->get<double>();
  }
  /// Absent or negative means unknown.
  [[nodiscard]] std::int64_t count_or_unknown() const {
    return is_absent() ? -1 : std::max<std::int64_t>(-1, integer(std::numeric_limits<std::int64_t>::min(), max_count));
  }
  [[nodiscard]] double measure_or_unknown() const { return is_absent() ? -1.0 : number(); }

 private:
  static constexpr std::int64_t max_count = std::numeric_limits<std::int64_t>::max();
  const nlohmann::json* value_;
  std::string path_;
  const JsonSource* source_;
};

}  // namespace pcbmesh::validation
