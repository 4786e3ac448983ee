// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "formats/syntax/xml_tree.hpp"
#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats::vtu {

/// Reads the arrays of one VTK XML file.
class ArrayReader {
 public:
  /// @param bytes  the whole file. @throws Error file_syntax (202) for what is no unstructured grid, or big-endian.
  ArrayReader(std::string_view bytes, const syntax::XmlTree& tree, std::filesystem::path file);

  /// Values of a DataArray, converted. Exactly `expected` of them. @throws Error file_syntax (202), file_truncated (205).
  [[nodiscard]] std::vector<std::int64_t> integers(const syntax::XmlElement& array, std::int64_t expected) const;
  [[nodiscard]] std::vector<double> reals(const syntax::XmlElement& array, std::int64_t expected) const;
  [[noreturn]] void fail(const syntax::XmlElement& where, std::string text, ErrorCode code = ErrorCode::file_syntax) const;

 private:
  template <class Value>
  [[nodiscard]] std::vector<Value> values(const syntax::XmlElement& array, std::int64_t expected) const;
  template <class Value>
  [[nodiscard]] std::vector<Value> text_values(const syntax::XmlElement& array, std::int64_t expected) const;
  [[nodiscard]] std::string bytes_of(const syntax::XmlElement& array, std::size_t expected) const;
  [[nodiscard]] std::string decode_raw(const syntax::XmlElement& array, std::string_view rest, std::size_t expected) const;
  [[nodiscard]] std::string decode_base64(const syntax::XmlElement& array, std::string_view rest, std::size_t expected) const;
  /// Sizes of packed blocks behind a header, which is checked against `expected` bytes and what is left of the file.
  struct Blocks {
    std::size_t block_bytes = 0, last_bytes = 0;
    std::vector<std::size_t> packed;
  };
  [[nodiscard]] Blocks blocks_of(const syntax::XmlElement& array, std::string_view head, std::size_t expected) const;
  [[nodiscard]] std::string unpack(const syntax::XmlElement& array, const Blocks& blocks, std::string_view packed,
                                   std::size_t expected) const;
  [[nodiscard]] std::uint64_t header_number(std::string_view bytes, std::size_t index) const;

  std::string_view bytes_, appended_;
  std::filesystem::path file_;
  std::size_t header_bytes_ = 4;
  std::string compressor_;
  bool appended_is_raw_ = true;
};

}  // namespace pcbmesh::formats::vtu
