// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats::hdf5 {

/// Reads data sets of an HDF5 file. Sizes are compared with what the file stores before anything is allocated.
class FileReader {
 public:
  /// @throws Error file_unreadable (201), file_syntax (202), file_truncated (205), format_not_built (702).
  explicit FileReader(const std::filesystem::path& file);
  ~FileReader();
  FileReader(const FileReader&) = delete;
  FileReader& operator=(const FileReader&) = delete;

  [[nodiscard]] bool has(const std::string& path) const;
  /// Names inside a group, ascending.
  [[nodiscard]] std::vector<std::string> names_in(const std::string& group) const;
  /// Extents of a data set. @throws Error file_syntax (202).
  [[nodiscard]] std::vector<std::int64_t> shape(const std::string& path) const;
  /// All values, converted; rows one after another. @throws Error file_syntax (202).
  [[nodiscard]] std::vector<std::int64_t> integers(const std::string& path) const;
  [[nodiscard]] std::vector<double> reals(const std::string& path) const;
  [[nodiscard]] std::vector<std::string> texts(const std::string& path) const;
  /// Empty if there is none.
  [[nodiscard]] std::optional<std::string> text_attribute(const std::string& object, const std::string& name) const;
  [[nodiscard]] std::optional<double> real_attribute(const std::string& object, const std::string& name) const;
  [[noreturn]] void fail(const std::string& path, const std::string& text, ErrorCode code = ErrorCode::file_syntax) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pcbmesh::formats::hdf5
