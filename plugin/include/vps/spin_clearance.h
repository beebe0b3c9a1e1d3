// SPDX-License-Identifier: BSD-3-Clause
// How near two parts come to each other while one turns about an axis, at any angle.
#pragma once

#include "vps/export.h"
#include "vps/feature_set.h"
#include "vps/pose.h"

namespace vps::inline v0 {

/// Two parts of which one turns: a shaft in its bore, a wheel beside its fork. A part that turns uses up
/// every bound of how far its points move without coming nearer to the other part. But as long as its axis
/// stays in place, it stays within what it sweeps in a whole turn, whatever its angle.
class VPS_API SpinClearance {
 public:
  /// True if the parts are known to stay farther apart than least_m on the way between two poses of part 1 in
  /// part 0, with the axis about which they turn on a straight way. False says nothing. Cost: some 100 ns.
  /// When the parts turn by 20 mrad or more about an axis that is not known, and this was so in some calls
  /// before, a search of O(n log n) in their facets: at most one in 64 calls, and fewer where searches do not
  /// help. Allocates in searches.
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

  // Of the smaller part and of the larger one, each in its part's frame.
  Axis smaller_, larger_;
  double far_m_ = 0;        // greatest distance of a point of the smaller part from the place on its axis
  double clearance_m_ = 0;  // at any angle, with the axes in line; 0: not known
  int waits_ = 0, wait_ = kFirstWait;  // calls
  // assumed: slower parts do not leave what is near them in a step; a search costs as much as some steps
  static constexpr double kLeast_rad = 20e-3;
  static constexpr int kFirstWait = 4, kWait = 64, kMostWait = 4096;
};

}  // namespace vps::inline v0
