// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/sink/array_sink.hpp"
#include "formats/sink/file_sink.hpp"
#include "formats/vtu/write_vtu.hpp"
#include "pcbmesh/formats/registry.hpp"

namespace pcbmesh::formats::vtu {

/// Bytes as base64 text, taken in pieces of any size.
class Base64 {
 public:
  explicit Base64(FileSink& sink) : sink_(sink) {}
  void put(std::span<const char> bytes);
  /// The last characters with their padding.
  void finish();
  [[nodiscard]] static std::string text_of(std::span<const char> bytes);

 private:
  FileSink& sink_;
  std::array<char, 3> rest_{};
  std::size_t num_rest_ = 0;
};

/// Fills an array of the file through the sink it is given.
using FillArray = std::function<void(ArraySink& out)>;

/// Values of one array where the format wants them: as text or base64 between its tags, or as bytes of the appended section;
/// packed in blocks on request.
class ArrayWriter {
 public:
  ArrayWriter(FileSink& sink, const WriteMeshOptions& options) : sink_(sink), options_(options) {}
  void put_text(const ArrayHead& head, const FillArray& fill);
  void put_base64(const ArrayHead& head, const FillArray& fill);
  void put_appended(const ArrayHead& head, const FillArray& fill);

 private:
  /// Sizes of the packed blocks, in front of which they stand.
  using BlockSizes = std::vector<std::uint64_t>;
  void put_packed(const ArrayHead& head, const FillArray& fill, const std::function<void(std::span<const char>)>& take,
                  BlockSizes& sizes);
  [[nodiscard]] static BlockSizes sizes_for(const ArrayHead& head);

  FileSink& sink_;
  const WriteMeshOptions& options_;
};

}  // namespace pcbmesh::formats::vtu
