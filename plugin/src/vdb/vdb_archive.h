// SPDX-License-Identifier: BSD-3-Clause
// The grids of a .vdb file, listed before any tree is read.
#pragma once

#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>

#include <sstream>
#include <string>
#include <vector>

#include "vdb/vdb_format.h"

namespace vps {

/// Throws exceptions of OpenVDB and of streams. OpenVDB does not check whether a read was complete; the
/// stream does.
class VdbArchive : private openvdb::io::Archive {
 public:
  struct Entry {
    openvdb::io::GridDescriptor descriptor;
    openvdb::GridBase::Ptr grid;  ///< metadata and transform; includes the tree only if it had to be read
    bool is_read = false;
    [[nodiscard]] std::string name() const;
    /// Size of the tree in memory as recorded in the file; 0 if it is not recorded.
    [[nodiscard]] double bytes() const;
  };

  /// Lists the grids. A file that was written as a stream has no table of grids: all grids are read, up to
  /// the first one that is recorded as larger than `limit_bytes`, with which the list ends.
  VdbArchive(std::string bytes, double limit_bytes);

  [[nodiscard]] const std::vector<Entry>& entries() const { return entries_; }
  /// Reads the grid with its tree.
  openvdb::GridBase::Ptr read(std::size_t entry);

 private:
  void list(Entry& entry);

  std::istringstream stream_;
  std::vector<Entry> entries_;
};

}  // namespace vps
