// SPDX-License-Identifier: BSD-3-Clause
// Stops work at the n-th call of its progress callback.
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <string_view>

#include "vps/errors.h"

namespace vps::test {

/// Thrown by the callback; no function of the libraries may take it for an error of its own.
struct StopAsked {};

/// Runs the work with a callback that throws at its n-th call, for n = 1, 3, 7, 15, ... (late stops
/// take longest), until the work ends without a stop. Expects that the exception arrives and that no call
/// follows it.
/// @return the number of calls of the work that was not stopped
inline int stopAtEveryCall(const std::function<void(const Progress&)>& work) {
  for (int n = 1;; n += 1 + n) {
    std::atomic<int> calls = 0, after = 0;
    std::atomic<bool> has_thrown = false;
    const Progress progress = [&](std::string_view, double) {
      if (has_thrown) ++after;
      if (++calls != n) return;
      has_thrown = true;
      throw StopAsked();
    };
    bool is_stopped = false;
    try {
      work(progress);
    } catch (const StopAsked&) {
      is_stopped = true;
    }
    EXPECT_EQ(is_stopped, has_thrown) << "the stop at call " << n << " was lost";
    EXPECT_EQ(after, 0) << "calls after the stop at call " << n;
    if (!is_stopped) return calls;
  }
}

}  // namespace vps::test
