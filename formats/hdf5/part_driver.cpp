// SPDX-License-Identifier: GPL-3.0-or-later
#ifdef PCBMESH_HAS_HDF5

#include "formats/hdf5/part_driver.hpp"

#include <algorithm>
#include <cstring>
#include <memory>

#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats::hdf5 {
namespace {

struct Info {
  PartTarget* target = nullptr;
};

struct OpenPart {
  H5FD_t base{};  ///< the library's part; must come first
  PartTarget* target = nullptr;
  haddr_t allocated = 0;
};

PartTarget& target_of(const H5FD_t* file) {
  return *reinterpret_cast<const OpenPart*>(file)->target;
}

/// Runs a step unless one failed before; always a success for the library.
template <class Step>
herr_t kept(PartTarget& target, Step&& step) {
  if (target.is_given_up) return 0;
  try {
    step();
  } catch (...) {
    target.failure = std::current_exception();
    target.is_given_up = true;
  }
  return 0;
}

H5FD_t* open_part(const char*, unsigned, hid_t access, haddr_t) {
  const auto* info = static_cast<const Info*>(H5Pget_driver_info(access));
  if (info == nullptr) return nullptr;
  auto file = std::make_unique<OpenPart>();
  file->target = info->target;
  return &file.release()->base;
}

herr_t close_part(H5FD_t* file) {
  delete reinterpret_cast<OpenPart*>(file);
  return 0;
}

int compare(const H5FD_t* a, const H5FD_t* b) {
  return a < b ? -1 : a > b ? 1 : 0;
}

herr_t query(const H5FD_t*, unsigned long* flags) {
  if (flags != nullptr)
    *flags =
        H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE | H5FD_FEAT_AGGREGATE_SMALLDATA;
  return 0;
}

haddr_t get_allocated(const H5FD_t* file, H5FD_mem_t) {
  return reinterpret_cast<const OpenPart*>(file)->allocated;
}

herr_t set_allocated(H5FD_t* file, H5FD_mem_t, haddr_t end) {
  reinterpret_cast<OpenPart*>(file)->allocated = end;
  return 0;
}

haddr_t get_end(const H5FD_t* file, H5FD_mem_t) {
  return target_of(file).end;
}

herr_t read(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t at, size_t size, void* to) {
  PartTarget& target = target_of(file);
  std::memset(to, 0, size);
  return kept(target, [&] { target.part->read_at(at, to, size); });
}

herr_t write(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t at, size_t size, const void* from) {
  PartTarget& target = target_of(file);
  return kept(target, [&] {
    target.part->write_at(at, from, size);
    target.end = std::max<std::uint64_t>(target.end, at + size);
  });
}

herr_t truncate(H5FD_t* file, hid_t, hbool_t) {
  PartTarget& target = target_of(file);
  const haddr_t end = reinterpret_cast<OpenPart*>(file)->allocated;
  if (target.end == end) return 0;
  target.end = end;
  return kept(target, [&] { target.part->resize(end); });
}

H5FD_class_t make_class() {
  H5FD_class_t out{};
#if H5_VERSION_GE(1, 13, 0)
  out.version = H5FD_CLASS_VERSION;
  out.value = static_cast<H5FD_class_value_t>(511);
#endif
  out.name = "pcbmesh_part";
  out.maxaddr = (haddr_t{1} << 62) - 1;
  out.fc_degree = H5F_CLOSE_WEAK;
  out.fapl_size = sizeof(Info);
  out.open = open_part;
  out.close = close_part;
  out.cmp = compare;
  out.query = query;
  out.get_eoa = get_allocated;
  out.set_eoa = set_allocated;
  out.get_eof = get_end;
  out.read = read;
  out.write = write;
  out.truncate = truncate;
  const H5FD_mem_t map[] = H5FD_FLMAP_DICHOTOMY;
  std::copy(std::begin(map), std::end(map), std::begin(out.fl_map));
  return out;
}

}  // namespace

PartDriver::PartDriver() {
  static const H5FD_class_t driver = make_class();
  id_ = H5FDregister(&driver);
  PCBMESH_ASSERT(id_ >= 0);
}

PartDriver::~PartDriver() {
  H5FDunregister(id_);
}

void PartDriver::use(hid_t access, PartTarget& target) const {
  const Info info{&target};
  PCBMESH_ASSERT(H5Pset_driver(access, id_, &info) >= 0);
}

}  // namespace pcbmesh::formats::hdf5

#endif
