// SPDX-License-Identifier: GPL-3.0-or-later
#ifdef PCBMESH_HAS_HDF5

#include "formats/hdf5/file_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "formats/hdf5/handle.hpp"
#include "formats/hdf5/part_driver.hpp"
#include "formats/sink/block_press.hpp"
#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats::hdf5 {
namespace {

constexpr std::size_t chunk_bytes = std::size_t{1} << 19, contiguous_block = std::size_t{1} << 18;
constexpr std::size_t least_packed = std::size_t{1} << 14;  // below, the chunk's own entries take more than packing saves
constexpr int deflate_level = 1;

hid_t file_type(NumberType type) {
  switch (type) {
    case NumberType::uint8:
      return H5T_STD_U8LE;
    case NumberType::uint16:
      return H5T_STD_U16LE;
    case NumberType::int32:
      return H5T_STD_I32LE;
    case NumberType::int64:
      return H5T_STD_I64LE;
    case NumberType::float32:
      return H5T_IEEE_F32LE;
    default:
      return H5T_IEEE_F64LE;
  }
}

}  // namespace

struct FileWriter::State {
  State(const std::filesystem::path& path, const WriterOptions& chosen) : options(chosen), part(path, chosen.expected_bytes) {
    target.part = &part;
  }
  ~State() {
    target.is_given_up = true;  // unless committed, and then nothing is left to write
    links.reset();
    file.reset();
  }
  /// @throws the failure of a write below, else what the library says.
  void require(bool is_good, std::string_view what) const {
    if (target.failure) std::rethrow_exception(target.failure);
    if (is_good) return;
    throw Error(ErrorCode::write_failed, fmt::format("HDF5 can't {}: {}", what, last_failure()),
                {.file = part.target().string()});
  }
  [[nodiscard]] Handle open(const std::string& object) const {
    Handle out(H5Oopen(file.id(), object.c_str(), H5P_DEFAULT), H5Oclose);
    require(out.is_valid(), "open " + object);
    return out;
  }
  void put_attribute(const std::string& object, const std::string& name, hid_t type, const Handle& space,
                     const void* value) const {
    const Handle owner = open(object);
    const Handle attribute(H5Acreate2(owner.id(), name.c_str(), type, space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    require(attribute.is_valid() && H5Awrite(attribute.id(), type, value) >= 0, "write the attribute " + name);
  }
  void put_texts(const std::string& path, hid_t type, hsize_t size, const void* values) const;

  WriterOptions options;
  QuietErrors quiet;
  PartFile part;
  PartTarget target;
  PartDriver driver;
  Handle file;
  Handle links;  ///< property list: groups are made as needed
};

namespace {

/// Straight to its place in the file, behind the library's back: it was told where the bytes are going to be.
std::unique_ptr<ArraySink> contiguous_sink(PartFile& part, std::uint64_t at, std::uint64_t num_bytes) {
  class Contiguous final : public ArraySink {
   public:
    Contiguous(PartFile& part, std::uint64_t at, std::uint64_t num_bytes)
        : end_(at + num_bytes), at_(at), blocks_(contiguous_block, [this, &part](std::span<const char> block) {
            part.write_at(at_, block.data(), block.size());
            at_ += block.size();
          }) {}
    [[nodiscard]] char* room(std::size_t size) override { return blocks_.room(size); }
    void advance(std::size_t size) override { blocks_.advance(size); }
    void finish() override {
      blocks_.finish();
      PCBMESH_ASSERT(at_ == end_);
    }

   private:
    std::uint64_t end_, at_;
    BlockedArray blocks_;
  };
  return std::make_unique<Contiguous>(part, at, num_bytes);
}

/// Shuffled and deflated chunks, packed in several threads.
class ChunkedSink final : public ArraySink {
 public:
  using Check = std::function<void(bool)>;
  ChunkedSink(Handle dataset, std::size_t value_bytes, std::size_t row_bytes, std::int64_t chunk_rows, int num_threads,
              Check check)
      : dataset_(std::move(dataset)),
        chunk_rows_(chunk_rows),
        whole_chunk_(static_cast<std::size_t>(chunk_rows) * row_bytes),
        check_(std::move(check)),
        press_(
            num_threads,
            [value_bytes](std::span<const char> plain, std::vector<char>& packed) {
              std::vector<char> shuffled;
              shuffle(plain, value_bytes, shuffled);
              pack_zlib(shuffled, packed, deflate_level);
            },
            [this](std::span<const char> packed) { write_chunk(packed); }),
        blocks_(whole_chunk_, [this](std::span<const char> chunk) { add_chunk(chunk); }) {}
  [[nodiscard]] char* room(std::size_t size) override { return blocks_.room(size); }
  void advance(std::size_t size) override { blocks_.advance(size); }
  void finish() override {
    blocks_.finish();
    press_.finish();
    dataset_.reset();
    check_(true);
  }

 private:
  void add_chunk(std::span<const char> chunk) {
    if (chunk.size() == whole_chunk_) return press_.add(chunk);
    std::vector<char> filled(chunk.begin(), chunk.end());  // chunks are whole in the file
    filled.resize(whole_chunk_, 0);
    press_.add(filled);
  }
  void write_chunk(std::span<const char> packed) {
    const std::array<hsize_t, 2> at{static_cast<hsize_t>(next_row_), 0};
    check_(H5Dwrite_chunk(dataset_.id(), H5P_DEFAULT, 0, at.data(), packed.size(), packed.data()) >= 0);
    next_row_ += chunk_rows_;
  }

  Handle dataset_;
  std::int64_t chunk_rows_, next_row_ = 0;
  std::size_t whole_chunk_;
  Check check_;
  BlockPress press_;
  BlockedArray blocks_;
};

}  // namespace

FileWriter::FileWriter(const std::filesystem::path& target, const WriterOptions& options)
    : state_(std::make_unique<State>(target, options)) {
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose), create(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  state_->driver.use(access.id(), state_->target);
  H5Pset_fclose_degree(access.id(), H5F_CLOSE_STRONG);
  H5Pset_obj_track_times(create.id(), false);
  state_->links = Handle(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(state_->links.id(), 1);
  state_->file = Handle(H5Fcreate(target.c_str(), H5F_ACC_TRUNC, create.id(), access.id()), H5Fclose);
  state_->require(state_->file.is_valid(), "make the file");
}

FileWriter::~FileWriter() = default;

void FileWriter::make_group(const std::string& path) {
  const Handle group(H5Gcreate2(state_->file.id(), path.c_str(), state_->links.id(), H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
  state_->require(group.is_valid(), "make the group " + path);
}

void FileWriter::link(const std::string& existing, const std::string& added) {
  const herr_t result =
      H5Lcreate_hard(state_->file.id(), existing.c_str(), state_->file.id(), added.c_str(), state_->links.id(), H5P_DEFAULT);
  state_->require(result >= 0, "link " + added);
}

void FileWriter::put_attribute(const std::string& object, const std::string& name, std::string_view text) {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose), space(H5Screate(H5S_SCALAR), H5Sclose);
  H5Tset_size(type.id(), std::max<std::size_t>(text.size(), 1));
  H5Tset_strpad(type.id(), H5T_STR_NULLPAD);
  const std::string value(text.empty() ? std::string_view("\0", 1) : text);
  state_->put_attribute(object, name, type.id(), space, value.data());
}

void FileWriter::put_attribute(const std::string& object, const std::string& name, std::span<const std::int64_t> values) {
  const hsize_t size = values.size();
  const Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose);
  state_->put_attribute(object, name, H5T_STD_I64LE, space, values.data());
}

void FileWriter::put_attribute(const std::string& object, const std::string& name, double value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  state_->put_attribute(object, name, H5T_IEEE_F64LE, space, &value);
}

void FileWriter::put_strings(const std::string& path, std::span<const std::string> texts) {
  std::size_t width = 1;
  for (const std::string& text : texts) width = std::max(width, text.size());
  std::string bytes;
  for (const std::string& text : texts) bytes += text + std::string(width - text.size(), '\0');
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.id(), width);
  H5Tset_strpad(type.id(), H5T_STR_NULLPAD);
  H5Tset_cset(type.id(), H5T_CSET_UTF8);
  state_->put_texts(path, type.id(), texts.size(), bytes.data());
}

void FileWriter::put_strings_for_vtk(const std::string& path, std::span<const std::string> texts) {
  std::vector<const char*> pointers;
  for (const std::string& text : texts) pointers.push_back(text.c_str());
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.id(), H5T_VARIABLE);
  state_->put_texts(path, type.id(), pointers.size(), pointers.data());
}

void FileWriter::State::put_texts(const std::string& path, hid_t type, hsize_t size, const void* values) const {
  const Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose);
  const Handle create(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(create.id(), false);
  const Handle dataset(H5Dcreate2(file.id(), path.c_str(), type, space.id(), links.id(), create.id(), H5P_DEFAULT), H5Dclose);
  require(dataset.is_valid(), "make " + path);
  if (size > 0) require(H5Dwrite(dataset.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0, "write " + path);
}

std::unique_ptr<ArraySink> FileWriter::begin(const std::string& path, NumberType type, std::int64_t num_rows,
                                             std::int64_t num_columns) {
  const std::array<hsize_t, 2> size{static_cast<hsize_t>(num_rows),
                                    static_cast<hsize_t>(std::max<std::int64_t>(num_columns, 1))};
  const int rank = num_columns > 0 ? 2 : 1;
  const std::size_t row_bytes = size_of(type) * size[1];
  const auto num_bytes = static_cast<std::uint64_t>(num_rows) * row_bytes;
  const bool is_chunked = state_->options.packed && num_bytes >= least_packed;
  const auto chunk_rows = std::min(num_rows, static_cast<std::int64_t>(std::max<std::size_t>(chunk_bytes / row_bytes, 1)));

  const Handle space(H5Screate_simple(rank, size.data(), nullptr), H5Sclose);
  const Handle create(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(create.id(), false);
  H5Pset_fill_time(create.id(), H5D_FILL_TIME_NEVER);
  if (is_chunked) {
    const std::array<hsize_t, 2> chunk{static_cast<hsize_t>(chunk_rows), size[1]};
    H5Pset_chunk(create.id(), rank, chunk.data());
    H5Pset_shuffle(create.id());
    H5Pset_deflate(create.id(), deflate_level);
  } else {
    H5Pset_alloc_time(create.id(), H5D_ALLOC_TIME_EARLY);
  }
  Handle dataset(
      H5Dcreate2(state_->file.id(), path.c_str(), file_type(type), space.id(), state_->links.id(), create.id(), H5P_DEFAULT),
      H5Dclose);
  state_->require(dataset.is_valid(), "make " + path);
  if (is_chunked)
    return std::make_unique<ChunkedSink>(std::move(dataset), size_of(type), row_bytes, chunk_rows, state_->options.num_threads,
                                         [state = state_.get(), path](bool good) { state->require(good, "write " + path); });
  const haddr_t at = num_bytes > 0 ? H5Dget_offset(dataset.id()) : 0;
  state_->require(at != HADDR_UNDEF, "find room for " + path);
  return contiguous_sink(state_->part, at, num_bytes);
}

void FileWriter::save() {
  state_->require(H5Fflush(state_->file.id(), H5F_SCOPE_GLOBAL) >= 0, "write the file");
  state_->links.reset();
  state_->file.reset();
  state_->require(true, "close the file");
  state_->part.save(state_->target.end);
}

void FileWriter::commit() {
  if (state_->file.is_valid()) save();
  state_->part.commit(state_->target.end);
}

std::string last_failure() {
  std::string text;
  const auto note = [](unsigned, const H5E_error2_t* error, void* user) -> herr_t {
    if (error->desc != nullptr) *static_cast<std::string*>(user) = error->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, note, &text);
  // The innermost entry comes last; some carry the time of day and places in memory, which say nothing to a reader.
  return text.empty() ? "unknown reason" : text.substr(0, 300);
}

}  // namespace pcbmesh::formats::hdf5

#endif
