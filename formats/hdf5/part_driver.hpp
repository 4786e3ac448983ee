// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <exception>

#include "formats/sink/part_file.hpp"

namespace pcbmesh::formats::hdf5 {

/// The file below an HDF5 file that is being written. The library is C and keeps what it could not write: so a failure is
/// kept here, all later writes are swallowed, and the library closes in peace.
struct PartTarget {
  PartFile* part = nullptr;    ///< not null
  std::uint64_t end = 0;       ///< bytes of the file
  std::exception_ptr failure;  ///< first one
  bool is_given_up = false;    ///< nothing is written any more
};

/// Driver of the HDF5 library that works on a PartTarget. Registered while it lives.
class PartDriver {
 public:
  PartDriver();
  ~PartDriver();
  PartDriver(const PartDriver&) = delete;
  PartDriver& operator=(const PartDriver&) = delete;
  /// Makes an access property list use `target`, which must outlive the file.
  void use(hid_t access, PartTarget& target) const;

 private:
  hid_t id_ = -1;
};

}  // namespace pcbmesh::formats::hdf5
