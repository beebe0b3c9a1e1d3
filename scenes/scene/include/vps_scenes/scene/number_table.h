// SPDX-License-Identifier: BSD-3-Clause
// Tables of numbers in text files (touched points, recorded poses), and poses from numbers.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vps/pose.h"
#include "vps_scenes/export.h"

namespace vps::scenes {

struct NumberRow {
  std::vector<double> numbers;
  std::string place;  ///< "file:line", for messages
};

/// Reads rows of numbers, separated by commas, semicolons or blanks. '#' begins a comment, and a first row of
/// words is a heading. Throws LoadError with the line of a row that has not exactly `columns` finite numbers.
/// @param what  the columns in words, for messages
VPS_SCENES_API std::vector<NumberRow> readNumberTable(const std::string& file, std::size_t columns,
                                                      const std::string& what);

/// A pose from seven numbers, as in tables and in ROS 2.
/// @param n  x, y, z and a quaternion x, y, z, w
/// @return  empty if a number is not finite, or if the quaternion's length differs from 1 by more than 1e-3
///          (a quaternion with three digits is accepted)
VPS_SCENES_API std::optional<Pose> poseOf(std::span<const double, 7> n);

}  // namespace vps::scenes
