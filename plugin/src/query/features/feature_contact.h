// SPDX-License-Identifier: BSD-3-Clause
// The contact of two features: its place, its plane, and which feature has it.
#pragma once

#include <cstdint>
#include <span>

#include "query/features/feature_pair.h"
#include "vps/feature_motion.h"
#include "vps/feature_set.h"
#include "vps/pose.h"

namespace vps {

/// The contact of two features that were moved by a share of their displacement. The features touch along the
/// line between their nearest points or, near an edge, in the plane of the face onto which they slide.
/// Returns false if other features touch there first, or if pointshells handle this contact.
bool findContact(const FeatureSet& part0, const FeatureSet& part1, FeatureContact::Kind kind,
                 const std::uint32_t (&feature)[2], const Features& f, const Approach& reach,
                 const Mat3& R_10, FeatureContact& contact);

/// The contact of two edges that came near each other at an end of one of them, and that cross at the end of
/// the motion: they passed the corner during the motion.
/// @param n_1  from part 1 to part 0 at the place where they came near
bool findCrossing(const FeatureSet& part0, const FeatureSet& part1, const std::uint32_t (&feature)[2],
                  const Features& f, const Pose& end_10, const Vec3& n_1, FeatureContact& contact);

/// Distance of the features of a contact at a pose of part 1 in part 0.
double distanceAt(const FeatureSet& part0, const FeatureSet& part1, const FeatureContact& contact,
                  const Pose& X_01);

/// The feature that a corner touches when it passes the edge between two faces within the rest gap. The
/// direction between corner and edge does not tell which feature is touched: a corner that slides flush over
/// an edge would be stopped by it.
enum class BorderOwner {
  Facet,      ///< the corner passes the neighbour's plane above the facet, and is then over the facet
  Neighbour,  ///< the corner passes the facet's plane above the neighbour, and is then over the neighbour
  Edge,       ///< neither: the corner touches the edge, or the facet within its border
};

/// A corner of another part that passes a facet's border, in the frame of the facet's part.
struct PassingCorner {
  Vec3 r;                      ///< the corner relative to the facet's nearest point
  Vec3 way;                    ///< the corner's displacement relative to the facet
  std::span<const Vec3> rays;  ///< FeatureSet::raysAt(), in the frame of the corner's part
  Mat3 R;                      ///< rotation from the frame of the corner's part to that of the facet's part
};

/// Decides which feature of `part` the corner touches. A neighbour is left out if the corner's own surface
/// keeps the corner from touching it.
/// @param q  the facet's nearest point, in the part's frame
/// @param tolerated_m  how far below the face the corner may pass the other face's plane
BorderOwner ownerAtBorder(const FeatureSet& part, std::uint32_t facet, const Vec3& q,
                          const PassingCorner& corner, double tolerated_m);

/// True for features of curved surfaces that lie flush in each other, as a thread in its nut. Pointshells
/// find the contacts of such features, with the normals of the curved surfaces, so that the surfaces slide
/// smoothly.
/// @param R_10  rotation from the frame of part 0 to that of part 1
/// @param n_1  direction between the features, unit, in the frame of part 1
bool isLeftToPoints(const FeatureSet& part0, const FeatureSet& part1, const FeatureContact& contact,
                    const Mat3& R_10, const Vec3& n_1);

/// Distance of p from the line through side k of a facet; the side runs from corner k to the next.
/// @param p  a point in the part's frame
double distanceToSide(const FeatureSet& part, std::uint32_t facet, std::size_t k, const Vec3& p);

}  // namespace vps
