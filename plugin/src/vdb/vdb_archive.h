// SPDX-License-Identifier: BSD-3-Clause
// The grids of a .vdb file, listed before any of them is read.
#pragma once

#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>

#include <sstream>
#include <string>
#include <vector>

#include "vdb/vdb_format.h"

namespace vps {

/// Throws what OpenVDB and streams throw. OpenVDB does not look whether a read came short: the stream does.
class VdbArchive : private openvdb::io::Archive {
 public:
  struct Entry {
    openvdb::io::GridDescriptor descriptor;
    openvdb::GridBase::Ptr grid;  ///< metadata and transform; the tree only if it had to be passed
    bool is_read = false;
    [[nodiscard]] std::string name() const;
    /// Of the tree in memory, as the file says; 0 if it does not.
    [[nodiscard]] double bytes() const;
  };

  /// Lists the grids. A file that was written as a stream has no table of them: all are read, unless one says
  /// that it is larger than `limit_bytes`; the list ends with that one.
  VdbArchive(std::string bytes, double limit_bytes);

  [[nodiscard]] const std::vector<Entry>& entries() const { return entries_; }
  /// The grid with its tree.
  openvdb::GridBase::Ptr read(std::size_t entry);

 private:
  void list(Entry& entry);

  std::istringstream stream_;
  std::vector<Entry> entries_;
};

}  // namespace vps
