// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/periodic_thread.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <stdexcept>

#include "vps/errors.h"

namespace vps::device {
namespace {

void waitUntil(const std::atomic<int>& value, int most) {
  while (value.load() < most) std::this_thread::yield();
}

TEST(PeriodicThread, BeatsUntilStoppedAndAgainAfterwards) {
  PeriodicThread thread({.rate_hz = 4000});
  EXPECT_FALSE(thread.isRunning());
  for (int round = 0; round < 3; ++round) {
    std::atomic<int> beats{0};
    std::int64_t due_ns = 0;
    bool is_in_order = true;
    thread.start([&](const Beat& beat) {
      if (beats.load() > 0) is_in_order = is_in_order && beat.due_ns - due_ns == beat.periods * 250'000;
      due_ns = beat.due_ns;
      ++beats;
    });
    EXPECT_TRUE(thread.isRunning());
    waitUntil(beats, 20);
    thread.stop();
    EXPECT_FALSE(thread.isRunning());
    const int ended = beats.load();
    std::this_thread::yield();
    EXPECT_EQ(beats.load(), ended);
    EXPECT_TRUE(is_in_order);
  }
}

TEST(PeriodicThread, AnExceptionOfTheWorkEndsTheThreadAndIsRethrownByStop) {
  PeriodicThread thread({.rate_hz = 10000});
  thread.start([](const Beat&) { throw std::runtime_error("the step failed"); });
  while (thread.isRunning()) std::this_thread::yield();
  EXPECT_THROW(thread.stop(), std::runtime_error);
  EXPECT_NO_THROW(thread.stop()) << "an exception is rethrown once";
}

TEST(PeriodicThread, RefusesARateOutOfRange) {
  for (const double rate_hz : {0.0, -1000.0, 1e9, std::nan("")})
    EXPECT_THROW(PeriodicThread({.rate_hz = rate_hz}), LoadError) << rate_hz;
}

TEST(RequestRealTime, ReportsWhatWasRefusedAndTheRemedy) {
  std::thread([] {
    const RealTimeReport none = requestRealTime(0, false);
    EXPECT_TRUE(none.warnings.empty()) << "without a request nothing is refused";
    const RealTimeReport report = requestRealTime(200, false);  // no system has such a priority
    EXPECT_FALSE(report.has_priority);
    ASSERT_EQ(report.warnings.size(), 1u);
    EXPECT_NE(report.warnings[0].find("priority"), std::string::npos);
    EXPECT_NE(report.warnings[0].find("ulimit -r"), std::string::npos);
  }).join();
}

}  // namespace
}  // namespace vps::device
