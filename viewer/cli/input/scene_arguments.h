// SPDX-License-Identifier: BSD-3-Clause
// The options that several commands share, and the scene and settings they stand for.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vps/byte_cache.h"
#include "vps/fidelity.h"
#include "vps/voxmap_cache.h"
#include "vps_scenes/scene/model_options.h"
#include "vps_scenes/scene/scene.h"

namespace CLI {
class App;
}

namespace vps::viewer {

class ProgressBar;

/// --fidelity, --voxel, --spacing, --points and --sides as text; empty or 0: not given.
struct FidelityArguments {
  std::string preset, voxel, spacing, sides;
  std::size_t points = 0;
};

/// Adds --fidelity, --voxel, --spacing and --sides.
void addFidelityOptions(CLI::App& command, FidelityArguments& given);
/// Adds --points, which excludes --spacing. Call addFidelityOptions() first.
void addPointsOption(CLI::App& command, FidelityArguments& given);
/// `base`, changed by the options that were given. Throws LoadError that names the option.
Fidelity fidelityFrom(const FidelityArguments& given, Fidelity base);
struct NamedMesh {
  const Mesh& mesh;
  std::string name;  ///< for messages
};
/// Fidelity of a mesh without a scene. If neither preset nor voxel size is given, the voxel size follows from
/// the sizes of this mesh and of the other one (vps_scenes/planning/fidelity_choice.h).
/// @param other   may be null
/// @param choice  is set to a description of the choice; empty if the preset is used
Fidelity fidelityFrom(const FidelityArguments& given, const NamedMesh& mesh, const NamedMesh* other,
                      std::string& choice);
/// Prints the choice on stderr, unless it is empty.
void sayChoice(const std::string& resolution_choice);

/// Options of the cache that keeps models and the parts of CAD files between runs.
struct CacheArguments {
  std::string folder;   ///< empty: defaultCacheFolder()
  bool is_off = false;  ///< models are built each time
  double limit_GB = 4;  ///< above this size the least recently used files are removed
};

/// A scene and how its models are built.
struct SceneArguments {
  std::string scene;
  CacheArguments cache;
  bool models_everything = false;  ///< see scenes::ModelOptions
  FidelityArguments fidelity;
};

/// Adds the positional argument SCENE.
void addSceneArgument(CLI::App& command, std::string& scene);
/// Adds --cache.
void addCacheOption(CLI::App& command, std::string& folder);
/// Adds --cache, --no-cache and --cache-limit. Commands that build no models use the cache only for CAD
/// files.
void addCacheOptions(CLI::App& command, CacheArguments& given);
/// Adds SCENE, --model-everything, and the options of addCacheOptions() and addFidelityOptions().
void addSceneOptions(CLI::App& command, SceneArguments& given);

/// The scene, with the command line's fidelity instead of its own. Prints warnings about the scene's CAD
/// files on stderr. Throws LoadError when one of `outputs` is a file that the scene was read from, and names
/// the command that reads `file` when it is no scene but a CAD file, a level set or a recording.
/// @param cache cache for the parts of the scene's CAD files
scenes::Scene sceneFrom(const std::string& file, const FidelityArguments& given,
                        const std::vector<std::string>& outputs, const CacheArguments& cache);

/// Adds --units.
void addUnitsOption(CLI::App& command, std::string& units);
/// Adds --deflection.
void addDeflectionOption(CLI::App& command, std::string& deflection);
/// "mm", "cm", "m", "um" or "inch" in metres; empty for empty text. Throws LoadError naming --units.
std::optional<double> unitFrom(const std::string& text);
/// Throws LoadError when --units or --deflection is given for a scene file, which states both itself.
void requireOwnUnits(const std::string& scene, const std::string& units, const std::string& deflection);

/// Reads a scene. Parts of the scene's CAD files are taken from the cache if the cache has them.
scenes::Scene loadedScene(const std::string& file, const CacheArguments& cache, const Progress& progress);

/// The cache in a folder, which reports damaged files on stderr; none for an empty name.
std::optional<VoxMapCache> cacheFrom(const std::string& folder);
/// The cache that the options choose; none with --no-cache, or if the user has no folder for caches.
std::optional<VoxMapCache> cacheFrom(const CacheArguments& given);
/// The cache for the parts of CAD files, in the same folder as the models.
std::optional<ByteCache> cadCacheFrom(const CacheArguments& given);
/// bullet-vps in $XDG_CACHE_HOME, or else in $HOME/.cache; empty if neither variable has an absolute path.
/// Source: XDG Base Directory Specification 0.8.
std::string defaultCacheFolder();

/// Sets progress, warnings on stderr and the cache. Bar and cache must outlive the options.
void setModelOptions(scenes::ModelOptions& options, ProgressBar& bar, const std::optional<VoxMapCache>& cache,
                     bool models_everything);

}  // namespace vps::viewer
