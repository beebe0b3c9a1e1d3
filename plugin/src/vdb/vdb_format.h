// SPDX-License-Identifier: BSD-3-Clause
// The content of .vdb files that saveVdb() writes. Only files of this folder include OpenVDB, because its
// headers are slow to compile.
//
// Other programs read the grid "surface". Two more grids make a reload exact: "vps_center" (one value per
// directory cell: the bound at its centre) and, if parts are merged, "vps_owner". A signature with a checksum
// ends the file. Files of other programs have none of these items; their bounds are computed from the nodes
// (field_bounds.h).
#pragma once

#include <openvdb/openvdb.h>

#include <string>
#include <string_view>

#include "voxmap/voxmap_layout.h"

namespace vps {

inline constexpr const char* kSurface = "surface";
inline constexpr const char* kCenter = "vps_center";
inline constexpr const char* kOwner = "vps_owner";

/// Name of a part's metadata.
inline std::string partKey(std::size_t part, const char* what) {
  return "vps_part" + std::to_string(part) + "_" + what;
}

/// Throws LoadError: what was found in the file, and what would help.
[[noreturn]] void refuseVdb(const std::string& file, const std::string& found_and_remedy);

/// Initialises OpenVDB once. Thread-safe.
void initializeOpenVdb();

/// The signature and checksum that end a file of saveVdb(). OpenVDB's reader trusts the file, and a wrong
/// byte can make it write out of bounds, so the checksum is verified first.
std::string endOf(std::string_view bytes);

enum class Origin {
  Ours,     ///< written by saveVdb() and unchanged
  Changed,  ///< written by saveVdb(), but changed
  Others    ///< written by another program
};
Origin originOf(std::string_view bytes);

inline openvdb::Coord toCoord(const Index3& i) {
  return {i.x(), i.y(), i.z()};
}
inline openvdb::Vec3d toVdb(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}
inline openvdb::Vec3i toVdb(const Index3& v) {
  return {v.x(), v.y(), v.z()};
}
inline Vec3 fromVdb(const openvdb::Vec3d& v) {
  return {v.x(), v.y(), v.z()};
}
inline Index3 fromVdb(const openvdb::Vec3i& v) {
  return {v.x(), v.y(), v.z()};
}
inline Index3 fromVdb(const openvdb::Coord& c) {
  return {c.x(), c.y(), c.z()};
}

}  // namespace vps
