// SPDX-License-Identifier: BSD-3-Clause
// The order in which strategies of insertion are tried.
//
//   approach -> touch -> seen near the target? -> press home -> done
//                 |  \-> in the hole already?  -> align by torque -> touch
//                 |  \-> it went on freely to the next land: the search begins anew there
//                 |  \-> a slender part: at the mouth of a second hole, perhaps -> spiral search there
//                 \----> align, then tilt in, spiral search and turn search in turn, each after backing off
#pragma once

#include "operator/sequence.h"

namespace vps::device {

class Insertion final : public Sequence {
 public:
  [[nodiscard]] bool hasTouched() const noexcept { return situation_.has_touched; }
  /// `along` where the part first touched: the mouth of its hole.
  [[nodiscard]] double firstMouth_m() const noexcept { return first_mouth_m_; }

 private:
  void reset() noexcept override;
  void prepare() noexcept override;
  [[nodiscard]] Strategy& present() noexcept override;
  void next(bool succeeded, const Feel& feel) noexcept override;
  [[nodiscard]] bool isFree(const Feel& feel) const noexcept;
  [[nodiscard]] OperatorStrategy nextSearch() const noexcept;
  void noteNextMouth(const Feel& feel) noexcept;
  void afterTouch(const Feel& feel) noexcept;
  void afterTouchInside(const Feel& feel) noexcept;
  void backOff(bool is_whole, const Feel& feel) noexcept;

  TiltIn tilt_in_;
  SpiralSearch spiral_search_;
  TurnSearch turn_search_;
  AlignByTorque align_;
  BackOff back_off_whole_{true}, back_off_little_{false};
  PressHome press_home_;
  bool has_aligned_ = false, is_whole_ = true;
  int stuck_inside_ = 0, searches_ = 0, searches_deeper_ = 0;
  double first_mouth_m_ = 0, approach_from_m_ = 0;
};

}  // namespace vps::device
