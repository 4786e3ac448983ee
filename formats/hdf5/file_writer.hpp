// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "formats/hdf5/number_type.hpp"
#include "formats/sink/array_sink.hpp"

namespace pcbmesh::formats::hdf5 {

struct WriterOptions {
  std::uint64_t expected_bytes = 0;  ///< as for FileSink
  bool packed = false;               ///< large data sets in chunks, shuffled and deflated
  int num_threads = 1;               ///< that pack; the bytes are the same for any number
};

/// An HDF5 file that appears whole or not at all (K1, K2), without times: the same content gives the same bytes.
///
/// Data sets are contiguous, or chunked where packed. They are streamed: several may be open at a time. Paths are absolute,
/// "/group/name"; groups are made as needed.
class FileWriter {
 public:
  /// @throws Error write_failed (701), format_not_built (702).
  FileWriter(const std::filesystem::path& target, const WriterOptions& options);
  ~FileWriter();
  FileWriter(const FileWriter&) = delete;
  FileWriter& operator=(const FileWriter&) = delete;

  void make_group(const std::string& path);
  /// A second name for a data set.
  void link(const std::string& existing, const std::string& added);
  /// Text of fixed length, ASCII.
  void put_attribute(const std::string& object, const std::string& name, std::string_view text);
  void put_attribute(const std::string& object, const std::string& name, std::span<const std::int64_t> values);
  void put_attribute(const std::string& object, const std::string& name, double value);
  /// Texts of one fixed length, UTF-8: no heap of the library wastes 4 kB on them.
  void put_strings(const std::string& path, std::span<const std::string> texts);
  /// Texts of variable length whose bytes are declared ASCII, whatever they are: VTK's reader converts to no other type, and
  /// the library converts neither from fixed length nor from UTF-8.
  void put_strings_for_vtk(const std::string& path, std::span<const std::string> texts);
  /// A small data set at once, of one dimension or, with columns, of two.
  template <class Value>
  void put(const std::string& path, std::span<const Value> values, std::int64_t num_columns = 0) {
    const auto size = static_cast<std::int64_t>(values.size());
    const auto out = begin(path, number_type<Value>(), num_columns > 0 ? size / num_columns : size, num_columns);
    for (const Value value : values) out->put(value);
    out->finish();
  }
  /// A data set that is filled by the caller, row by row, and done with finish(). It must not outlive the writer.
  /// @param num_columns  0: one dimension.
  [[nodiscard]] std::unique_ptr<ArraySink> begin(const std::string& path, NumberType type, std::int64_t num_rows,
                                                 std::int64_t num_columns = 0);
  /// As PartFile::save().
  void save();
  /// Makes the file appear. @throws Error write_failed (701).
  void commit();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pcbmesh::formats::hdf5
