// SPDX-License-Identifier: BSD-3-Clause
#include "trade/probe.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "judge/overlap_judge.h"
#include "trade/samples.h"
#include "vps/wrench.h"

namespace vps::scenes {

namespace {

/// Contact of one part's samples with another solid.
struct ExactContact {
  double least_m = std::numeric_limits<double>::infinity();
  Wrench F_S;  ///< wrench on the sampled part about p_SO, in the solid's frame S
};

/// Computes the exact distance of each sample that may touch; the solid's map, whose error is known, excludes
/// the other samples.
/// @param X_SB  pose of the sampled part B in the solid's frame S
/// @param p_SO  reference point of the wrench, in the solid's frame
/// @return the same bits for any number of threads. Costs O(samples), plus an exact distance for each near
/// sample.
ExactContact exactContact(const JudgedBody& solid, const std::vector<SurfaceSample>& samples,
                          const Pose& X_SB, const Vec3& p_SO) {
  std::vector<double> estimate_m(samples.size());
  tbb::parallel_for(std::size_t{0}, samples.size(),
                    [&](std::size_t i) { estimate_m[i] = solid.model->map->distance(X_SB * samples[i].p); });
  const double error_m = solid.model->map->sampleError_m();
  const double least_m = estimate_m.empty() ? 0 : *std::min_element(estimate_m.begin(), estimate_m.end());
  const double cutoff_m = std::max(least_m + 2 * error_m, error_m);
  std::vector<Solid::Closest> found(samples.size());
  std::vector<double> exact(samples.size(), std::numeric_limits<double>::infinity());
  tbb::parallel_for(std::size_t{0}, samples.size(), [&](std::size_t i) {
    if (estimate_m[i] > cutoff_m || estimate_m[i] >= solid.model->map->band_m()) return;
    const Vec3 p_S = X_SB * samples[i].p;
    found[i] = solid.model->solid->closest(p_S);
    const bool is_inside = (p_S - found[i].q).dot(found[i].normal) < 0;
    exact[i] = is_inside ? -found[i].distance_m : found[i].distance_m;
  });
  ExactContact contact;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    contact.least_m = std::min(contact.least_m, exact[i]);
    if (!(exact[i] < 0)) continue;
    const Vec3 f_S = kProbeStiffness_N_per_m3 * samples[i].area_m2 * -exact[i] * found[i].normal;
    contact.F_S.f += f_S;
    contact.F_S.tau += (X_SB * samples[i].p - p_SO).cross(f_S);
  }
  return contact;
}

constexpr double kFiner = 0.35;  ///< ratio of the exact samples' spacing to the scene's point spacing
constexpr std::size_t kMaxSamples =
    40000;                           ///< limit per part; the spacing grows if there would be more samples
constexpr double kReach_m = 0.3e-3;  ///< samples farther than this from all poses are left out

Box boxAt(const Mesh& mesh, const std::vector<Pose>& X_BPs) {
  Box box;
  for (const Pose& X_BP : X_BPs)
    for (const Vec3& p : mesh.vertices) box.add(X_BP * p);
  box.min -= Vec3::Constant(kReach_m);
  box.max += Vec3::Constant(kReach_m);
  return box;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// Relative deviation |v - truth| / |truth|.
double relative(const Vec3& v, const Vec3& truth) {
  return truth.norm() > 0 ? (v - truth).norm() / truth.norm() : 0;
}

}  // namespace

Probe::Probe(const Scene& scene, std::vector<Pose> poses, const Progress& progress)
    : moving_(scene.steps.front().part), poses_(std::move(poses)) {
  const auto bodyOf = [](const ScenePart& part) { return makeJudgedBody(part.model); };
  moving_body_.body = bodyOf(scene.parts[moving_]);
  std::vector<Pose> X_PWs;
  for (const Pose& X_WP : poses_) X_PWs.push_back(X_WP.inverse());
  Box near_moving;
  for (const ScenePart& part : scene.parts) {
    if (!part.is_fixed) continue;
    mounted_.push_back({bodyOf(part), part.X_WP, {}});
    judge_.mount(mounted_.back().body, part.X_WP);
    std::vector<Pose> X_PBs;
    for (const Pose& X_PW : X_PWs) X_PBs.push_back(X_PW * part.X_WP);
    const Box box = boxAt(part.part.mesh, X_PBs);
    near_moving.add(box.min);
    near_moving.add(box.max);
  }
  for (spacing_m_ = kFiner * scene.fidelity.spacing_m;; spacing_m_ *= 1.4) {
    moving_body_.samples = sampleSurface(moving_body_.body.model->solid->mesh(), spacing_m_, near_moving);
    std::size_t most = moving_body_.samples.size();
    for (SampledBody& fixed : mounted_) {
      std::vector<Pose> X_BPs;
      for (const Pose& X_WP : poses_) X_BPs.push_back(fixed.X_WB.inverse() * X_WP);
      fixed.samples = sampleSurface(fixed.body.model->solid->mesh(), spacing_m_,
                                    boxAt(moving_body_.body.model->solid->mesh(), X_BPs));
      most = std::max(most, fixed.samples.size());
    }
    if (most <= kMaxSamples) break;
  }
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    if (progress) progress("exact surfaces", static_cast<double>(i) / static_cast<double>(poses_.size()));
    truths_.push_back(truthAt(poses_[i]));
  }
}

Probe::Truth Probe::truthAt(const Pose& X_WP) const {
  Truth truth;
  truth.distance_m = std::numeric_limits<double>::infinity();
  for (const SampledBody& fixed : mounted_) {
    const Pose X_SP = fixed.X_WB.inverse() * X_WP;
    const ExactContact on_moving = exactContact(fixed.body, moving_body_.samples, X_SP, X_SP.p);
    const ExactContact on_fixed =
        exactContact(moving_body_.body, fixed.samples, X_SP.inverse(), Vec3::Zero());
    truth.distance_m = std::min({truth.distance_m, on_moving.least_m, on_fixed.least_m});
    // The wrench is the mean over both directions, as in queryBothSides(): the forces of both directions
    // converge to the same force.
    truth.F_W.f += 0.5 * (fixed.X_WB.R * on_moving.F_S.f - X_WP.R * on_fixed.F_S.f);
    truth.F_W.tau += 0.5 * (fixed.X_WB.R * on_moving.F_S.tau - X_WP.R * on_fixed.F_S.tau);
  }
  const double depth_m = judge_.deepest(moving_body_.body, X_WP).depth_m;
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
    const double least_m = leastDistance(scene, moving_, poses_[i]);
    const ModelResponse response = queryModels(scene, moving_, poses_[i], false);
    row.points_read += static_cast<double>(response.points) / static_cast<double>(poses_.size());
    row.probe.distance_m = std::max(row.probe.distance_m, std::abs(least_m - truth.distance_m));
    if (truth.distance_m >= 0) continue;
    const double depth_m = std::max(0.0, -least_m);
    row.probe.penetration_m = std::max(row.probe.penetration_m, std::abs(depth_m + truth.distance_m));
    forces.push_back(relative(response.F_W.f, truth.F_W.f));
    torques.push_back(relative(response.F_W.tau, truth.F_W.tau));
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
  SeededDraw draw(1);
  const double reach_m = scene.steps.front().clearance_m + 20e-6;
  for (std::size_t i = 0; i < std::min(count, touching.size()); ++i) {
    Pose X_WP = touching[i * touching.size() / std::min(count, touching.size())]->X_WP;
    const double length_m = draw() * reach_m;  // drawn before the direction, since the order
                                               // of draws matters; see inUnitCube()
    const Vec3 offset = draw.inUnitCube().normalized() * length_m;
    if (i % 2 == 1) X_WP.p += offset;
    poses.push_back(X_WP);
  }
  return poses;
}

}  // namespace vps::scenes
