// SPDX-License-Identifier: BSD-3-Clause
// Whether the corners, sharp edges and facets of two parts come too near to each other within a step.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "vps/export.h"
#include "vps/feature_set.h"
#include "vps/pose.h"

namespace vps {

/// Where a corner of one part reaches a facet of the other, or an edge an edge, on the way from one relative
/// pose to another.
struct FeatureContact {
  enum class Kind : std::uint8_t { CornerOnFacet, FacetOnCorner, EdgeOnEdge };  ///< of part 0, on part 1
  Kind kind = Kind::CornerOnFacet;
  std::uint32_t feature[2] = {0, 0};         ///< index in corners(), facets() or edges()
  double share = 0;                          ///< of the step, in [0, 1]
  Vec3 p[2] = {Vec3::Zero(), Vec3::Zero()};  ///< the points that meet, each in its part's own frame
  Vec3 n = Vec3::Zero();      ///< from part 1 to part 0, unit, in the frame of part 1 or 0: see plane_of
  std::uint8_t plane_of = 1;  ///< the part with which the plane moves
  Vec3 along[2] = {Vec3::Zero(), Vec3::Zero()};  ///< of two edges: unit, each in its part's own frame
  double start_m = 0;                            ///< distance of the features at the start, positive

  /// Distance of p[0] from p[1] along the plane's normal at a pose of part 1 in part 0.
  [[nodiscard]] VPS_API double gap_m(const Pose& X_01) const;
  /// The plane's normal in the frame of part 0 at that pose.
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
  /// A polygon that rolls is stopped by a corner in front of it that is higher than the lowest one by less;
  /// the rest gap is as small as rounding allows, 100 times what the solver leaves.
  static constexpr double kRest_m = 0.1e-6;
  /// The same for two parts: less where the smaller one's radius is less than 0.1 mm, a thousandth of that.
  [[nodiscard]] static double rest_m(const FeatureSet& part0, const FeatureSet& part1);
  /// Features that come nearer than this share of it on the way are looked at, or than half of what they had.
  static constexpr double kLeastShare = 0.9;
  /// Features nearer than so many rest gaps are kept as contacts from step to step: between features that are
  /// farther apart, the direction of the nearest points is not the one in which they will touch. Assumed.
  static constexpr double kKeptGaps = 4;
  /// Features that end the way nearer than they may, by less than this share of it, are not reported.
  static constexpr double kMissedShare = 0.5 * (1 - kLeastShare);

  /// Appends the features that come too near on the way from `start` to `end` (poses of part 1 in part 0) and
  /// whose gap at the end is less than the rest gap and less than at the start, each with the plane in which
  /// they touch first, or, where they pass each other, in which they are nearest. On the way the smaller
  /// part's centre moves on a straight line in the frame of the other, and it turns evenly; between places on
  /// it, vertices move on straight lines, which leave their arcs by at most a tenth of the rest gap.
  ///
  /// @param holds_close  also those nearer than a fifth of the rest gap at the start that do not come nearer:
  /// held by contacts, the gap is restored, and does not creep to nothing by less than rounding in each step
  ///
  /// A way longer than a twentieth of the smaller part's radius is looked at in stretches that long, until
  /// some hundred contacts are found; the same features may be found in several.
  ///
  /// Edges that cross at the end, but not at the start, count as well if they come nearer on the way than the
  /// way and curved edges bend: so an edge that slides past the end of another is held by the next one.
  ///
  /// Features that intersect at the start are not seen. Neither are those of curved surfaces that lie flush
  /// in each other, as a thread in its nut: points of pointshells meet these along the normals of the curved
  /// surfaces, so that they slide smoothly.
  ///
  /// Cost: some 50 ns for each pair of features that may come near, 3 us for one that does, and a search for
  /// these pairs when the parts have left the motion for which the last one was made, or reached its end.
  /// Allocates where the lists grow. Source: conservative advancement (Mirtich 1996), here along the
  /// separating plane of the nearest points, which sliding features never reach.
  void check(const FeatureSet& part0, const FeatureSet& part1, const Pose& start, const Pose& end,
             bool holds_close, std::vector<FeatureContact>& out);
  /// To be called when a part's features change.
  void reset() { is_valid_ = false; }

 private:
  struct Near {
    FeatureContact::Kind kind;
    std::uint32_t feature[2];
    double distance_m;  // at least this when they were last measured
    double path_m;      // way of the parts until then
  };
  /// A piece of the way of a step; poses of part 1 in part 0.
  struct Stretch {
    const Pose &start, &end;  // of the step
    const Pose &from, &to;    // of the piece
    bool is_last;
  };
  void search(const FeatureSet& part0, const FeatureSet& part1);
  void checkStretch(const FeatureSet& part0, const FeatureSet& part1, const Stretch& stretch,
                    bool holds_close, std::vector<FeatureContact>& out);

  std::vector<Near> near_;
  std::vector<Pose> way_10_;  // scratch
  bool is_valid_ = false;
  Pose last_;                         // X_01 of the last call
  std::unique_ptr<MotionTube> tube_;  // of the search
  double path_m_ = 0;                 // way since the search, upper bound
};

/// Measures the features of a contact anew at another pose of part 1 in part 0: points, plane and `start_m`.
/// False where they are not near each other from outside there, at more than 1 nm and less than most_m; the
/// contact is then of no use. Cost: some 100 ns.
VPS_API bool measureAgain(const FeatureSet& part0, const FeatureSet& part1, const Pose& X_01, double most_m,
                          FeatureContact& contact);

/// Upper bound of how far any vertex of the smaller part moves relative to the other between two poses.
VPS_API double travel_m(const FeatureSet& part0, const FeatureSet& part1, const Pose& X_01_start,
                        const Pose& X_01_end);

}  // namespace vps
