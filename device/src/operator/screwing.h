// SPDX-License-Identifier: BSD-3-Clause
// The order in which a part is screwed on.
//
//   approach -> touch -> turn back until it drops -> screw on -> done
//      ^                                                |
//      '-- back off, and look again <- turn back <------'  it does not follow the thread
#pragma once

#include "operator/sequence.h"

namespace vps::device {

class Screwing final : public Sequence {
 private:
  void reset() noexcept override;
  void prepare() noexcept override;
  [[nodiscard]] Strategy& present() noexcept override;
  void next(bool succeeded, const Feel& feel) noexcept override;

  TurnBack turn_back_;
  ScrewOn screw_on_;
  BackOff back_off_{true};
  bool is_coming_off_ = false;
};

}  // namespace vps::device
