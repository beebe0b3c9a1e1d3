// SPDX-License-Identifier: BSD-3-Clause
// Pointers of several processes in one session.
#include "vps_scenes/network/session_pointers.h"
#include "scenes/session_name.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "vps/errors.h"

namespace vps::scenes {
namespace {

/// Waits until a pointer changes, at most two seconds.
std::vector<SessionPointer> wait(SessionPointers& of) {
  for (int i = 0; i < 200; ++i) {
    std::vector<SessionPointer> changes = of.take();
    if (!changes.empty()) return changes;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return {};
}

TEST(SessionPointers, APointerIsSeenByTheOthersUntilItIsTakenBack) {
  SessionPointers a(sessionName("pointers")), b(sessionName("pointers"));
  a.point(3, Vec3(0.1, 0.2, 0.3));
  const std::vector<SessionPointer> seen = wait(b);
  ASSERT_EQ(seen.size(), 1U);
  EXPECT_EQ(seen[0].p_W, Vec3(0.1, 0.2, 0.3));
  EXPECT_GE(seen[0].who, 1000);
  EXPECT_TRUE(a.take().empty());  // own pointers are not reported
  a.point(3, {});
  const std::vector<SessionPointer> gone = wait(b);
  ASSERT_EQ(gone.size(), 1U);
  EXPECT_EQ(gone[0].who, seen[0].who);
  EXPECT_FALSE(gone[0].p_W);
}

TEST(SessionPointers, TwoWhoPointHaveDifferentNumbersAndALateOneSeesBoth) {
  SessionPointers a(sessionName("pointers")), b(sessionName("pointers"));
  a.point(1, Vec3(1, 0, 0));
  b.point(1, Vec3(2, 0, 0));
  for (int i = 0; i < 200; ++i) {  // more messages than a ring holds
    a.point(2, Vec3(0, i, 0));
    b.take();
  }
  a.point(2, {});
  SessionPointers late(sessionName("pointers"));
  std::vector<int> who;
  for (int i = 0; i < 100 && who.size() < 2; ++i) {
    a.take();  // repeats its own pointers
    b.take();
    for (const SessionPointer& pointer : late.take())
      if (pointer.p_W && pointer.p_W->y() == 0) who.push_back(pointer.who);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  ASSERT_EQ(who.size(), 2U);
  EXPECT_NE(who[0], who[1]);
}

TEST(SessionPointers, APointerGoesWithAProcessThatIsKilled) {
  const std::string session = sessionName("pointers");
  const pid_t pointing = fork();
  if (pointing == 0) {
    SessionPointers mine(session);
    mine.point(1, Vec3(1, 2, 3));
    for (;;) {
      mine.take();
      usleep(10000);
    }
  }
  SessionPointers watcher(session);
  const std::vector<SessionPointer> seen = wait(watcher);
  kill(pointing, SIGKILL);
  waitpid(pointing, nullptr, 0);
  ASSERT_EQ(seen.size(), 1U);
  const std::vector<SessionPointer> gone = wait(watcher);
  ASSERT_EQ(gone.size(), 1U);
  EXPECT_FALSE(gone[0].p_W);
  // The slot of the ended process is free again.
  SessionPointers next(session);
  next.point(1, Vec3(4, 5, 6));
  EXPECT_EQ(wait(watcher).at(0).who, seen[0].who);
}

TEST(SessionPointers, MoreThanTheSlotsAreNotSeenAndHarmNobody) {
  std::vector<std::unique_ptr<SessionPointers>> many;
  for (int i = 0; i <= SessionPointers::kMostPointing; ++i) {
    many.push_back(std::make_unique<SessionPointers>(sessionName("pointers")));
    many.back()->point(1, Vec3(i, 0, 0));
  }
  SessionPointers watcher(sessionName("pointers"));
  EXPECT_EQ(wait(watcher).size(), static_cast<std::size_t>(SessionPointers::kMostPointing));
}

TEST(SessionPointers, WhatIsNoPersonOrNoPlaceIsNotPassedOn) {
  SessionPointers a(sessionName("pointers")), b(sessionName("pointers"));
  a.point(0, Vec3(1, 1, 1));
  a.point(SessionPointers::kMostPersons + 1, Vec3(1, 1, 1));
  a.point(1, Vec3(0, 0, std::numeric_limits<double>::quiet_NaN()));
  a.point(7, Vec3(1, 1, 1));
  const std::vector<SessionPointer> seen = wait(b);
  ASSERT_EQ(seen.size(), 1U);
  EXPECT_EQ(seen[0].who % 1000, 7);
  EXPECT_THROW(SessionPointers("../etc"), LoadError);
  EXPECT_THROW(SessionPointers("demo.pointer1"), LoadError);
}

/// Pointers over UDP on this machine.
class NetworkPointers : public testing::Test {
 protected:
  void SetUp() override {
    try {
      a_ = std::make_unique<SessionPointers>(sessionName("pointers"), "lo");
      b_ = std::make_unique<SessionPointers>(sessionName("pointers"), "lo");
    } catch (const LoadError& error) {
      if (std::string(error.what()).find("this build has no network") == std::string::npos) throw;
      GTEST_SKIP() << "this build has no network";
    }
  }
  /// Waits until a pointer changes, at most eight seconds, while the other end repeats its pointers.
  static std::vector<SessionPointer> wait(SessionPointers& of, SessionPointers* other) {
    for (int i = 0; i < 800; ++i) {
      if (other != nullptr) other->take();
      std::vector<SessionPointer> changes = of.take();
      if (!changes.empty()) return changes;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return {};
  }
  std::unique_ptr<SessionPointers> a_, b_;
};

TEST_F(NetworkPointers, APointerIsSeenMovesAndIsTakenBack) {
  a_->point(3, Vec3(0.1, 0.2, 0.3));
  const std::vector<SessionPointer> seen = wait(*b_, a_.get());
  ASSERT_EQ(seen.size(), 1U);
  EXPECT_EQ(seen[0].p_W, Vec3(0.1, 0.2, 0.3));
  EXPECT_GE(seen[0].who, 1000);
  a_->point(3, Vec3(0.1, 0.2, 0.4));
  const std::vector<SessionPointer> moved = wait(*b_, a_.get());
  ASSERT_EQ(moved.size(), 1U);
  EXPECT_EQ(moved[0].p_W, Vec3(0.1, 0.2, 0.4));
  EXPECT_EQ(moved[0].who, seen[0].who);
  a_->point(3, {});
  const std::vector<SessionPointer> gone = wait(*b_, a_.get());
  ASSERT_EQ(gone.size(), 1U);
  EXPECT_FALSE(gone[0].p_W);
}

TEST_F(NetworkPointers, WhoFallsSilentPointsNoLonger) {
  a_->point(1, Vec3(1, 2, 3));
  ASSERT_EQ(wait(*b_, a_.get()).size(), 1U);
  a_.reset();
  const std::vector<SessionPointer> gone = wait(*b_, nullptr);
  ASSERT_EQ(gone.size(), 1U);
  EXPECT_FALSE(gone[0].p_W);
}

}  // namespace
}  // namespace vps::scenes
