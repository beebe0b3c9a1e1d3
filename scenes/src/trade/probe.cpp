// SPDX-License-Identifier: BSD-3-Clause
#include "trade/probe.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "tick_times.h"
#include "vps/pair_query.h"

namespace vps {

namespace {

constexpr double kFiner = 0.35;              ///< spacing of the truth's samples by that of the scene's points
constexpr std::size_t kMostSamples = 40000;  ///< a side; more spacing where it would be more
constexpr double kReach_m = 0.3e-3;          ///< samples farther than this from all poses are left out
constexpr int kRepeats = 5;
constexpr double kStiffness_N_per_m3 = 1e12;  ///< any: only ratios of wrenches are reported

Box boxAt(const Mesh& mesh, const std::vector<Pose>& X_BPs) {
  Box box;
  for (const Pose& X_BP : X_BPs)
    for (const Vec3& p : mesh.vertices) box.add(X_BP * p);
  box.min -= Vec3::Constant(kReach_m);
  box.max += Vec3::Constant(kReach_m);
  return box;
}

/// What one side's samples say of another solid.
struct Touch {
  double least_m = std::numeric_limits<double>::infinity();
  Wrench F_S;  ///< on the samples' part about p_SO, in the solid's frame
};

/// Every sample that the solid's map does not put farther than its error is looked at exactly.
Touch exactTouch(const FitBody& solid, const std::vector<SurfaceSample>& samples, const Pose& X_SB,
                 const Vec3& p_SO) {
  std::vector<double> reading(samples.size());
  tbb::parallel_for(std::size_t{0}, samples.size(),
                    [&](std::size_t i) { reading[i] = solid.map->distance(X_SB * samples[i].p); });
  const double error_m = solid.map->sampleError_m();
  const double least_m = reading.empty() ? 0 : *std::min_element(reading.begin(), reading.end());
  const double cutoff_m = std::max(least_m + 2 * error_m, error_m);
  std::vector<MeshDistance::Closest> found(samples.size());
  std::vector<double> exact(samples.size(), std::numeric_limits<double>::infinity());
  tbb::parallel_for(std::size_t{0}, samples.size(), [&](std::size_t i) {
    if (reading[i] > cutoff_m || reading[i] >= solid.map->band_m()) return;
    const Vec3 p_S = X_SB * samples[i].p;
    found[i] = solid.distance->closest(p_S);
    const bool is_inside = (p_S - found[i].q).dot(found[i].normal) < 0;
    exact[i] = is_inside ? -found[i].distance_m : found[i].distance_m;
  });
  Touch touch;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    touch.least_m = std::min(touch.least_m, exact[i]);
    if (!(exact[i] < 0)) continue;
    const Vec3 f_S = kStiffness_N_per_m3 * samples[i].area_m2 * -exact[i] * found[i].normal;
    touch.F_S.f += f_S;
    touch.F_S.tau += (X_SB * samples[i].p - p_SO).cross(f_S);
  }
  return touch;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// |v - truth| by |truth|.
double relative(const Vec3& v, const Vec3& truth) {
  return truth.norm() > 0 ? (v - truth).norm() / truth.norm() : 0;
}

struct Reading {
  double distance_m = std::numeric_limits<double>::infinity();
  Wrench F_W;
  std::size_t points = 0;
};

/// The penalty wrench of one pair, as a haptic loop would ask for it; on P about its origin, in W.
Reading ask(const Part& fixed, const Pose& X_WM, const Part& held, const Pose& X_WP, const Fidelity& fidelity,
            bool is_exhaustive) {
  QueryOptions options;
  options.gradient = fidelity.gradient;
  options.is_exhaustive = is_exhaustive;
  const Pose X_MP = X_WM.inverse() * X_WP;
  TouchSummary sum;
  const QueryResult result =
      fidelity.sides == Sides::Both
          ? queryBothSides({fixed.map.get(), fixed.shell.get()}, {held.map.get(), held.shell.get()}, X_MP,
                           options, kStiffness_N_per_m3, X_MP.p, sum)
          : queryWrench(*fixed.map, *held.shell, X_MP, options, kStiffness_N_per_m3, X_MP.p, sum);
  Reading reading;
  reading.points = result.points_tested;
  reading.F_W.f = X_WM.R * sum.F_O_M.f;
  reading.F_W.tau = X_WM.R * sum.F_O_M.tau;
  return reading;
}

double leastDistance(const Part& fixed, const Pose& X_WM, const Part& held, const Pose& X_WP, Sides sides) {
  const Pose X_MP = X_WM.inverse() * X_WP;
  double least_m = queryDistance(*fixed.map, *held.shell, X_MP).min_distance_m;
  if (sides == Sides::Both)
    least_m = std::min(least_m, queryDistance(*held.map, *fixed.shell, X_MP.inverse()).min_distance_m);
  return least_m;
}

/// Reads all fixed parts; their wrenches add up.
Reading readAll(const Scene& scene, std::size_t moving, const Pose& X_WP, bool is_exhaustive) {
  Reading all;
  for (const ScenePart& part : scene.parts) {
    if (!part.is_fixed) continue;
    const Reading one =
        ask(part.part, part.X_WP, scene.parts[moving].part, X_WP, scene.fidelity, is_exhaustive);
    all.points += one.points;
    all.F_W.f += one.F_W.f;
    all.F_W.tau += one.F_W.tau;
  }
  return all;
}

TickTimes timeQueries(const Scene& scene, std::size_t moving, const std::vector<Pose>& poses,
                      bool is_exhaustive) {
  TickClock clock;
  for (int repeat = 0; repeat < kRepeats; ++repeat)
    for (const Pose& X_WP : poses) {
      clock.start();
      (void)readAll(scene, moving, X_WP, is_exhaustive);
      clock.stop();
    }
  return clock.summary();
}

}  // namespace

Probe::Probe(const Scene& scene, std::vector<Pose> poses, const Progress& progress)
    : moving_(scene.steps.front().part), poses_(std::move(poses)) {
  const auto bodyOf = [&](const ScenePart& part) {
    return makeFitBody(part.part, std::make_shared<MeshDistance>(part.part.mesh));
  };
  held_.body = bodyOf(scene.parts[moving_]);
  std::vector<Pose> X_PWs;
  for (const Pose& X_WP : poses_) X_PWs.push_back(X_WP.inverse());
  Box near_held;
  for (const ScenePart& part : scene.parts) {
    if (!part.is_fixed) continue;
    mounted_.push_back({bodyOf(part), part.X_WP, {}});
    fit_.mount(mounted_.back().body, part.X_WP);
    std::vector<Pose> X_PBs;
    for (const Pose& X_PW : X_PWs) X_PBs.push_back(X_PW * part.X_WP);
    const Box box = boxAt(part.part.mesh, X_PBs);
    near_held.add(box.min);
    near_held.add(box.max);
  }
  for (spacing_m_ = kFiner * scene.fidelity.spacing_m;; spacing_m_ *= 1.4) {
    held_.samples = sampleSurface(held_.body.distance->mesh(), spacing_m_, near_held);
    std::size_t most = held_.samples.size();
    for (Side& side : mounted_) {
      std::vector<Pose> X_BPs;
      for (const Pose& X_WP : poses_) X_BPs.push_back(side.X_WB.inverse() * X_WP);
      side.samples =
          sampleSurface(side.body.distance->mesh(), spacing_m_, boxAt(held_.body.distance->mesh(), X_BPs));
      most = std::max(most, side.samples.size());
    }
    if (most <= kMostSamples) break;
  }
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    if (progress) progress("exact surfaces", static_cast<double>(i) / static_cast<double>(poses_.size()));
    truths_.push_back(truthAt(poses_[i]));
  }
}

Probe::Truth Probe::truthAt(const Pose& X_WP) const {
  Truth truth;
  truth.distance_m = std::numeric_limits<double>::infinity();
  for (const Side& side : mounted_) {
    const Pose X_SP = side.X_WB.inverse() * X_WP;
    const Touch on_held = exactTouch(side.body, held_.samples, X_SP, X_SP.p);
    const Touch on_fixed = exactTouch(held_.body, side.samples, X_SP.inverse(), Vec3::Zero());
    truth.distance_m = std::min({truth.distance_m, on_held.least_m, on_fixed.least_m});
    // Half of each way, as queryBothSides(): both converge to the same force.
    truth.F_W.f += 0.5 * (side.X_WB.R * on_held.F_S.f - X_WP.R * on_fixed.F_S.f);
    truth.F_W.tau += 0.5 * (side.X_WB.R * on_held.F_S.tau - X_WP.R * on_fixed.F_S.tau);
  }
  const double depth_m = fit_.deepest(held_.body, X_WP).depth_m;
  if (depth_m > 0) truth.distance_m = std::min(truth.distance_m, -depth_m);
  return truth;
}

std::size_t Probe::posesInside() const {
  return static_cast<std::size_t>(
      std::count_if(truths_.begin(), truths_.end(), [](const Truth& t) { return t.distance_m < 0; }));
}

void Probe::measure(const Scene& scene, TradeRow& row) const {
  std::vector<double> forces, torques;
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const Truth& truth = truths_[i];
    double least_m = std::numeric_limits<double>::infinity();
    for (const ScenePart& part : scene.parts)
      if (part.is_fixed)
        least_m = std::min(least_m, leastDistance(part.part, part.X_WP, scene.parts[moving_].part, poses_[i],
                                                  scene.fidelity.sides));
    const Reading reading = readAll(scene, moving_, poses_[i], false);
    row.points_read += static_cast<double>(reading.points) / static_cast<double>(poses_.size());
    row.probe.distance_m = std::max(row.probe.distance_m, std::abs(least_m - truth.distance_m));
    if (truth.distance_m >= 0) continue;
    const double depth_m = std::max(0.0, -least_m);
    row.probe.penetration_m = std::max(row.probe.penetration_m, std::abs(depth_m + truth.distance_m));
    forces.push_back(relative(reading.F_W.f, truth.F_W.f));
    torques.push_back(relative(reading.F_W.tau, truth.F_W.tau));
  }
  row.probe.force = median(std::move(forces));
  row.probe.torque = median(std::move(torques));
  row.query = timeQueries(scene, moving_, poses_, false);
  row.all_points = timeQueries(scene, moving_, poses_, true);
  row.has_probe = true;
}

std::vector<Pose> probePoses(const Scene& scene, const AssembleResult& run, std::size_t count) {
  std::vector<const TraceRow*> touching;
  for (const TraceRow& row : run.trace)
    if (row.step == 0 && row.contacts > 0 && row.phase < 3) touching.push_back(&row);
  std::vector<Pose> poses;
  std::mt19937_64 random(1);
  // Not std::uniform_real_distribution: its numbers are the library's own affair.
  const auto draw = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  const double reach_m = scene.steps.front().clearance_m + 20e-6;
  for (std::size_t i = 0; i < std::min(count, touching.size()); ++i) {
    Pose X_WP = touching[i * touching.size() / std::min(count, touching.size())]->X_WP;
    const Vec3 way = Vec3(draw() - 0.5, draw() - 0.5, draw() - 0.5).normalized() * (draw() * reach_m);
    if (i % 2 == 1) X_WP.p += way;
    poses.push_back(X_WP);
  }
  return poses;
}

}  // namespace vps
