// SPDX-License-Identifier: BSD-3-Clause
// The order in which a part is screwed on.
//
//   approach -> touch -> turn back until it drops -> screw on -> done
//      ^                                                |
//      '-- back off, and look again <- turn back <------'  it does not follow the thread
#pragma once

#include "operator/sequence.h"

namespace vps::device::inline v0 {

class Screwing final : public Sequence {
 public:
  void begin(const Situation& situation, const Feel& feel) noexcept override;
  Outcome step(const Feel& feel, double dt_s) noexcept override;

 private:
  [[nodiscard]] Strategy& present() noexcept;
  [[nodiscard]] const Strategy& present() const noexcept override {
    return const_cast<Screwing*>(this)->present();  // NOLINT
  }
  void start(OperatorStrategy strategy, const Feel& feel) noexcept;
  void next(bool succeeded, const Feel& feel) noexcept;

  Situation situation_;
  Approach approach_;
  Touch touch_;
  TurnBack turn_back_;
  ScrewOn screw_on_;
  BackOff back_off_{true};
  PlaceBySight place_by_sight_;
  bool is_coming_off_ = false;
};

}  // namespace vps::device::inline v0
