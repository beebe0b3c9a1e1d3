// SPDX-License-Identifier: BSD-3-Clause
// The contact of two features: its place, its plane, and which feature has it.
#pragma once

#include "query/moving_features.h"
#include "vps/feature_motion.h"

namespace vps {

/// The contact of two features that were moved by a share of their way. The features touch along the line
/// between their nearest points or, near an edge, in the plane of the face onto which they slide. Returns
/// false if other features touch there first, or if pointshells handle this contact.
bool findContact(const FeatureSet& part0, const FeatureSet& part1, FeatureContact::Kind kind,
                 const std::uint32_t (&feature)[2], const Features& f, const Reach& reach, const Mat3& R_10,
                 FeatureContact& contact);

/// The contact of two edges that came near each other at an end of one of them, and that cross at the end of
/// the motion: they passed the corner during the motion.
/// @param n_1  from part 1 to part 0 at the place where they came near
bool findCrossing(const FeatureSet& part0, const FeatureSet& part1, const std::uint32_t (&feature)[2],
                  const Features& f, const Pose& end_10, const Vec3& n_1, FeatureContact& contact);

/// Distance of the features of a contact at a pose of part 1 in part 0.
double distanceAt(const FeatureSet& part0, const FeatureSet& part1, const FeatureContact& contact,
                  const Pose& X_01);

}  // namespace vps
