// SPDX-License-Identifier: BSD-3-Clause
#include "vdb/vdb_grids.h"

#include <algorithm>

namespace vps {

std::string VdbArchive::Entry::name() const {
  return openvdb::io::GridDescriptor::nameAsString(descriptor.uniqueName());
}

double VdbArchive::Entry::bytes() const {
  const auto stored = grid->getMetadata<openvdb::Int64Metadata>(openvdb::GridBase::META_FILE_MEM_BYTES);
  return stored ? static_cast<double>(stored->value()) : 0;
}

VdbArchive::VdbArchive(std::string bytes, double limit_bytes) : stream_(std::move(bytes)) {
  stream_.exceptions(std::ios::failbit | std::ios::badbit | std::ios::eofbit);
  readHeader(stream_);
  setFormatVersion(stream_);
  setLibraryVersion(stream_);
  setDataCompression(stream_);
  openvdb::MetaMap of_file;
  of_file.readMeta(stream_);
  const int count = readGridCount(stream_);
  for (int i = 0; i < count; ++i) {
    list(entries_.emplace_back());
    if (inputHasGridOffsets()) {
      if (i + 1 < count) entries_.back().descriptor.seekToEnd(stream_);
      continue;
    }
    if (entries_.back().bytes() > limit_bytes) return;
    read(entries_.size() - 1);
  }
}

/// Reads metadata and transform; leaves the stream at the beginning of the grid.
void VdbArchive::list(Entry& entry) {
  entry.grid = entry.descriptor.read(stream_);
  entry.grid->setSaveFloatAsHalf(entry.descriptor.saveFloatAsHalf());
  const auto begin = stream_.tellg();
  readGridCompression(stream_);
  entry.grid->readMeta(stream_);
  if (openvdb::io::getFormatVersion(stream_) >= openvdb::OPENVDB_FILE_VERSION_GRID_INSTANCING)
    entry.grid->readTransform(stream_);
  stream_.seekg(begin);
}

openvdb::GridBase::Ptr VdbArchive::read(std::size_t index) {
  Entry& entry = entries_[index];
  if (entry.is_read) return entry.grid;
  if (inputHasGridOffsets()) entry.descriptor.seekToGrid(stream_);
  readGrid(entry.grid, entry.descriptor, stream_);
  entry.is_read = true;
  if (!entry.descriptor.isInstance()) return entry.grid;
  // The tree of an instance is stored with another grid.
  for (std::size_t i = 0; i < entries_.size(); ++i)
    if (i != index && entries_[i].descriptor.uniqueName() == entry.descriptor.instanceParentName())
      entry.grid->setTree(read(i)->baseTreePtr());
  return entry.grid;
}

}  // namespace vps
