// SPDX-License-Identifier: BSD-3-Clause
// The order in which strategies of insertion are tried.
//
//   approach -> touch -> seen near the target? -> press home -> done
//                 |  \-> in the hole already?  -> align by torque -> touch
//                 \----> align, then tilt in, spiral search and turn search in turn, each after backing off
#pragma once

#include "operator/sequence.h"

namespace vps::device::inline v0 {

class Insertion final : public Sequence {
 public:
  void begin(const Situation& situation, const Feel& feel) noexcept override;
  Outcome step(const Feel& feel, double dt_s) noexcept override;

 private:
  [[nodiscard]] Strategy& present() noexcept;
  [[nodiscard]] const Strategy& present() const noexcept override {
    return const_cast<Insertion*>(this)->present();  // NOLINT
  }
  void start(OperatorStrategy strategy, const Feel& feel) noexcept;
  void next(bool succeeded, const Feel& feel) noexcept;
  [[nodiscard]] bool isFree(const Feel& feel) const noexcept;
  [[nodiscard]] OperatorStrategy nextSearch() const noexcept;
  void afterTouch(const Feel& feel) noexcept;
  void backOff(bool is_whole, const Feel& feel) noexcept;

  Situation situation_;
  Approach approach_;
  Touch touch_;
  TiltIn tilt_in_;
  SpiralSearch spiral_search_;
  TurnSearch turn_search_;
  AlignByTorque align_;
  BackOff back_off_whole_{true}, back_off_little_{false};
  PressHome press_home_;
  PlaceBySight place_by_sight_;
  bool has_aligned_ = false, is_whole_ = true;
  int stuck_inside_ = 0, searches_ = 0;
};

}  // namespace vps::device::inline v0
