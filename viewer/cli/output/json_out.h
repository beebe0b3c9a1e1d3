// SPDX-License-Identifier: BSD-3-Clause
// Results as JSON. Other programs rely on the keys, which viewer/cli/JSON.md lists. Wall-clock
// figures are in one object, `wall`, so that everything else is the same in every run. Numbers that are not
// finite become null.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "vps/wrench.h"
#include "vps_scenes/cad/import.h"
#include "vps_scenes/network/session_request.h"
#include "vps_scenes/planning/plan.h"
#include "vps_scenes/run/explain.h"
#include "vps_scenes/run/result.h"
#include "vps_scenes/run/simulate.h"

namespace vps::scenes {
struct CheckResult;
struct FidelityChoice;
struct MarginResult;
struct Ergonomics;
struct RevisionChanges;
struct RunComparison;
struct StudyResult;
struct TradeResult;
}  // namespace vps::scenes

namespace vps::device {
struct DualArmCharacter;
struct DualArmFile;
}  // namespace vps::device

namespace vps::viewer {

struct LatencyResult;

/// Result of `vps query` at one pose.
struct PoseAnswer {
  Pose X_AB;
  double min_distance_m = 0;  ///< negative when touching; a lower bound if is_beyond
  bool is_beyond = false;     ///< no point is within the band
  bool is_saturated = false;  ///< the depth is the width of the band, or greater
  std::size_t contact_count = 0, points_tested = 0;
  Wrench F_Bo_A;  ///< wrench on B about B's origin, in the frame of A
  [[nodiscard]] double maxDepth_m() const { return min_distance_m < 0 ? -min_distance_m : 0; }
};

struct QueryAnswer {
  std::string mesh_a, mesh_b;
  std::vector<PoseAnswer> poses;
  std::size_t points_total = 0, memory_bytes = 0;
  double voxel_m = 0, point_spacing_m = 0;  ///< voxel size of A's voxmap, and distance between B's points
  double voxel_b_m = 0;                     ///< voxel size of B's voxmap; 0: the query is one-sided
  scenes::TickTimes time;
  double build_wall_s = 0;
};

/// A part in the result of `vps import`.
struct ImportedPartAnswer {
  std::string name, file;
  std::size_t triangles = 0;
  bool is_closed = false;
  Vec3 size_m = Vec3::Zero();
};

struct ImportAnswer {
  std::string cad, format;
  std::vector<ImportedPartAnswer> parts;
  std::vector<scenes::PartGroup> groups;
  std::vector<scenes::Fastener> fasteners;
  std::vector<std::string> warnings;
};

/// A file that `vps export` wrote; `model` determines which of the numbers apply.
struct ExportedFileAnswer {
  std::string file, model;     ///< "voxmap", "pointshell" or "mesh"
  double voxel_m = 0;          ///< of a voxmap
  std::size_t bricks = 0;      ///< of a voxmap
  std::size_t points = 0;      ///< of a pointshell
  double point_spacing_m = 0;  ///< of a pointshell
  std::size_t triangles = 0;   ///< of a mesh
};

struct ExportAnswer {
  std::string source, part;  ///< part: name of the part, if the source is a scene
  std::vector<ExportedFileAnswer> files;
};

struct SnapshotAnswer {
  std::string scene;
  int width = 0, height = 0;
  bool is_compared = false, is_same_size = true;
  double share_beyond = 0, mean_difference = 0;
  int greatest_difference = 0, tolerance = 0;
};

/// Result of `vps explain`; `everything` is the cost of modelling all parts, and empty with
/// --model-everything.
struct ExplainAnswer {
  scenes::Scene scene;
  scenes::ExplainedModels chosen;
  std::optional<scenes::ExplainedModels> everything;
};

std::string toJson(const scenes::AssembleResult& result);
std::string toJson(const std::string& scene, double seconds, const scenes::SimulateResult& result);
std::string toJson(const QueryAnswer& answer);
std::string toJson(const ImportAnswer& answer);
std::string toJson(const ExportAnswer& answer);
std::string toJson(const SnapshotAnswer& answer);
std::string toJson(const LatencyResult& result);
std::string toJson(const ExplainAnswer& answer);
std::string toJson(const scenes::TradeResult& result);
/// @param against differences from an older revision, for the key `against`; null: the key is left out
std::string toJson(const scenes::CheckResult& result, const scenes::RevisionChanges* against = nullptr);
std::string toJson(const scenes::MarginResult& result);
std::string toJson(const scenes::RunComparison& result);
std::string toJson(const scenes::SessionAnswer& answer);
std::string toJson(const scenes::Ergonomics& result);
std::string toJson(const scenes::StudyResult& result);
std::string toJson(const scenes::PlanResult& plan, const std::vector<scenes::WayFault>& faults);
std::string toJson(const std::string& scene, const std::vector<scenes::WayFault>& faults);
std::string toJson(const std::string& scene, const scenes::FidelityChoice& choice);
std::string toJson(const device::DualArmCharacter& character, const device::DualArmFile& file);

}  // namespace vps::viewer
