// SPDX-License-Identifier: BSD-3-Clause
// The options of commands that read CAD files.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "input/scene_arguments.h"
#include "vps_scenes/cad/import.h"
#include "vps_scenes/scene/scene.h"

namespace CLI {
class App;
}

namespace vps::viewer {

/// A part that would have more triangles is read with a coarser mesh, because checking it would take minutes.
inline constexpr std::size_t kMostTriangles = 250'000;

/// Warning if --units is given and not used.
inline constexpr const char* kUnusedUnits = "states its unit itself, so that --units is not used";

struct CadArguments {
  std::string units, deflection, up, part_per;  ///< as text; empty: not given
  double time_limit_s = 0;
  scenes::GroupWishes groups;
  bool has_no_groups = false;
  CacheArguments cache;              ///< cache for the parts that are read
  [[nodiscard]] bool isAny() const;  ///< whether an option other than the cache's is given
};

/// Adds --units, --deflection, --up, --part-per, --group, --no-groups and --time-limit. addCacheOptions()
/// adds the options of the cache.
void addCadOptions(CLI::App& command, CadArguments& given);

/// Import settings from the options. The defaults suit an unknown file: parts with more than `most_triangles`
/// triangles are read with a coarser mesh, and the vertical axis is guessed. Throws LoadError that names the
/// option.
scenes::ImportSettings importSettingsFrom(const CadArguments& given, std::size_t most_triangles);

/// Reads the files into one frame, or takes their parts from the cache.
scenes::ImportedCad importedCad(const std::vector<std::string>& files, scenes::ImportSettings settings,
                                const CadArguments& given, const Progress& progress);

/// Whether the files are CAD files, which are read into one frame, and not a scene file. Throws LoadError for
/// a scene among several files, and for a file that is not CAD.
bool areCadFiles(const std::vector<std::string>& files);
/// The files, quoted as in TOML, with commas between them.
std::string listedFiles(const std::vector<std::string>& files);

/// Finds the groups of the file, and prints them with their reasons on stderr.
std::vector<scenes::PartGroup> groupsOf(scenes::ImportedCad& cad, const CadArguments& given);

/// The scene of a CAD file, with its groups as bodies and its warnings.
scenes::Scene groupedScene(scenes::ImportedCad cad, const CadArguments& given);

/// Throws LoadError if one of the options is given for a scene file, which states these settings itself.
void requireNoCadOptions(const std::string& scene, const CadArguments& given);

}  // namespace vps::viewer
