// SPDX-License-Identifier: BSD-3-Clause
#include "level_set_file.h"

#include "vps/load_error.h"
#ifdef VPS_HAS_VDB
#include "vps/vdb.h"
#endif

namespace vps::viewer::inline v0 {

#ifdef VPS_HAS_VDB

void requireOpenVdb(const std::string&) {}

VoxMap loadLevelSet(const std::string& file) {
  return loadVdb(file);
}

void saveLevelSet(const VoxMap& map, const std::string& file) {
  saveVdb(map, file);
}

#else

void requireOpenVdb(const std::string& file) {
  throw LoadError(file, "",
                  "needs OpenVDB, without which this program was built; install it (Debian: libopenvdb-dev "
                  "libboost-dev) and build again");
}

VoxMap loadLevelSet(const std::string& file) {
  requireOpenVdb(file);
  return {};
}

void saveLevelSet(const VoxMap&, const std::string& file) {
  requireOpenVdb(file);
}

#endif

}  // namespace vps::viewer::inline v0
