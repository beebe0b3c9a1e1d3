// SPDX-License-Identifier: BSD-3-Clause
// The order of entries in a recording of physics and of a loop in another process.
#include "haptics/merged_log.h"

#include <gtest/gtest.h>

#include <string>
#include <variant>

namespace vps::scenes {
namespace {

using device::SyncEventKind;

/// A log that describes each entry in words.
class Words final : public device::RunLog {
 public:
  void add(const device::LogEntry& entry) noexcept override {
    if (const auto* event = std::get_if<device::SyncEvent>(&entry))
      text += nameOf(event->kind) + std::to_string(event->tick) + " ";
    else if (std::holds_alternative<device::WrittenWrench>(entry))
      text += "wrench ";
    else
      text += std::holds_alternative<device::DeviceSample>(entry) ? "read " : "note ";
  }
  void lose(std::uint64_t count) noexcept override { text += "lost" + std::to_string(count) + " "; }
  std::string text;

 private:
  static std::string nameOf(SyncEventKind kind) {
    switch (kind) {
      case SyncEventKind::Tick:
        return "tick";
      case SyncEventKind::Step:
        return "step";
      case SyncEventKind::Begin:
        return "begin";
      case SyncEventKind::Silent:
        return "silent";
      default:
        return "paused";
    }
  }
};

class MergedLogTest : public testing::Test {
 protected:
  static device::SyncEvent event(SyncEventKind kind, std::int32_t tick) { return {0, tick, 1, 0, kind}; }
  void loopAdds(SyncEventKind kind, std::int32_t tick) { log_.addFromLoop(number_++, event(kind, tick)); }
  void loopTicks(std::int32_t tick) {
    loopAdds(SyncEventKind::Tick, tick);
    log_.addFromLoop(number_++, device::WrittenWrench{});
  }
  void step(std::int32_t tick) {
    log_.waitForTick(tick);
    log_.add(event(SyncEventKind::Step, tick));
  }

  Words words_;
  MergedLog log_{words_};
  std::uint32_t number_ = 0;
};

TEST_F(MergedLogTest, AStepWaitsForTheTicksThatItHasSeen) {
  step(2);
  log_.add(device::RunTrace{});
  EXPECT_EQ(words_.text, "");
  loopTicks(1);
  loopAdds(SyncEventKind::Tick, 2);
  EXPECT_EQ(words_.text, "tick1 wrench tick2 ");
  EXPECT_TRUE(log_.isWaiting());
  log_.addFromLoop(number_++, device::WrittenWrench{});
  EXPECT_EQ(words_.text, "tick1 wrench tick2 wrench step2 note ");
  EXPECT_FALSE(log_.isWaiting());
  loopTicks(3);
  step(2);  // no newer state has come
  EXPECT_EQ(words_.text, "tick1 wrench tick2 wrench step2 note step2 ");
}

TEST_F(MergedLogTest, ACommandFollowsTheTicksBeforeItAndPhysicsFollowsIt) {
  step(1);
  log_.waitForEvent(SyncEventKind::Begin);
  log_.add(device::RunTrace{});
  loopTicks(1);
  loopAdds(SyncEventKind::Begin, 1);
  EXPECT_EQ(words_.text, "tick1 wrench step1 begin1 note ");
}

// A part that is handed over is grasped at the present pose of the handle. A replay once read the device at
// the wrong position in the recording: at the step.
TEST_F(MergedLogTest, WhatACommandReadsOfTheDeviceFollowsTheStepBeforeIt) {
  step(1);
  log_.waitForEvent(SyncEventKind::Begin);
  loopTicks(1);
  log_.addFromLoop(number_++, device::DeviceSample{});
  loopAdds(SyncEventKind::Begin, 1);
  EXPECT_EQ(words_.text, "tick1 wrench step1 read begin1 ");
}

TEST_F(MergedLogTest, SilenceBelongsToTheTickThatFollows) {
  step(1);
  step(2);
  loopTicks(1);
  loopAdds(SyncEventKind::Silent, 1);
  loopTicks(2);
  loopTicks(3);
  EXPECT_EQ(words_.text, "tick1 wrench step1 silent1 tick2 wrench step2 ");
}

TEST_F(MergedLogTest, NothingIsAddedAfterALoss) {
  loopTicks(1);
  step(1);
  ++number_;
  loopTicks(2);
  log_.add(device::RunTrace{});
  step(2);
  loopTicks(3);
  EXPECT_EQ(words_.text, "tick1 wrench step1 lost1 ");
  EXPECT_FALSE(log_.isWaiting());
}

TEST_F(MergedLogTest, AnEntryThatComesTwiceIsOneLoss) {
  loopTicks(1);
  --number_;
  loopTicks(2);
  EXPECT_EQ(words_.text, "lost1 ");
}

}  // namespace
}  // namespace vps::scenes
