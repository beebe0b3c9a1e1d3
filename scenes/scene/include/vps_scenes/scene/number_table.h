// SPDX-License-Identifier: BSD-3-Clause
// Tables of numbers in text files: touched points, recorded poses.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "vps_scenes/export.h"

namespace vps::scenes {

struct NumberRow {
  std::vector<double> numbers;
  std::string place;  ///< "file:line", for messages
};

/// Rows of that many numbers, apart by commas, semicolons or blanks; '#' begins a comment, and a first row of
/// words is a heading. Throws LoadError with the line.
/// @param what  the columns in words, for messages
VPS_SCENES_API std::vector<NumberRow> readNumberTable(const std::string& file, std::size_t columns,
                                                      const std::string& what);

}  // namespace vps::scenes
