// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "formats/sink/file_sink.hpp"

namespace pcbmesh::formats::exodus {

/// Types of netCDF's classic format.
enum class ClassicType : std::int32_t { character = 2, integer = 4, real = 5, double_real = 6 };

/// A netCDF file of the classic format with 64-bit offsets (CDF-2), written front to back. All is declared first; then the
/// values of every variable are appended in the order of declaration. Big-endian, as the format wants it. Source: NetCDF Users'
/// Guide, "The NetCDF Classic Format Specification".
class ClassicFile {
 public:
  explicit ClassicFile(FileSink& sink) : sink_(sink) {}

  /// @param size  0 = the unlimited dimension, of which there is one at most and no record is written. Returns its number.
  std::int32_t add_dimension(std::string name, std::int64_t size);
  void add_text(std::string name, std::string value);
  void add_integer(std::string name, std::int32_t value);
  void add_real(std::string name, float value);
  /// Returns the number of the variable. @param attribute  a text attribute, or empty.
  std::size_t add_variable(std::string name, ClassicType type, std::vector<std::int32_t> dimensions,
                           std::string_view attribute = {}, std::string_view text = {});

  /// Bytes of the largest variable; above most_bytes the format can't hold it.
  [[nodiscard]] std::int64_t largest_variable() const;
  static constexpr std::int64_t most_bytes = (std::int64_t{1} << 32) - 4;

  void write_header();
  /// Values of the next variable, one after the other; end_variable() pads and checks that all came.
  void put(std::int32_t value);
  void put(double value);
  void put_text(std::string_view text, std::size_t width);
  void end_variable();

 private:
  struct Dimension {
    std::string name;
    std::int64_t size;
  };
  struct Attribute {
    std::string name;
    ClassicType type;
    std::string bytes;  ///< big-endian values
    std::int32_t count;
  };
  struct Variable {
    std::string name;
    ClassicType type;
    std::vector<std::int32_t> dimensions;
    std::vector<Attribute> attributes;
  };
  [[nodiscard]] std::int64_t bytes_of(const Variable& variable) const;
  [[nodiscard]] std::string header(std::int64_t start) const;

  FileSink& sink_;
  std::vector<Dimension> dimensions_;
  std::vector<Attribute> attributes_;
  std::vector<Variable> variables_;
  std::size_t next_ = 0;
  std::int64_t written_ = 0;
};

}  // namespace pcbmesh::formats::exodus
