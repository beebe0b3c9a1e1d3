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

/// A part that would have more is read coarser: a check of it takes minutes.
inline constexpr std::size_t kMostTriangles = 250'000;

/// The warning where --units is given and not used.
inline constexpr const char* kUnusedUnits = "states its unit itself, so that --units is not used";

struct CadArguments {
  std::string units, deflection, up, part_per;  ///< as text; empty: not given
  double time_limit_s = 0;
  scenes::GroupWishes groups;
  bool has_no_groups = false;
  CacheArguments cache;              ///< of what is read
  [[nodiscard]] bool isAny() const;  ///< whether one of the others is given
};

/// Adds --units, --deflection, --up, --part-per, --group, --no-groups and --time-limit; those of the cache
/// come by addCacheOptions().
void addCadOptions(CLI::App& command, CadArguments& given);

/// What was given, and otherwise what suits a file that nobody has looked at: parts of more than
/// `most_triangles` are read coarser, and what is up is guessed. Throws LoadError naming the option.
scenes::ImportSettings importSettingsFrom(const CadArguments& given, std::size_t most_triangles);

/// Reads the files into one frame, or takes their parts from the cache.
scenes::ImportedCad importedCad(const std::vector<std::string>& files, scenes::ImportSettings settings,
                                const CadArguments& given, const Progress& progress);

/// Whether these are CAD files, which are read into one frame, and not a scene file. Throws LoadError for a
/// scene among several files, and for what is no CAD file.
bool areCadFiles(const std::vector<std::string>& files);
/// The files, quoted as in TOML, with commas between them.
std::string listedFiles(const std::vector<std::string>& files);

/// Finds the groups of the file, and says on stderr which and why.
std::vector<scenes::PartGroup> groupsOf(scenes::ImportedCad& cad, const CadArguments& given);

/// The scene of a CAD file, with its groups as bodies and its warnings.
scenes::Scene groupedScene(scenes::ImportedCad cad, const CadArguments& given);

/// Throws LoadError when one of the options is given for a scene file, which states all of that itself.
void requireNoCadOptions(const std::string& scene, const CadArguments& given);

}  // namespace vps::viewer
