// SPDX-License-Identifier: BSD-3-Clause
// The subcommands of `vps`: what each is told, and the functions that run them. main.cpp fills the arguments;
// each function returns the exit status 0 or 1, or throws LoadError and the like, which main.cpp turns into a
// line and 2.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vps/fidelity.h"
#include "vps/voxmap_cache.h"
#include "vps_scenes/model_options.h"
#include "vps_scenes/scene.h"

namespace vps::viewer {

class ProgressBar;

/// Exit status of the program.
inline constexpr int kGood = 0;      ///< done, and the answer is good
inline constexpr int kBad = 1;       ///< done, and the parts do not fit, a step failed, a bound was missed
inline constexpr int kCouldNot = 2;  ///< bad input, said in one line

/// --fidelity, --voxel, --spacing, --points, --sides, as text; empty or 0: not given.
struct FidelityArguments {
  std::string preset, voxel, spacing, sides;
  std::size_t points = 0;
};

/// `base` with what was given on the command line. Throws LoadError naming the option.
Fidelity fidelityFrom(const FidelityArguments& given, Fidelity base);

struct AssembleArguments {
  std::string scene;
  std::string cache;  ///< folder for voxmaps; empty: none
  std::string out = "out";
  std::string json;
  std::string record;  ///< file to record the run in; empty: none
  FidelityArguments fidelity;
  bool has_pictures = true;
  bool stops_at_failure = false;
  bool is_real_time = false;
  bool has_local_contact = false;
  bool degrades = true;  ///< in real time
  bool models_everything = false;
};
int runAssemble(const AssembleArguments& given);

struct ReplayArguments {
  std::string recording;
  std::string cache;  ///< as in AssembleArguments
  std::string out, json;
  std::string csv;              ///< folder for the recorded channels as tables
  bool is_tables_only = false;  ///< do not run
};
int runReplay(const ReplayArguments& given);

struct SimulateArguments {
  std::string scene;
  std::string cache;  ///< as in AssembleArguments
  bool is_real_time = false;
  double seconds = 1;
  std::string trace, json;
  FidelityArguments fidelity;
  bool models_everything = false;
};
int runSimulate(const SimulateArguments& given);

struct ExplainArguments {
  std::string scene;
  std::string cache;  ///< as in AssembleArguments
  std::string json;
  FidelityArguments fidelity;
  bool is_for_simulate = false;  ///< what vps simulate would model; without steps always
  bool models_everything = false;
};
int runExplain(const ExplainArguments& given);

struct QueryArguments {
  std::string mesh_a, mesh_b;
  std::string pose, poses;  ///< "x,y,z,qx,qy,qz,qw", or a file of such lines
  std::string units, json;
  std::string cache;  ///< as in AssembleArguments
  FidelityArguments fidelity;
  double stiffness_N_per_m3 = 1e12;
  std::size_t budget_points = 0;  ///< readings a pose and side; 0: no limit
  double budget_us = 0;           ///< 0: no limit
  int repeats = 0;                ///< timed runs of each pose; 0: as many as make 100 in all
};
int runQuery(const QueryArguments& given);

struct TradeArguments {
  std::string scene;
  FidelityArguments fidelity;
  bool is_thorough = false;
  std::string out, csv, json;  ///< empty: none
  std::optional<double> budget_hz;
  std::optional<std::string> tolerance, memory;  ///< "10um", "64MB"
};
int runTrade(const TradeArguments& given);

struct ImportArguments {
  std::string cad, out;
  std::string units, deflection, json;
  bool is_forced = false;  ///< writes over a scene.toml that is there
};
int runImport(const ImportArguments& given);

struct SnapshotArguments {
  std::string scene;
  std::string out, compare, difference, json;
  std::string size = "1280x960";
  std::string view = "iso";
  bool has_section = false;
  int tolerance = 2;
};
int runSnapshot(const SnapshotArguments& given);

struct DeviceArguments {
  bool is_characterise = false;
  bool is_list = false;          ///< only list the kinds of device
  std::string parameters;        ///< a device's .toml over the built-in one; empty: none
  std::string plot = "figure5";  ///< figure 5 goes to plot + ".png" and plot + ".svg"; empty: nowhere
  std::string json;
};
int runDevice(const DeviceArguments& given);

/// The cache in a folder, telling of its troubles on stderr; none for an empty name.
std::optional<VoxMapCache> cacheFrom(const std::string& folder);

/// What every command tells of models while they are built, where it keeps them, and what it is asked to
/// build. Bar and cache outlive the options.
void fill(scenes::ModelOptions& options, ProgressBar& bar, const std::optional<VoxMapCache>& cache,
          bool models_everything);

/// The views that --view knows.
std::vector<std::string> viewNames();

/// The scene with the command line's fidelity over its own; what its CAD files lack is said on stderr.
/// Throws LoadError when one of `outputs` is a file that the scene was read from.
scenes::Scene sceneFrom(const std::string& file, const FidelityArguments& given,
                        const std::vector<std::string>& outputs);

}  // namespace vps::viewer
