// SPDX-License-Identifier: BSD-3-Clause
// The operator's sight of the part: delayed, with an error that changes with each fixation of the eye.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "vps/pose.h"
#include "vps_device/operator.h"
#include "vps_device/random.h"

namespace vps::device {

class Sight {
 public:
  explicit Sight(const OperatorHabits& habits) : habits_(habits), random_(habits.seed ^ kStream) {}

  /// @param tip_P  the point at which the person looks, to which the error of position applies
  void begin(const Vec3& tip_P, double now_s) noexcept;
  /// Takes a visual sample if one is due. True if there is a new seen(), which is delayed.
  /// @param felt_m  offset that the hand feels now; felt_m() returns it with the picture of the same time
  bool look(const OperatorView& view, const Vec3& felt_m = Vec3::Zero()) noexcept;
  /// The offset that the hand felt at the time of seen().
  [[nodiscard]] const Vec3& felt_m() const noexcept { return felt_m_; }
  /// The seen pose of the part.
  [[nodiscard]] const Pose& seen() const noexcept { return X_seen_; }
  [[nodiscard]] bool hasSeen() const noexcept { return has_seen_; }

 private:
  struct Picture {
    double time_s = 0;
    Pose X_WP;
    Vec3 felt_m = Vec3::Zero();
  };
  static constexpr std::size_t kPictures = 64;  // length of the delay line
  // A random stream that differs from the stream of aim errors.
  static constexpr std::uint64_t kStream = 0x5159ac0ffee5;

  OperatorHabits habits_;
  Random random_;
  std::array<Picture, kPictures> pictures_{};
  std::size_t count_ = 0;
  double next_look_s_ = 0, next_fixation_s_ = 0;
  Vec3 tip_P_ = Vec3::Zero(), error_m_ = Vec3::Zero(), error_rad_ = Vec3::Zero();
  Vec3 felt_m_ = Vec3::Zero();
  Pose X_seen_;
  bool has_seen_ = false;
};

inline void Sight::begin(const Vec3& tip_P, double now_s) noexcept {
  tip_P_ = tip_P;
  count_ = 0;
  has_seen_ = false;
  next_look_s_ = next_fixation_s_ = now_s;
}

inline bool Sight::look(const OperatorView& view, const Vec3& felt_m) noexcept {
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
