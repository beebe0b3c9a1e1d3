// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>
#include <utility>

#include "vps/errors.h"
#include "vps/mesh.h"
#include "vps_device/operator.h"
#include "vps_scenes/run/replay.h"
#include "vps_scenes/run/result.h"
#include "vps_scenes/scene/scene_parts.h"
#include "vps_scenes/uses/compare.h"

namespace vps::scenes {

namespace {

constexpr std::uint8_t kRest = static_cast<std::uint8_t>(TracePhase::Rest);  // as in RunTrace::phase

/// One step of a recording.
struct RecordedStep {
  std::string part;
  std::vector<HandSample> samples;
  bool is_done = false;
};

std::vector<RecordedStep> stepsOf(const device::RecordedRun& run) {
  const Scene scene = recordedScene(run);
  std::vector<RecordedStep> steps;
  std::vector<Pose> X_PG;
  for (const SceneStep& step : scene.steps) {
    const ScenePart& part = scene.parts[step.part];
    steps.push_back({part.part.name, {}, false});
    X_PG.push_back(Pose::translation(partMass(part).com));
  }
  const auto isStep = [&](std::int32_t step) {
    return step >= 0 && static_cast<std::size_t>(step) < steps.size();
  };
  std::vector<double> begun_s(steps.size(), 0);
  for (const device::LogEntry& entry : run.entries) {
    if (const auto* event = std::get_if<device::RunEvent>(&entry)) {
      if (!isStep(event->step)) continue;
      const auto i = static_cast<std::size_t>(event->step);
      if (event->kind == device::RunEventKind::Take) begun_s[i] = event->time_s;
      steps[i].is_done |= event->kind == device::RunEventKind::Phase &&
                          device::stateFromByte(event->phase).phase == device::OperatorPhase::Done;
    } else if (const auto* row = std::get_if<device::RunTrace>(&entry)) {
      if (!isStep(row->step) || row->phase == kRest || !row->X_WP.isFinite()) continue;
      const auto i = static_cast<std::size_t>(row->step);
      steps[i].samples.push_back({row->time_s - begun_s[i], row->X_WP * X_PG[i], row->F_hand_W.f.norm()});
    }
  }
  std::erase_if(steps, [](const RecordedStep& step) { return step.samples.empty(); });
  if (steps.empty())
    throw LoadError(run.file, "",
                    "holds no trace of a part in hand; record a run with vps assemble --record");
  return steps;
}

/// Poses of the path, each at least kPathPiece_m from the pose before.
std::vector<Pose> pathOf(const std::vector<HandSample>& samples) {
  std::vector<Pose> path{samples.front().X_WG};
  for (const HandSample& sample : samples)
    if ((sample.X_WG.p - path.back().p).norm() >= kPathPiece_m) path.push_back(sample.X_WG);
  return path;
}

double lengthOf(const std::vector<Pose>& path) {
  double length_m = 0;
  for (std::size_t i = 1; i < path.size(); ++i) length_m += (path[i].p - path[i - 1].p).norm();
  return length_m;
}

RunMeasures measuresOf(const std::vector<HandSample>& samples, const std::vector<Pose>& path) {
  RunMeasures of;
  of.duration_s = samples.back().time_s;
  of.path_m = lengthOf(path);
  double sum_Ns = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    of.peak_force_N = std::max(of.peak_force_N, samples[i].force_N);
    const double before_s = i == 0 ? 0 : samples[i - 1].time_s;
    sum_Ns += samples[i].force_N * (samples[i].time_s - before_s);
  }
  if (of.duration_s > 0) of.mean_force_N = sum_Ns / of.duration_s;
  return of;
}

struct Deviation {
  double distance_m = std::numeric_limits<double>::infinity();
  double angle_rad = 0;
};

/// Deviation of a pose from the nearest point of a path.
Deviation deviationFrom(const std::vector<Pose>& path, const Pose& X) {
  Deviation nearest;
  Pose X_nearest = path.front();
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Pose &from = path[i], &to = path[std::min(i + 1, path.size() - 1)];
    const Vec3 leg = to.p - from.p;
    const double length2 = leg.squaredNorm();
    const double share = length2 > 0 ? std::clamp(leg.dot(X.p - from.p) / length2, 0.0, 1.0) : 0;
    const double distance_m = (X.p - from.p - share * leg).norm();
    if (distance_m >= nearest.distance_m) continue;
    nearest.distance_m = distance_m;
    X_nearest = interpolate(from, to, share);
  }
  nearest.angle_rad = rotationVector(X.R * X_nearest.R.transpose()).norm();
  return nearest;
}

void compareWays(const std::vector<Pose>& expert, const std::vector<Pose>& trainee, ComparedStep& step) {
  double sum_m2 = 0, length_m = 0;
  for (std::size_t i = 0; i < trainee.size(); ++i) {
    const Deviation here = deviationFrom(expert, trainee[i]);
    step.deviation_m = std::max(step.deviation_m, here.distance_m);
    step.deviation_rad = std::max(step.deviation_rad, here.angle_rad);
    const double piece_m = i == 0 ? 0 : (trainee[i].p - trainee[i - 1].p).norm();
    sum_m2 += here.distance_m * piece_m;
    length_m += piece_m;
  }
  step.mean_deviation_m = length_m > 0 ? sum_m2 / length_m : step.deviation_m;
}

double shareOf(double expert, double trainee, double least) {
  return std::min(1.0, std::max(expert, least) / std::max(trainee, least));
}

double trainingScore(const ComparedStep& step) {
  if (!step.is_done) return 0;
  constexpr double kLeast_s = 1e-3;
  const double shares = shareOf(step.expert.duration_s, step.trainee.duration_s, kLeast_s) +
                        shareOf(step.expert.path_m, step.trainee.path_m, kPathPiece_m) +
                        shareOf(step.expert.peak_force_N, step.trainee.peak_force_N, kLeastForce_N);
  return 100 * shares / 3;
}

ComparedStep compared(const RecordedStep& expert, const RecordedStep& trainee) {
  ComparedStep step;
  step.part = expert.part;
  step.is_done = trainee.is_done;
  const std::vector<Pose> expert_path = pathOf(expert.samples), trainee_path = pathOf(trainee.samples);
  step.expert = measuresOf(expert.samples, expert_path);
  step.trainee = measuresOf(trainee.samples, trainee_path);
  step.detour_m = step.trainee.path_m - step.expert.path_m;
  step.excess_force_N = step.trainee.peak_force_N - step.expert.peak_force_N;
  compareWays(expert_path, trainee_path, step);
  step.score = trainingScore(step);
  step.expert_samples = expert.samples;
  step.trainee_samples = trainee.samples;
  return step;
}

void noteDifferences(const device::RecordedRun& expert, const device::RecordedRun& trainee,
                     RunComparison& result) {
  for (const device::RecordedRun* run : {&expert, &trainee})
    if (!run->damage.empty()) result.notes.push_back(run->file + " " + run->damage);
  constexpr std::string_view kMesh = "mesh_hash.";
  for (const auto& [key, hash] : expert.head.about) {
    if (!key.starts_with(kMesh)) continue;
    const auto found = trainee.head.about.find(key);
    if (found != trainee.head.about.end() && found->second != hash)
      result.notes.push_back(std::string("'")  // operator+ makes GCC 12 warn of an overflow
                                 .append(key, kMesh.size())
                                 .append("' has another shape in the trainee's run"));
  }
}

}  // namespace

RunComparison compareRuns(const device::RecordedRun& expert, const device::RecordedRun& trainee) {
  RunComparison result;
  result.expert = expert.file;
  result.trainee = trainee.file;
  noteDifferences(expert, trainee, result);
  const std::vector<RecordedStep> reference = stepsOf(expert), tried = stepsOf(trainee);
  bool has_common = false;
  for (const RecordedStep& step : reference) {
    const auto found = std::ranges::find(tried, step.part, &RecordedStep::part);
    has_common = has_common || found != tried.end();
    if (found != tried.end()) {
      result.steps.push_back(compared(step, *found));
    } else {
      ComparedStep missing;
      missing.part = step.part;
      missing.expert = measuresOf(step.samples, pathOf(step.samples));
      missing.expert_samples = step.samples;
      result.steps.push_back(std::move(missing));
      result.notes.push_back("the trainee did not reach the step of '" + step.part + "'");
    }
    result.score += result.steps.back().score / static_cast<double>(reference.size());
  }
  if (!has_common)
    throw LoadError(trainee.file, "",
                    "moves no part that " + expert.file + " moves; record both with the same scene");
  return result;
}

}  // namespace vps::scenes
