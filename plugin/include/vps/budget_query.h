// SPDX-License-Identifier: BSD-3-Clause
// The wrench of queryWrench() within a budget of points or of time: coarse where it must be, and it says so.
#pragma once

#include <cstddef>
#include <limits>
#include <memory>

#include "vps/export.h"
#include "vps/query.h"

namespace vps {

/// What one call may cost; where both are given, the tighter holds.
struct QueryBudget {
  /// Readings of the field: points, and samples that decide which points are worth reading. A complete answer
  /// takes a tenth to a half more of them than queryWrench() reads points.
  std::size_t max_points = std::numeric_limits<std::size_t>::max();
  /// Wall-clock time [us].
  double max_us = std::numeric_limits<double>::infinity();
};

/// What an answer within a budget left out. Bounds hold for the field as it is read, whatever the parts.
struct BudgetReport {
  Status status = Status::Ok;     ///< Truncated when something was left coarse; BadPose as queryWrench()
  bool is_complete = false;       ///< the answer is queryWrench()'s, to the bit
  bool is_out_of_time = false;    ///< the clock cut it short, not the choice made beforehand
  std::size_t points_read = 0;    ///< readings of the field, never more than max_points
  std::size_t clusters_left = 0;  ///< clusters that may touch, some of whose share is one sample's
  double area_left_m2 = 0;     ///< surface of which one sample answers for many points; blended ones in part
  int coarsest_level = 0;      ///< a sample stood for up to 16^coarsest_level points; 0 when complete
  double force_error_N = 0;    ///< |f of queryWrench() - f| is no more
  double torque_error_Nm = 0;  ///< |tau of queryWrench() - tau| is no more
  double depth_bound_m = 0;    ///< no point of the shell is deeper
  /// The shell's least reading lies between these, and is known where they are equal: no point reads less
  /// than the first (the band means that far or farther), some point reads the second (infinite beyond the
  /// band). Budget that is left over does not go into it: queryDistance() is for that.
  double least_distance_m = 0, nearest_read_m = std::numeric_limits<double>::infinity();
  double time_us = 0;
};

/// Queries of one shell against one map that stop at a budget. Clusters of points (16, 256, 4096, ...) are
/// ranked by their area times what one sample of them is likely to be off, and refined in that order, coarse
/// to fine, while the budget lasts. A cluster left out is answered for by its sample: the point nearest to
/// its centre, with all of its area.
///
/// Continuous in the pose, for a given number of points and Gradient::Continuous: a cluster's own answer
/// comes in with a weight that is 0 at the rank of the first cluster left out and 1 at twice that rank; and
/// that rank is the same order statistic of continuous ranks at every pose, since what a cluster costs does
/// not depend on the pose. So refining another cluster, or a cluster coming near, makes no step.
///
/// A sample that touches may say far too much where little touches: watch force_error_N, which is honest but
/// wide, and plugin/README.md for what to expect. No temporal coherence: where poses are near each other
/// queryWrench() with a QueryMemory may cost less, and is exact.
class VPS_API BudgetQuery {
 public:
  /// Makes all the room it needs: about 130 bytes for each 16 points. The shell must outlive it and not
  /// change.
  BudgetQuery(const VoxMap& map, const PointShell& shell);
  ~BudgetQuery();
  BudgetQuery(BudgetQuery&&) noexcept;
  BudgetQuery& operator=(BudgetQuery&&) noexcept;

  /// As queryWrench(), within the budget. With max_points alone the same input gives the same bits, on every
  /// processor. With max_us it does not: time is turned into points by the rate of the calls before (which
  /// moves slowly, and the force with it), and the clock is looked at before each 256 points, so that it ends
  /// a batch of these after max_us at most, if the system lets it run; what is not read by then is answered
  /// for by its coarser samples. A budget too small for the sixteen coarsest samples gives a zero
  /// wrench, and its error. One thread at a time. Never throws, allocates, locks.
  /// @param options  gradient and simd; the others are not used
  /// @param out      wrench, area and volume estimate the whole shell; count and max_depth_m are of the
  ///                 points read one by one, and of all points read
  BudgetReport run(const Pose& X_MP, const QueryOptions& options, double k_N_per_m3, const Vec3& p_MO,
                   const QueryBudget& budget, TouchSummary& out) noexcept;

  [[nodiscard]] std::size_t memoryBytes() const noexcept;

 private:
  struct Rooms;
  std::unique_ptr<Rooms> rooms_;
};

}  // namespace vps
