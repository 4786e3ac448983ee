// SPDX-License-Identifier: GPL-3.0-or-later
#ifdef PCBMESH_HAS_HDF5

#include "formats/hdf5/file_reader.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>
#include <utility>

#include "formats/hdf5/handle.hpp"

namespace pcbmesh::formats::hdf5 {
namespace {

constexpr std::uint64_t most_deflated = 1100;  ///< bytes that one packed byte can become
constexpr std::uint64_t largest_text = std::uint64_t{1} << 20;

herr_t note_name(hid_t, const char* name, const H5L_info_t*, void* user) {
  static_cast<std::vector<std::string>*>(user)->emplace_back(name);
  return 0;
}

}  // namespace

struct FileReader::State {
  std::filesystem::path path;
  QuietErrors quiet;
  Handle file;
};

FileReader::FileReader(const std::filesystem::path& file) : state_(std::make_unique<State>()) {
  state_->path = file;
  std::array<char, 8> head{};
  std::ifstream in(file, std::ios::binary);
  std::error_code ignored;
  if (!in || std::filesystem::is_directory(file, ignored))
    throw Error(ErrorCode::file_unreadable, "can't be read: " + std::generic_category().message(in ? EISDIR : errno),
                {.file = file.string()});
  in.read(head.data(), head.size());
  if (in.gcount() < static_cast<std::streamsize>(head.size()))
    fail("", "the file ends within its first 8 bytes", ErrorCode::file_truncated);
  if (std::memcmp(head.data(), "\x89HDF\r\n\x1a\n", head.size()) != 0)
    throw Error(ErrorCode::file_syntax, "this is no HDF5 file: its first 8 bytes say otherwise",
                {.file = file.string(), .byte = 0});
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fclose_degree(access.id(), H5F_CLOSE_STRONG);
  state_->file = Handle(H5Fopen(file.c_str(), H5F_ACC_RDONLY, access.id()), H5Fclose);
  if (state_->file.is_valid()) return;
  const std::string why = last_failure();
  fail("", "HDF5 can't open it: " + why,
       why.find("truncated") != std::string::npos ? ErrorCode::file_truncated : ErrorCode::file_syntax);
}

FileReader::~FileReader() = default;

void FileReader::fail(const std::string& path, const std::string& text, ErrorCode code) const {
  throw Error(code, path.empty() ? text : fmt::format("{}: {}", path, text), {.file = state_->path.string()});
}

bool FileReader::has(const std::string& path) const {
  // Each part of the path must exist for the next one to be asked for.
  for (std::size_t end = path.find('/', 1);; end = path.find('/', end + 1)) {
    if (H5Lexists(state_->file.id(), path.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
    if (end == std::string::npos) return true;
  }
}

std::vector<std::string> FileReader::names_in(const std::string& group) const {
  std::vector<std::string> out;
  if (!has(group)) return out;
  hsize_t at = 0;
  if (H5Literate_by_name(state_->file.id(), group.c_str(), H5_INDEX_NAME, H5_ITER_INC, &at, note_name, &out, H5P_DEFAULT) < 0)
    fail(group, "can't be listed: " + last_failure());
  return out;
}

namespace {

struct Opened {
  Handle dataset, space, type;
  std::vector<std::int64_t> shape;
  std::uint64_t num_values = 1;
};

Opened open_dataset(const FileReader& reader, hid_t file, const std::string& path) {
  if (!reader.has(path)) reader.fail(path, "is not in the file");
  Opened out;
  out.dataset = Handle(H5Dopen2(file, path.c_str(), H5P_DEFAULT), H5Dclose);
  if (!out.dataset.is_valid()) reader.fail(path, "can't be opened: " + last_failure());
  out.space = Handle(H5Dget_space(out.dataset.id()), H5Sclose);
  out.type = Handle(H5Dget_type(out.dataset.id()), H5Tclose);
  const int rank = out.space.is_valid() ? H5Sget_simple_extent_ndims(out.space.id()) : -1;
  if (!out.type.is_valid() || rank < 0 || rank > 8) reader.fail(path, "has no sensible shape");
  std::array<hsize_t, 8> size{};
  H5Sget_simple_extent_dims(out.space.id(), size.data(), nullptr);
  for (int i = 0; i < rank; ++i) {
    const hsize_t extent = size[static_cast<std::size_t>(i)];
    if (extent > (std::uint64_t{1} << 40) || out.num_values > (std::uint64_t{1} << 40))
      reader.fail(path, fmt::format("announces an extent of {}", extent));
    out.shape.push_back(static_cast<std::int64_t>(extent));
    out.num_values *= extent;
  }
  const std::uint64_t stored = H5Dget_storage_size(out.dataset.id());
  const std::uint64_t needed = out.num_values * H5Tget_size(out.type.id());
  const Handle create(H5Dget_create_plist(out.dataset.id()), H5Pclose);
  const bool is_packed = H5Pget_nfilters(create.id()) > 0;
  if (needed > (is_packed ? (stored + 64) * most_deflated : stored))
    reader.fail(path,
                fmt::format("announces {} values, more than the {} bytes it has in the file can hold", out.num_values, stored),
                ErrorCode::file_truncated);
  return out;
}

template <class Value>
std::vector<Value> read_numbers(const FileReader& reader, hid_t file, const std::string& path, hid_t memory_type) {
  const Opened opened = open_dataset(reader, file, path);
  const H5T_class_t kind = H5Tget_class(opened.type.id());
  if (kind != H5T_INTEGER && (kind != H5T_FLOAT || std::is_integral_v<Value>))
    reader.fail(path, std::is_integral_v<Value> ? "holds no integers" : "holds no numbers");
  std::vector<Value> out(opened.num_values);
  if (!out.empty() && H5Dread(opened.dataset.id(), memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, out.data()) < 0)
    reader.fail(path, "can't be read: " + last_failure());
  return out;
}

}  // namespace

std::vector<std::int64_t> FileReader::shape(const std::string& path) const {
  return open_dataset(*this, state_->file.id(), path).shape;
}

std::vector<std::int64_t> FileReader::integers(const std::string& path) const {
  return read_numbers<std::int64_t>(*this, state_->file.id(), path, H5T_NATIVE_INT64);
}

std::vector<double> FileReader::reals(const std::string& path) const {
  return read_numbers<double>(*this, state_->file.id(), path, H5T_NATIVE_DOUBLE);
}

std::vector<std::string> FileReader::texts(const std::string& path) const {
  const Opened opened = open_dataset(*this, state_->file.id(), path);
  if (H5Tget_class(opened.type.id()) != H5T_STRING) fail(path, "holds no text");
  std::vector<std::string> out;
  if (opened.num_values == 0) return out;
  if (H5Tis_variable_str(opened.type.id()) > 0) {
    const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type.id(), H5T_VARIABLE);
    H5Tset_cset(type.id(), H5Tget_cset(opened.type.id()));
    std::vector<char*> pointers(opened.num_values, nullptr);
    if (H5Dread(opened.dataset.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, pointers.data()) < 0)
      fail(path, "can't be read: " + last_failure());
    for (const char* text : pointers) out.emplace_back(text == nullptr ? "" : text);
    H5Dvlen_reclaim(type.id(), opened.space.id(), H5P_DEFAULT, pointers.data());
    return out;
  }
  const std::size_t width = H5Tget_size(opened.type.id());
  std::vector<char> bytes(opened.num_values * width);
  if (H5Dread(opened.dataset.id(), opened.type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()) < 0)
    fail(path, "can't be read: " + last_failure());
  for (std::size_t at = 0; at < bytes.size(); at += width)
    out.emplace_back(bytes.data() + at, ::strnlen(bytes.data() + at, width));
  return out;
}

std::optional<std::string> FileReader::text_attribute(const std::string& object, const std::string& name) const {
  const Handle attribute(H5Aopen_by_name(state_->file.id(), object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  if (!attribute.is_valid()) return std::nullopt;
  const Handle type(H5Aget_type(attribute.id()), H5Tclose);
  if (H5Tget_class(type.id()) != H5T_STRING || H5Tis_variable_str(type.id()) > 0) return std::nullopt;
  const std::size_t width = H5Tget_size(type.id());
  if (width > largest_text) return std::nullopt;
  std::string text(width, '\0');
  if (H5Aread(attribute.id(), type.id(), text.data()) < 0) return std::nullopt;
  text.resize(::strnlen(text.data(), width));
  return text;
}

std::optional<double> FileReader::real_attribute(const std::string& object, const std::string& name) const {
  const Handle attribute(H5Aopen_by_name(state_->file.id(), object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  if (!attribute.is_valid()) return std::nullopt;
  const Handle space(H5Aget_space(attribute.id()), H5Sclose);
  double value = 0;
  if (H5Sget_simple_extent_npoints(space.id()) != 1 || H5Aread(attribute.id(), H5T_NATIVE_DOUBLE, &value) < 0)
    return std::nullopt;
  return value;
}

}  // namespace pcbmesh::formats::hdf5

#endif
