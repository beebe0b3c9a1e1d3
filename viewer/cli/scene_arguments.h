// SPDX-License-Identifier: BSD-3-Clause
// The options that several commands share, and the scene and settings they stand for.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vps/fidelity.h"
#include "vps/voxmap_cache.h"
#include "vps_scenes/model_options.h"
#include "vps_scenes/scene.h"

namespace CLI {
class App;
}

namespace vps::viewer::inline v0 {

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
/// `base` with what was given on the command line. Throws LoadError naming the option.
Fidelity fidelityFrom(const FidelityArguments& given, Fidelity base);

/// A scene and how its models are built.
struct SceneArguments {
  std::string scene;
  std::string cache;               ///< folder for voxmaps; empty: none
  bool models_everything = false;  ///< see scenes::ModelOptions
  FidelityArguments fidelity;
};

/// Adds the positional argument SCENE.
void addSceneArgument(CLI::App& command, std::string& scene);
/// Adds --cache.
void addCacheOption(CLI::App& command, std::string& folder);
/// Adds SCENE and the options --model-everything, --cache and those of addFidelityOptions().
void addSceneOptions(CLI::App& command, SceneArguments& given);

/// The scene, with the command line's fidelity instead of its own. Prints warnings about its CAD files on
/// stderr. Throws LoadError when one of `outputs` is a file that the scene was read from, and names the
/// command that reads `file` when it is no scene but a CAD file, a level set or a recording.
scenes::Scene sceneFrom(const std::string& file, const FidelityArguments& given,
                        const std::vector<std::string>& outputs);

/// Adds --units.
void addUnitsOption(CLI::App& command, std::string& units);
/// "mm", "cm", "m", "um" or "inch" in metres; empty for empty text. Throws LoadError naming --units.
std::optional<double> unitFrom(const std::string& text);

/// The cache in a folder, which reports damaged files on stderr; none for an empty name.
std::optional<VoxMapCache> cacheFrom(const std::string& folder);

/// Sets progress, warnings on stderr and the cache. Bar and cache must outlive the options.
void setModelOptions(scenes::ModelOptions& options, ProgressBar& bar, const std::optional<VoxMapCache>& cache,
                     bool models_everything);

}  // namespace vps::viewer::inline v0
