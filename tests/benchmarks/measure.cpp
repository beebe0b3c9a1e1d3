// SPDX-License-Identifier: BSD-3-Clause
#include "measure.h"

#include <tbb/global_control.h>
#include <time.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>

#include "vps/mesh_distance.h"

namespace vps::bench {

struct OneThread::Limit {
  tbb::global_control control{tbb::global_control::max_allowed_parallelism, 1};
};
OneThread::OneThread() : limit_(new Limit) {}
OneThread::~OneThread() = default;

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto last = static_cast<double>(values.size() - 1);
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(std::lround(share * last));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

double cpuSeconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double wallSeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

namespace {

/// Times of one side, and the points that touched.
struct Times {
  std::vector<double> us;
  double touching = 0;
  void add(double seconds, const Answer& answer) {
    us.push_back(1e6 * seconds);
    touching += static_cast<double>(answer.touching);
  }
  [[nodiscard]] double median() const { return quantile(us, 0.5); }
};

template <typename Side>
void timeStep(Side& side, const Motion& motion, int step, Times& times) {
  const Pose X_MP = motion(step);
  const double before_s = wallSeconds();
  const Answer answer = side.step(X_MP);
  times.add(wallSeconds() - before_s, answer);
}

/// The number of steps that fit into the time limit, estimated from one step.
template <typename Side>
int affordable(Side& side, const Motion& motion, int first, int wanted, double time_limit_s) {
  Times times;
  for (int k = 0; k < 3; ++k) timeStep(side, motion, first + k, times);
  return std::clamp(static_cast<int>(1e6 * time_limit_s / times.median()), std::min(wanted, 12), wanted);
}

/// The engine and its rival make the same steps in `kTurns` turns. At the start of a turn the caches hold the
/// data of the other side, which slows the first step of the turn, so one step is made before the clock
/// starts.
class Stretch {
 public:
  Stretch(const StepCase& steps, int repetition) : case_(steps), first_(repetition * steps.steps) {}

  template <typename Side>
  void run(Side& side, int turn, int steps, Times& times) const {
    const int in_turn = std::max(1, steps / kTurns), apart = std::max(1, case_.steps / (kTurns * in_turn));
    const int from = first_ + turn * in_turn * apart;
    side.step(case_.motion(from - 1));
    for (int k = 0; k < in_turn; ++k) timeStep(side, case_.motion, from + k * apart, times);
  }
  /// A side with temporal coherence takes every step of its turn.
  void runOurs(Subject& side, int turn, int steps, Times& times) const {
    const int in_turn = std::max(1, steps / kTurns), from = first_ + turn * (case_.steps / kTurns);
    side.step(case_.motion(from - 1));
    for (int k = 0; k < in_turn; ++k) timeStep(side, case_.motion, from + k, times);
  }
  static constexpr int kTurns = 4;
  [[nodiscard]] int first() const { return first_; }

 private:
  const StepCase& case_;
  int first_;
};

}  // namespace

Counters measureSteps(const StepCase& steps, int repetition) {
  const Stretch stretch(steps, repetition);
  Subject subject(*steps.map, *steps.shell, steps.options);
  const auto rival = steps.field ? openVdbQuery(*steps.field, *steps.shell, true) : nullptr;
  const auto nano = steps.field && steps.with_nano ? nanoVdbQuery(*steps.field, *steps.shell) : nullptr;
  const int ours_steps = affordable(subject, steps.motion, stretch.first(), steps.steps, steps.time_limit_s);
  Times ours, theirs, nanos;
  for (int turn = 0; turn < Stretch::kTurns; ++turn) {
    const bool ours_first = (turn + repetition) % 2 == 0;
    if (ours_first) stretch.runOurs(subject, turn, ours_steps, ours);
    if (rival) stretch.run(*rival, turn, steps.rival_steps, theirs);
    if (nano) stretch.run(*nano, turn, steps.rival_steps, nanos);
    if (!ours_first) stretch.runOurs(subject, turn, ours_steps, ours);
  }
  const auto points = static_cast<double>(steps.shell->size());
  Counters c{{"ours_us", ours.median()},
             {"p90_us", quantile(ours.us, 0.9)},
             {"p99_us", quantile(ours.us, 0.99)},
             {"ours_ns_per_point", 1e3 * ours.median() / points},
             {"touching", ours.touching / static_cast<double>(ours.us.size())},
             {"points", points},
             {"steps", static_cast<double>(ours.us.size())}};
  if (rival) {
    c["rival_us"] = theirs.median();
    c["rival_ns_per_point"] = 1e3 * theirs.median() / points;
    c["ratio"] = theirs.median() / ours.median();
  }
  if (nano) c["nano_ns_per_point"] = 1e3 * nanos.median() / points;
  return c;
}

Counters measureBuild(const Mesh& mesh, double voxel_m, int repetition) {
  const OneThread one_thread;
  Counters c;
  const auto ours = [&] {
    const double before_s = cpuSeconds();
    const VoxMap map = buildVoxMap(mesh, {voxel_m, kBandVoxels});
    c["ours_us"] = 1e6 * (cpuSeconds() - before_s);
  };
  const auto theirs = [&] {
    const double before_s = cpuSeconds();
    const auto field = buildOpenVdb(mesh, {voxel_m, kBandVoxels, true});
    c["rival_us"] = 1e6 * (cpuSeconds() - before_s);
  };
  if (repetition % 2 == 0) ours();
  theirs();
  if (repetition % 2 == 1) ours();
  c["ratio"] = c["rival_us"] / c["ours_us"];
  return c;
}

Counters measureBuildErrors(const Mesh& mesh, double voxel_m, int node_count) {
  const MeshDistance exact(mesh);
  const VoxMap map = buildVoxMap(mesh, {voxel_m, kBandVoxels});
  const auto field = buildOpenVdb(mesh, {voxel_m, kBandVoxels, true});
  std::mt19937 random(1);
  std::uniform_int_distribution<std::size_t> vertex(0, mesh.vertices.size() - 1);
  std::uniform_int_distribution<int> aside(-3, 3);
  Counters c{
      {"ours_error_voxels", 0}, {"rival_error_voxels", 0}, {"ours_wrong_signs", 0}, {"rival_wrong_signs", 0}};
  for (int k = 0; k < node_count; ++k) {
    const Vec3 near = mesh.vertices[vertex(random)] / voxel_m;
    int node[3];
    for (int axis = 0; axis < 3; ++axis)
      node[axis] = static_cast<int>(std::lround(near[axis])) + aside(random);
    const Vec3 p = voxel_m * Vec3(node[0], node[1], node[2]);
    const double true_voxels = exact.signedDistance(p) / voxel_m;
    if (std::abs(true_voxels) > kBandVoxels - 0.1) continue;
    const auto judge = [&](const std::string& side, double read_voxels) {
      double& worst = c[side + "_error_voxels"];
      worst = std::max(worst, std::abs(std::abs(read_voxels) - std::abs(true_voxels)));
      // Within 1e-3 voxel of the surface both signs agree with the stated error.
      if (std::abs(true_voxels) > 1e-3) c[side + "_wrong_signs"] += (read_voxels < 0) != (true_voxels < 0);
    };
    judge("ours", map.distance(p) / voxel_m);
    judge("rival", field->node(node[0], node[1], node[2]) / voxel_m);
  }
  return c;
}

Counters measureMounting(const Mounting& mounting, const RivalField& base, const RivalField& mounted,
                         const Pose& X_BM, int repetition) {
  const OneThread one_thread;
  Counters c;
  const Pose X = X_BM * Pose(rotationFromVector(0.01 * repetition * Vec3(1, 2, 3)), Vec3::Zero());
  const auto ours = [&] {
    const double before_s = wallSeconds();
    const VoxMap map = mounting.mount(X);
    c["ours_us"] = 1e6 * (wallSeconds() - before_s);
  };
  const auto theirs = [&] {
    const double before_s = wallSeconds();
    c["rival_voxels"] = static_cast<double>(mergeOpenVdb(base, mounted, X));
    c["rival_us"] = 1e6 * (wallSeconds() - before_s);
  };
  if (repetition % 2 == 0) ours();
  theirs();
  if (repetition % 2 == 1) ours();
  c["ratio"] = c["rival_us"] / c["ours_us"];
  return c;
}

}  // namespace vps::bench
