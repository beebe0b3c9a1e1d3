// SPDX-License-Identifier: BSD-3-Clause
// Tests whether the corners, sharp edges and facets of two parts come too near to each other within a step.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "vps/export.h"
#include "vps/feature_set.h"
#include "vps/pose.h"

namespace vps {

/// The place where a corner of one part reaches a facet of the other, or an edge reaches an edge, during the
/// motion from one relative pose to another.
struct FeatureContact {
  /// The feature of part 0, then that of part 1.
  enum class Kind : std::uint8_t { CornerOnFacet, FacetOnCorner, EdgeOnEdge };
  Kind kind = Kind::CornerOnFacet;
  std::uint32_t feature[2] = {0, 0};         ///< index in corners(), facets() or edges()
  double share = 0;                          ///< the share of the step at which the features touch, in [0, 1]
  Vec3 p[2] = {Vec3::Zero(), Vec3::Zero()};  ///< the points that meet, each in its part's own frame
  Vec3 n = Vec3::Zero();  ///< unit normal from part 1 to part 0, in the frame of part 1 or 0: see plane_of
  std::uint8_t plane_of = 1;  ///< the part with which the plane moves
  /// Directions of the edges of EdgeOnEdge: unit, each in its part's own frame.
  Vec3 along[2] = {Vec3::Zero(), Vec3::Zero()};
  double start_m = 0;  ///< distance of the features at the start, positive

  /// Distance of p[0] from p[1] along the plane's normal at a pose of part 1 in part 0.
  [[nodiscard]] VPS_API double gap_m(const Pose& X_01) const;
  /// The plane's normal in the frame of part 0 at the pose X_01.
  [[nodiscard]] VPS_API Vec3 normal_0(const Pose& X_01) const;
};

class MotionTube;

/// The features of two parts that are near each other, kept from step to step.
class VPS_API FeatureMotion {
 public:
  FeatureMotion();
  ~FeatureMotion();
  FeatureMotion(FeatureMotion&&) noexcept;
  FeatureMotion& operator=(FeatureMotion&&) noexcept;

  /// Sharp features rest at this gap instead of at zero, so that the direction between them is always known.
  /// A rolling polygon is stopped by a corner in front of it that is less than this gap above the lowest
  /// corner. Therefore the gap is as small as rounding allows: 100 times the solver's remaining error.
  static constexpr double kRest_m = 0.1e-6;
  /// The rest gap of two parts: kRest_m, but a thousandth of the smaller part's radius if that is below
  /// 0.1 mm.
  [[nodiscard]] static double rest_m(const FeatureSet& part0, const FeatureSet& part1);
  /// A pair is examined if its gap falls below this fraction of the rest gap, or of half its gap at the
  /// start.
  static constexpr double kLeastShare = 0.9;
  /// Features nearer than this many rest gaps are kept as contacts from step to step. Between features that
  /// are farther apart, the direction of the nearest points is not the direction in which the features will
  /// touch. Assumed.
  static constexpr double kKeptGaps = 4;
  /// Features whose gap at the end falls short by less than this fraction are not reported.
  static constexpr double kMissedShare = 0.5 * (1 - kLeastShare);

  /// Appends the features that come too near during the motion from `start` to `end` (poses of part 1 in part
  /// 0) and whose gap at the end is less than the rest gap and less than at the start. Each pair of features
  /// is reported with the plane in which the features touch first or, if they pass each other, in which they
  /// are nearest. The smaller part's centre moves on a straight line in the frame of the other part, and the
  /// smaller part turns at a constant rate. The motion is divided so that vertices on straight lines leave
  /// their arcs by at most a tenth of the rest gap.
  ///
  /// @param holds_close  also reports features that start nearer than a fifth of the rest gap and do not
  /// approach. Contacts then restore the gap, which would otherwise shrink by a rounding error in each step.
  ///
  /// A motion longer than a twentieth of the smaller part's radius is examined in segments of that length,
  /// until about a hundred contacts are found; the same features may be found in several segments.
  ///
  /// Edges that cross at the end, but not at the start, are reported as well if they approach by more than
  /// the deviation of the motion and of curved edges from straight lines. An edge that slides past the end of
  /// another edge is therefore held by the next edge.
  ///
  /// Features that intersect at the start are not detected. Features of curved surfaces that lie flush in
  /// each other, as a thread in its nut, are not detected either: pointshells find these contacts, with the
  /// normals of the curved surfaces, so that the surfaces slide smoothly.
  ///
  /// Cost: about 50 ns for each pair of features that may come near, 3 us for each pair that does come near,
  /// and a search for such pairs when the parts have left the motion that the last search covered, or reached
  /// its end. Allocates where the lists grow. Source: conservative advancement (Mirtich 1996), here along the
  /// separating plane of the nearest points, which sliding features never reach.
  void check(const FeatureSet& part0, const FeatureSet& part1, const Pose& start, const Pose& end,
             bool holds_close, std::vector<FeatureContact>& out);
  /// To be called when a part's features change.
  void reset() { is_valid_ = false; }

 private:
  struct Near {
    FeatureContact::Kind kind;
    std::uint32_t feature[2];
    double distance_m;  // lower bound, from the last measurement
    double path_m;      // path length of the parts at the last measurement
  };
  /// A segment of the motion of a step; poses of part 1 in part 0.
  struct Stretch {
    const Pose &start, &end;  // the first and last pose of the step
    const Pose &from, &to;    // the first and last pose of the segment
    bool is_last;
  };
  void search(const FeatureSet& part0, const FeatureSet& part1);
  void checkStretch(const FeatureSet& part0, const FeatureSet& part1, const Stretch& stretch,
                    bool holds_close, std::vector<FeatureContact>& out);

  std::vector<Near> near_;
  std::vector<Pose> way_10_;  // scratch
  bool is_valid_ = false;
  Pose last_;                         // X_01 of the last call
  std::unique_ptr<MotionTube> tube_;  // the tube of the last search
  double path_m_ = 0;                 // path length since the search, upper bound
};

/// Measures the features of a contact again at another pose of part 1 in part 0: points, plane and `start_m`.
/// Returns false, and the contact is then of no use, unless the features are separate at the new pose, by
/// more than 1 nm and less than most_m. Cost: about 100 ns.
VPS_API bool measureAgain(const FeatureSet& part0, const FeatureSet& part1, const Pose& X_01, double most_m,
                          FeatureContact& contact);

/// Upper bound of how far any vertex of the smaller part moves relative to the other part between two poses.
VPS_API double travel_m(const FeatureSet& part0, const FeatureSet& part1, const Pose& X_01_start,
                        const Pose& X_01_end);

}  // namespace vps
