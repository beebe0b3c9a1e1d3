// SPDX-License-Identifier: BSD-3-Clause
#include "input/level_set_file.h"

#ifdef VPS_VDB_MODULE
#include <dlfcn.h>

#include <filesystem>
#include <string_view>
#include <system_error>
#endif

#include "vps/errors.h"
#include "vps/version.h"

namespace vps::viewer {

#ifdef VPS_VDB_MODULE

namespace {

/// Opens the module in the folder of the program, as in a build, or in the folder where it is installed.
/// Returns null if neither folder has the module.
void* openModule() {
  namespace fs = std::filesystem;
  std::error_code none;
  const fs::path folder = fs::read_symlink("/proc/self/exe", none).parent_path();
  for (const fs::path& at : {folder / VPS_VDB_MODULE, folder / VPS_VDB_MODULE_FOLDER / VPS_VDB_MODULE})
    if (!folder.empty() && fs::exists(at, none)) return dlopen(at.c_str(), RTLD_NOW | RTLD_LOCAL);
  return nullptr;
}

/// Opens the module once and never closes it, because voxmaps that it made point to its code.
const LevelSetModule& module(const std::string& file) {
  static std::string why = "the module is not next to the program";
  static const auto* const found = [] {
    void* const opened = openModule();
    if (opened != nullptr) return static_cast<const LevelSetModule*>(dlsym(opened, kLevelSetSymbol));
    if (const char* words = dlerror(); words != nullptr) why = words;
    return static_cast<const LevelSetModule*>(nullptr);
  }();
  if (found == nullptr)
    throw LoadError(file, "",
                    "needs OpenVDB and this program's module " VPS_VDB_MODULE " (" + why +
                        "); install both (Debian: libopenvdb10.0), or build the module with "
                        "'cmake --build build/release'");
  if (std::string_view(found->version) != VPS_VERSION_STRING || found->voxmap_bytes != sizeof(VoxMap))
    throw LoadError(file, "",
                    "the module " VPS_VDB_MODULE
                    " next to the program is of another build; build both with "
                    "'cmake --build build/release'");
  return *found;
}

}  // namespace

void requireOpenVdb(const std::string& file) {
  module(file);
}

VoxMap loadLevelSet(const std::string& file) {
  return module(file).load(file);
}

void saveLevelSet(const VoxMap& map, const std::string& file) {
  module(file).save(map, file);
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

}  // namespace vps::viewer
