// SPDX-License-Identifier: BSD-3-Clause
// How near two parts come to each other at any angle while one turns about an axis.
#pragma once

#include "vps/export.h"
#include "vps/feature_set.h"
#include "vps/pose.h"

namespace vps {

/// Clearance between two parts of which one turns: a shaft in its bore, a wheel next to its fork. Points of
/// the turning part move far without approaching the other part. As long as its axis stays in place, the part
/// stays within the volume that it sweeps in a whole turn.
class VPS_API SpinClearance {
 public:
  /// Returns true if the surfaces of the parts are known to stay farther apart than least_m >= 0 between two
  /// poses of part 1 in part 0, while the axis about which they turn moves on a straight line. Returns false
  /// if the distance is not known. A part that lies wholly inside the other's material is apart in this
  /// sense. Cost: about 100 ns. The fourth call in which the parts turn by 20 mrad or more about an axis that
  /// is not known makes a search of O(n log n) in their facets. The next search is made 64 such calls after a
  /// search that helped, otherwise after twice as many calls as the last time. Allocates in searches.
  /// @param part0, part1  the same parts in each call, until reset()
  bool staysApart(const FeatureSet& part0, const FeatureSet& part1, const Pose& start, const Pose& end,
                  double least_m);
  /// To be called when a part's features change.
  void reset() { *this = SpinClearance(); }

 private:
  struct Axis {
    Vec3 p = Vec3::Zero(), along = Vec3::UnitZ();
  };
  [[nodiscard]] double deviation_m(const Pose& start, const Pose& end) const;
  void search(const FeatureSet& smaller, const FeatureSet& larger, const Pose& start, const Pose& end,
              const Vec3& turn);

  Axis smaller_, larger_;              // of the smaller part and of the larger one, each in its part's frame
  double lever_m_ = 0;                 // greatest distance of a point of the smaller part from smaller_.p
  double clearance_m_ = 0;             // at any angle, with the axes in line; 0: not known
  int waits_ = 0, wait_ = kFirstWait;  // calls
  // Assumed: slower parts are cheap without a search; a search costs as much as some steps.
  static constexpr double kLeast_rad = 20e-3;
  static constexpr int kFirstWait = 4, kWait = 64, kMostWait = 4096;
};

}  // namespace vps
