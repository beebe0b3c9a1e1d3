// SPDX-License-Identifier: BSD-3-Clause
// Says on a terminal how far long work is; silent elsewhere, and during the first second.
#pragma once

#include <chrono>
#include <string>

#include "vps/progress.h"

namespace vps::viewer {

class ProgressBar {
 public:
  ProgressBar();
  ~ProgressBar() { clear(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// A callback for the work. Holds this bar by reference. Throws Stopped after Ctrl-C.
  Progress progress() {
    return [this](std::string_view doing, double share) { show(doing, share); };
  }
  /// Wipes the line, so that what is printed next stands on a clean one.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  void show(std::string_view doing, double share);

  bool is_on_ = false;
  bool is_drawn_ = false;
  Clock::time_point begun_, drawn_;
};

}  // namespace vps::viewer
