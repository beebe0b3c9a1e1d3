// SPDX-License-Identifier: BSD-3-Clause
// Pairs of parts in contact.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "vps/part_model.h"

namespace vps::bench {

/// Two parts of a fit, and what moves the second until they touch.
struct Fit {
  std::string name;
  Mesh mesh[2];
  std::vector<Pose> X_01;           ///< of part 1 in part 0, before it is moved along `way`
  Vec3 way = Vec3::Zero();          ///< unit, in part 0
  double play_m = 0;                ///< it meets within this
  double fine_m = 0, coarse_m = 0;  ///< voxels
  double spacing_m = 0;             ///< of the points
};

/// @param is_short  one pose each and the first two fits only
std::vector<Fit> allFits(bool is_short);

using Model = std::shared_ptr<const PartModel>;

Model modelOf(const Mesh& mesh, double voxel_m, double spacing_m);

/// The pose of the fit at which the parts touch: no point of either is more than 0.1 um inside the other.
Pose touching(const Fit& fit, const Pose& X_01, const Model (&model)[2]);

}  // namespace vps::bench
