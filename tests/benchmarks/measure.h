// SPDX-License-Identifier: BSD-3-Clause
// How things are timed: both sides in one process, in turns, the order of turns alternating.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "scene.h"
#include "subject.h"

namespace vps::bench {

/// What one repetition of a case found, by name: ours_us, rival_us, ratio, ...
using Counters = std::map<std::string, double>;

/// The value that a share of the values is not above. 0 for none.
double quantile(std::vector<double> values, double share);

/// CPU seconds of this process, all its threads.
double cpuSeconds();
/// Wall clock [s].
double wallSeconds();

/// While it lives TBB has one thread, for us and for OpenVDB alike.
class OneThread {
 public:
  OneThread();
  ~OneThread();

 private:
  struct Limit;
  std::unique_ptr<Limit> limit_;
};

struct StepCase {
  const VoxMap* map = nullptr;
  const PointShell* shell = nullptr;
  const RivalField* field = nullptr;  ///< null: ours alone
  Motion motion;
  SubjectOptions options;
  int steps = 1000;      ///< of ours in a repetition, at most
  int rival_steps = 24;  ///< spread over the same stretch of the motion; it has no memory of earlier steps
  double budget_s =
      2;  ///< of a repetition, for each side: fewer steps are taken where they would take longer
  bool with_nano = false;  ///< time NanoVDB too
};

/// One repetition: steps of the motion from `repetition` x steps on, in turns with the rival.
Counters measureSteps(const StepCase& steps, int repetition);

/// CPU seconds to build, on one thread.
Counters measureBuild(const Mesh& mesh, double voxel_m, int repetition);
/// Greatest error of nodes near the surface against the exact distance, and wrong signs among them; of ours
/// and of meshToVolume.
Counters measureBuildErrors(const Mesh& mesh, double voxel_m, int node_count);
/// Wall time to mount a part at another pose each repetition.
Counters measureMounting(const Mounting& mounting, const RivalField& base, const RivalField& mounted,
                         const Pose& X_BM, int repetition);

}  // namespace vps::bench
