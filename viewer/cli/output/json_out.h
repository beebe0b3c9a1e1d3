// SPDX-License-Identifier: BSD-3-Clause
// Results as JSON, with the keys that other programs rely on: viewer/cli/JSON.md lists them. Wall-clock
// figures are in one object, `wall`, so that all else repeats byte for byte. Numbers that are not finite
// become null.
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

/// What `vps query` found at one pose.
struct PoseAnswer {
  Pose X_AB;
  double min_distance_m = 0;  ///< negative when touching; a lower bound if is_beyond
  bool is_beyond = false;     ///< nothing within the band
  bool is_saturated = false;  ///< as deep as the band is wide, or deeper
  std::size_t contact_count = 0, points_tested = 0;
  Wrench F_Bo_A;  ///< on B about its origin, in A
  [[nodiscard]] double maxDepth_m() const { return min_distance_m < 0 ? -min_distance_m : 0; }
};

struct QueryAnswer {
  std::string mesh_a, mesh_b;
  std::vector<PoseAnswer> poses;
  std::size_t points_total = 0, memory_bytes = 0;
  double voxel_m = 0, point_spacing_m = 0;  ///< of A's voxmap and B's points
  double voxel_b_m = 0;                     ///< of B's voxmap; 0: one-sided
  scenes::TickTimes time;
  double build_wall_s = 0;
};

/// What `vps import` says of a part.
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

/// What `vps export` wrote into one file; `model` says which of the numbers apply.
struct ExportedFileAnswer {
  std::string file, model;     ///< "voxmap", "pointshell" or "mesh"
  double voxel_m = 0;          ///< of a voxmap
  std::size_t bricks = 0;      ///< of a voxmap
  std::size_t points = 0;      ///< of a pointshell
  double point_spacing_m = 0;  ///< of a pointshell
  std::size_t triangles = 0;   ///< of a mesh
};

struct ExportAnswer {
  std::string source, part;  ///< part: of a scene
  std::vector<ExportedFileAnswer> files;
};

struct SnapshotAnswer {
  std::string scene;
  int width = 0, height = 0;
  bool is_compared = false, is_same_size = true;
  double share_beyond = 0, mean_difference = 0;
  int greatest_difference = 0, tolerance = 0;
};

/// What `vps explain` found, and the cost of modelling everything if that was requested.
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
std::string toJson(const scenes::CheckResult& result);
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
