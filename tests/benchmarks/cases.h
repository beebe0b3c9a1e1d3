// SPDX-License-Identifier: BSD-3-Clause
// The rows of the speed table.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "measure.h"

namespace vps::bench {

/// The criterion of a row.
enum class Bar {
  None,
  RatioAtLeast,  ///< time of the rival / our time
  P99Below_us,
  TimeBelow_us,
  ShareAtMost,  ///< our bytes / bytes of the rival
};

struct Case {
  std::string name;  ///< for --benchmark_filter: peg/0.1mm/185030
  std::string row;   ///< text for the table
  Bar bar = Bar::None;
  double bar_value = 0;
  std::function<void()> check;  ///< throws if answers differ; may be empty
  std::function<Counters(int repetition)> measure;
};

/// All rows. Models are built when a row is checked or measured; rows on the same scene follow each other.
std::vector<Case> tableCases(const SceneSize& size);

}  // namespace vps::bench
