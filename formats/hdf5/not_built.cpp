// SPDX-License-Identifier: GPL-3.0-or-later
// What stands in for the HDF5 files in a build without the library.
#ifndef PCBMESH_HAS_HDF5

#include "formats/hdf5/file_reader.hpp"
#include "formats/hdf5/file_writer.hpp"
#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats::hdf5 {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& file) {
  throw Error(
      ErrorCode::format_not_built,
      "this build has no HDF5; configure with -DPCBMESH_WITH_HDF5=ON and libhdf5-dev installed, or choose another format",
      {.file = file.string()});
}

}  // namespace

struct FileWriter::State {};
struct FileReader::State {};

FileWriter::FileWriter(const std::filesystem::path& target, const WriterOptions&) {
  refuse(target);
}
FileWriter::~FileWriter() = default;
void FileWriter::make_group(const std::string&) {}
void FileWriter::link(const std::string&, const std::string&) {}
void FileWriter::put_attribute(const std::string&, const std::string&, std::string_view) {}
void FileWriter::put_attribute(const std::string&, const std::string&, std::span<const std::int64_t>) {}
void FileWriter::put_attribute(const std::string&, const std::string&, double) {}
void FileWriter::put_strings(const std::string&, std::span<const std::string>) {}
void FileWriter::put_strings_for_vtk(const std::string&, std::span<const std::string>) {}
std::unique_ptr<ArraySink> FileWriter::begin(const std::string&, NumberType, std::int64_t, std::int64_t) {
  return nullptr;
}
void FileWriter::save() {}
void FileWriter::commit() {}

FileReader::FileReader(const std::filesystem::path& file) {
  refuse(file);
}
FileReader::~FileReader() = default;
bool FileReader::has(const std::string&) const {
  return false;
}
std::vector<std::string> FileReader::names_in(const std::string&) const {
  return {};
}
std::vector<std::int64_t> FileReader::shape(const std::string&) const {
  return {};
}
std::vector<std::int64_t> FileReader::integers(const std::string&) const {
  return {};
}
std::vector<double> FileReader::reals(const std::string&) const {
  return {};
}
std::vector<std::string> FileReader::texts(const std::string&) const {
  return {};
}
std::optional<std::string> FileReader::text_attribute(const std::string&, const std::string&) const {
  return std::nullopt;
}
std::optional<double> FileReader::real_attribute(const std::string&, const std::string&) const {
  return std::nullopt;
}
void FileReader::fail(const std::string&, const std::string& text, ErrorCode code) const {
  throw Error(code, text);
}

}  // namespace pcbmesh::formats::hdf5

#endif
