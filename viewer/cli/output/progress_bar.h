// SPDX-License-Identifier: BSD-3-Clause
// Shows the progress of long work on a terminal, from the first second on; elsewhere a line every ten
// seconds.
#pragma once

#include <chrono>
#include <string>

#include "vps/errors.h"

namespace vps::viewer {

class ProgressBar {
 public:
  ProgressBar();
  ~ProgressBar() { clear(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// A callback for the work, which refers to this bar. The callback throws Stopped after Ctrl-C.
  Progress progress() {
    return [this](std::string_view doing, double share) { show(doing, share); };
  }
  /// Clears the line for other output.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  void show(std::string_view doing, double share);

  bool is_on_ = false;
  bool is_drawn_ = false;
  Clock::time_point begun_, drawn_;
};

}  // namespace vps::viewer
