// SPDX-License-Identifier: BSD-3-Clause
// What is measured: times of both sides in one process, alternating, after their answers were compared; and
// the errors of a voxmap's distance and normal against the mesh it was built from.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "scene.h"
#include "subject.h"

namespace vps::bench {

/// Results of one repetition of a case, by name: ours_us, rival_us, ratio, ...
using Counters = std::map<std::string, double>;

/// The quantile of the values at a share; 0 if there are no values.
double quantile(std::vector<double> values, double share);

/// CPU seconds of this process, all its threads.
double cpuSeconds();
/// Wall clock [s].
double wallSeconds();

/// While an object of this class exists, TBB uses one thread, for us and for OpenVDB.
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
  const RivalField* field = nullptr;  ///< null: only our side is measured
  Motion motion;
  SubjectOptions options;
  int steps = 1000;      ///< greatest number of our steps in a repetition
  int rival_steps = 24;  ///< steps of the rival, spread over the same range of the motion, since the rival
                         ///< does not use earlier steps
  double time_limit_s =
      2;  ///< time limit of a repetition for each side; fewer steps are made if they would take longer
  bool with_nano = false;  ///< also times NanoVDB
};

/// One repetition: steps of the motion, starting at step `repetition` x steps, alternating with the rival.
Counters measureSteps(const StepCase& steps, int repetition);

/// CPU seconds to build a map on one thread, for us and for the rival.
Counters measureBuild(const Mesh& mesh, double voxel_m, int repetition);
/// Greatest error of nodes near the surface against the exact distance, and the number of wrong signs, for
/// our map and for meshToVolume.
Counters measureBuildErrors(const Mesh& mesh, double voxel_m, int node_count);
/// Wall time to mount a part at another pose each repetition.
Counters measureMounting(const Mounting& mounting, const RivalField& base, const RivalField& mounted,
                         const Pose& X_BM, int repetition);

/// Makes `steps` steps of a motion with our engine and with OpenVDB reading the same values (the map, saved
/// as a .vdb file). Throws std::runtime_error that names the first difference: touching points, least
/// distance or wrench. meshToVolume's own field is not a reference: its error is up to half a voxel near
/// edges.
void requireAgreement(const std::string& name, const VoxMap& map, const PointShell& shell,
                      const SubjectOptions& options, const Motion& motion, int steps);

/// Mean, 99th percentile and greatest value.
struct Spread {
  double mean = 0, p99 = 0, most = 0;
};

struct AccuracyPoint {
  std::string shape;
  bool is_sharp = false;
  double voxel_m = 0;
  Spread distance_m;                     ///< error of the distance, against the exact distance to the mesh
  Spread continuous_rad, trilinear_rad;  ///< error of the normal, for both ways to read it
};

/// All shapes at all voxel sizes; samples lie within one voxel of the surface. Takes a minute or so.
std::vector<AccuracyPoint> accuracyStudy(int samples);

}  // namespace vps::bench
