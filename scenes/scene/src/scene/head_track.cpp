// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/scene/head_track.h"

#include <algorithm>
#include <optional>
#include <span>

#include "text/pose_numbers.h"
#include "vps/errors.h"
#include "vps_scenes/scene/number_table.h"

namespace vps::scenes {

Pose HeadTrack::at(double t_s) const {
  const auto after = std::upper_bound(time_s.begin(), time_s.end(), t_s);
  if (after == time_s.begin()) return X_SE.front();
  if (after == time_s.end()) return X_SE.back();
  const auto i = static_cast<std::size_t>(after - time_s.begin());
  const double share = (t_s - time_s[i - 1]) / (time_s[i] - time_s[i - 1]);
  const Pose &a = X_SE[i - 1], &b = X_SE[i];
  return {a.quaternion().slerp(share, b.quaternion()), Vec3((1 - share) * a.p + share * b.p)};
}

HeadTrack loadHeadTrack(const std::string& file) {
  HeadTrack track;
  for (const NumberRow& row :
       readNumberTable(file, 8, "time [s], x, y, z [m] and quaternion x, y, z, w of a head in the room")) {
    const std::vector<double>& n = row.numbers;
    const std::optional<Pose> X_SE = poseOf(std::span(n).subspan<1, 7>());
    if (!X_SE)
      throw LoadError(row.place, "", "columns 5 to 8 are no rotation; expected a unit quaternion x, y, z, w");
    if (!track.time_s.empty() && n[0] <= track.time_s.back())
      throw LoadError(row.place, "", "is not later than the row before; put the rows in order of time");
    track.time_s.push_back(n[0]);
    track.X_SE.push_back(*X_SE);
  }
  if (track.time_s.empty()) throw LoadError(file, "", "has no row; record where the head is");
  return track;
}

}  // namespace vps::scenes
