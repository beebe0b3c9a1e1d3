// SPDX-License-Identifier: BSD-3-Clause
#include "operator/sight.h"

#include <algorithm>

namespace vps::device {

void Sight::begin(const Vec3& tip_P, double now_s) noexcept {
  tip_P_ = tip_P;
  count_ = 0;
  has_seen_ = false;
  next_look_s_ = next_fixation_s_ = now_s;
}

bool Sight::look(const OperatorView& view, const Vec3& felt_m) noexcept {
  if (view.time_s < next_look_s_) return false;
  next_look_s_ = view.time_s + 1 / habits_.see_rate_hz;
  if (view.time_s >= next_fixation_s_) {
    next_fixation_s_ = view.time_s + habits_.fixation_s;
    error_m_ = habits_.see_error_m * random_.normal3();
    error_rad_ = habits_.see_error_rad * random_.normal3();
  }
  const Mat3 R = rotationFromVector(error_rad_) * view.X_WP.R;
  const Vec3 p_tip = view.X_WP * tip_P_ + error_m_;
  pictures_[count_++ % kPictures] = {view.time_s, Pose(R, Vec3(p_tip - R * tip_P_)), felt_m};
  const std::size_t stored = std::min(count_, kPictures);
  for (std::size_t age = 0; age < stored; ++age) {
    const Picture& picture = pictures_[(count_ - 1 - age) % kPictures];
    if (picture.time_s > view.time_s - habits_.see_delay_s) continue;
    X_seen_ = picture.X_WP;
    felt_m_ = picture.felt_m;
    has_seen_ = true;
    break;
  }
  return has_seen_;
}

}  // namespace vps::device
