// SPDX-License-Identifier: BSD-3-Clause
// The contact of two features: where it is, in which plane, and whose it is.
#pragma once

#include "query/moving_features.h"
#include "vps/feature_motion.h"

namespace vps {

/// The contact of two features that were carried a share of their way, with its plane, where the features
/// touch along the line between their nearest points, or, near an edge, in the plane of the face that they
/// slide onto. False: other features are met there first, or points stand for these.
bool findContact(const FeatureSet& part0, const FeatureSet& part1, FeatureContact::Kind kind,
                 const std::uint32_t (&feature)[2], const Features& f, const Reach& reach, const Mat3& R_10,
                 FeatureContact& contact);

/// The contact of two edges that came near each other where one of them ends, and lie across each other at
/// the end of the motion: they passed the corner on the way.
/// @param n_1  from part 1 to part 0 where they came near
bool findCrossing(const FeatureSet& part0, const FeatureSet& part1, const std::uint32_t (&feature)[2],
                  const Features& f, const Pose& end_10, const Vec3& n_1, FeatureContact& contact);

/// Distance of the features of a contact at a pose of part 1 in part 0.
double distanceAt(const FeatureSet& part0, const FeatureSet& part1, const FeatureContact& contact,
                  const Pose& X_01);

}  // namespace vps
