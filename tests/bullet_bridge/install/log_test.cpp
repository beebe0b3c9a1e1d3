// SPDX-License-Identifier: BSD-3-Clause
// Messages reach the host's hook, and a host that forgot a call is warned.
#include "vps_bullet/log.h"

#include <BulletCollision/CollisionDispatch/btCollisionDispatcherMt.h>
#include <LinearMath/btPoolAllocator.h>
#include <LinearMath/btThreads.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "bullet_bridge/world.h"
#include "log/report.h"

namespace vps::bullet {
namespace {

/// Collects the messages of its lifetime.
struct Kept {
  std::vector<std::pair<LogLevel, std::string>> messages;
  Kept() {
    setLogHook([this](LogLevel level, const std::string& message) { messages.emplace_back(level, message); });
  }
  ~Kept() {
    setLogHook({});
    setLogLevel(LogLevel::Warning);
  }
};

TEST(Log, PassesMessagesOfTheChosenLevelsToTheHook) {
  testing::internal::CaptureStderr();
  Kept kept;
  report(LogLevel::Info, "a");
  report(LogLevel::Warning, "b");
  setLogLevel(LogLevel::Info);
  report(LogLevel::Info, "c");
  setLogLevel(LogLevel::Error);
  report(LogLevel::Warning, "d");
  report(LogLevel::Error, "e");
  ASSERT_EQ(kept.messages.size(), 3u);
  EXPECT_EQ(kept.messages[0], std::pair(LogLevel::Warning, std::string("b")));
  EXPECT_EQ(kept.messages[1], std::pair(LogLevel::Info, std::string("c")));
  EXPECT_EQ(kept.messages[2], std::pair(LogLevel::Error, std::string("e")));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(Log, WithoutAHookWritesToStderr) {
  testing::internal::CaptureStderr();
  report(LogLevel::Warning, "a word");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "vps: a word\n");
}

TEST(Log, LimitsTheRateAndCountsWhatItLeavesOut) {
  Kept kept;
  // The messages of this test take far less than two seconds, so at most 3 * kLogLimit messages pass.
  for (int i = 0; i < 10 * kLogLimit; ++i) report(LogLevel::Warning, "again");
  EXPECT_GE(kept.messages.size(), 1u);
  EXPECT_LE(kept.messages.size(), 3u * kLogLimit);
}

TEST(Log, AHookThatThrowsDoesNotStopAStep) {
  setLogHook([](LogLevel, const std::string&) { throw std::runtime_error("no"); });
  EXPECT_NO_THROW(report(LogLevel::Error, "a"));
  setLogHook({});
}

TEST(Log, ReceivesWhatAStepFindsWrong) {
  Kept kept;
  test::World world;
  world.add(test::cube(), Pose(), true);
  world.add(test::cube(), Pose::translation(Vec3(0, 0, 0.009)));
  world.step();
  ASSERT_FALSE(kept.messages.empty());
  EXPECT_NE(kept.messages.back().second.find("inside each other"), std::string::npos);
}

TEST(ForgottenInstall, IsSaidOnceByTheShape) {
  // Runs in a separate process, since other tests of this program have called install().
  const auto forget = [] {
    int count = 0;
    setLogHook([&](LogLevel level, const std::string& message) {
      count += level == LogLevel::Error && message.find("install") != std::string::npos ? 1 : 0;
    });
    btDefaultCollisionConfiguration config;
    btCollisionDispatcher dispatcher(&config);
    btDbvtBroadphase broadphase;
    Solver solver;
    btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &config);
    btRigidBody body(btScalar(0.01), nullptr, test::cube().shape.get(), btVector3(1, 1, 1));
    world.addRigidBody(&body);
    const int at_first = count;
    for (int i = 0; i < 30; ++i) world.stepSimulation(toBt(1e-3), 0);
    world.removeRigidBody(&body);
    std::_Exit(at_first == 0 && count == 1 ? 0 : 10 + count);
  };
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(forget(), testing::ExitedWithCode(0), "");
}

TEST(Install, RefusesADispatcherOfAnotherPrecision) {
  // A pool of manifolds as in a program compiled in single precision.
  btPoolAllocator pool(static_cast<int>(sizeof(btPersistentManifold) / 2), 4);
  btDefaultCollisionConstructionInfo info;
  info.m_persistentManifoldPool = &pool;
  btDefaultCollisionConfiguration config(info);
  btCollisionDispatcher dispatcher(&config);
  try {
    install(dispatcher);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("precision"), std::string::npos) << error.what();
  }
}

TEST(Install, AcceptsAPoolOfLargerManifolds) {
  btPoolAllocator pool(static_cast<int>(2 * sizeof(btPersistentManifold)), 4);
  btDefaultCollisionConstructionInfo info;
  info.m_persistentManifoldPool = &pool;
  btDefaultCollisionConfiguration config(info);
  btCollisionDispatcher dispatcher(&config);
  EXPECT_NO_THROW(install(dispatcher));
  uninstall(dispatcher);
}

/// A task scheduler that claims to have some threads.
struct Claims : btITaskScheduler {
  int threads;
  explicit Claims(int count) : btITaskScheduler("claims"), threads(count) {}
  int getMaxNumThreads() const override { return threads; }
  int getNumThreads() const override { return threads; }
  void setNumThreads(int count) override { threads = count; }
  void parallelFor(int begin, int end, int, const btIParallelForBody& body) override {
    body.forLoop(begin, end);
  }
  btScalar parallelSum(int begin, int end, int, const btIParallelSumBody& body) override {
    return body.sumLoop(begin, end);
  }
};

TEST(Install, RefusesBulletsParallelDispatcherInWords) {
  btITaskScheduler* before = btGetTaskScheduler();
  btDefaultCollisionConfiguration config;
  for (const int threads : {1, 2}) {
    Claims scheduler(threads);
    btSetTaskScheduler(&scheduler);
    btCollisionDispatcherMt dispatcher(&config);
    if (threads == 1) {
      EXPECT_NO_THROW(install(dispatcher));
      uninstall(dispatcher);
      continue;
    }
    try {
      install(dispatcher);
      ADD_FAILURE() << "accepted";
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find("vps::bullet::Dispatcher"), std::string::npos) << error.what();
    }
    EXPECT_FALSE(isInstalled(dispatcher));
  }
  btSetTaskScheduler(before);
}

}  // namespace
}  // namespace vps::bullet
