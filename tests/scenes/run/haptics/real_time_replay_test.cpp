// SPDX-License-Identifier: BSD-3-Clause
// Runs in real time, recorded and replayed in simulated time.
#include <gtest/gtest.h>

#include "haptics/haptic_log.h"
#include "scenes/two_pins.h"
#include "support/device/fake_device.h"
#include "support/no_alloc.h"
#include "support/recorded.h"
#include "support/temporary_folder.h"
#include "vps_scenes/run/assemble.h"
#include "vps_scenes/run/replay.h"

namespace vps::scenes {
namespace {

/// A run that is recorded once for all tests, since it takes real time.
const test::Recorded& realTimeRecording() {
  static const test::Recorded recorded = [] {
    const test::TemporaryFolder folder;
    AssembleOptions options;
    options.is_real_time = true;
    Scene scene = twoPins();
    test::Recorded made;
    const std::string file = folder.path() / "run.mcap";
    made.result = assembleAndRecord(scene, file, options);
    made.run = device::loadRecording(file);
    return made;
  }();
  return recorded;
}

std::size_t countEvents(const device::RecordedRun& run, device::SyncEventKind kind) {
  std::size_t count = 0;
  for (const device::LogEntry& entry : run.entries) {
    const auto* event = std::get_if<device::SyncEvent>(&entry);
    count += event != nullptr && event->kind == kind;
  }
  return count;
}

TEST(RealTimeReplay, ARealTimeRunIsReplayedBitForBit) {
  const test::Recorded& recorded = realTimeRecording();
  EXPECT_EQ(recorded.run.damage, "");
  const ReplayResult replayed = replay(recorded.run);
  EXPECT_EQ(replayed.departure, "");
  EXPECT_EQ(replayed.equal, recorded.run.entries.size());
  test::expectSame(recorded.result, replayed.result);
}

TEST(RealTimeReplay, TheRecordingHoldsEachTickStepAndCommand) {
  const test::Recorded& recorded = realTimeRecording();
  EXPECT_EQ(countEvents(recorded.run, device::SyncEventKind::Tick), recorded.result.haptic.count);
  EXPECT_EQ(countEvents(recorded.run, device::SyncEventKind::Step), recorded.result.physics.count);
  EXPECT_EQ(countEvents(recorded.run, device::SyncEventKind::HandOver), 2u);
  EXPECT_EQ(countEvents(recorded.run, device::SyncEventKind::LetGo), 2u);
  EXPECT_EQ(countEvents(recorded.run, device::SyncEventKind::Settled), 2u);
  EXPECT_EQ(countEvents(recorded.run, device::SyncEventKind::Paused), 1u);
}

TEST(RealTimeReplay, ATruncatedRecordingRunsUpToItsEnd) {
  for (const double share : {0.1, 0.33331, 0.5, 0.77777}) {
    device::RecordedRun cut = realTimeRecording().run;
    for (int more = 0; more < 5; ++more) {  // cuts within a tick too
      device::RecordedRun some = cut;
      some.entries.resize(static_cast<std::size_t>(share * static_cast<double>(cut.entries.size())) +
                          static_cast<std::size_t>(more));
      some.damage = "ends in the middle of a record";
      const ReplayResult replayed = replay(some);
      EXPECT_EQ(replayed.departure, "") << share << " " << more;
      EXPECT_GE(replayed.equal + 3, some.entries.size());  // except for a truncated tick
    }
  }
}

TEST(RealTimeReplay, TicksWithOlderPhysicsStatesDepartFromTheRecording) {
  device::RecordedRun run = realTimeRecording().run;
  std::int32_t snapshot = 0;
  for (device::LogEntry& entry : run.entries) {
    auto* event = std::get_if<device::SyncEvent>(&entry);
    if (event == nullptr || event->kind != device::SyncEventKind::Tick || event->tick < 150 ||
        event->tick >= 200)
      continue;
    if (event->tick == 150) snapshot = event->snapshot;
    event->snapshot = snapshot;  // a tenth of a second of physics is ignored while the hand moves the part
  }
  const ReplayResult replayed = replay(run);
  EXPECT_NE(replayed.departure.find("/device/write: force_n"), std::string::npos) << replayed.departure;
}

TEST(HapticLog, AddsWithoutAllocatingAndCountsRefusedEntries) {
  test::KeptLog kept;
  HapticLog log(&kept);
  constexpr int kAdded = 3 * (1 << 15) / 2;
  {
    const vps_test::NoAllocScope guard;
    for (int i = 0; i < kAdded; ++i) log.add(device::SyncEvent{0, i, 1, 0, device::SyncEventKind::Tick});
  }
  log.passUpTo(kAdded);
  EXPECT_EQ(kept.entries.size(), std::size_t{1} << 15);
  EXPECT_EQ(kept.lost, 0u);  // reported with the next entry
  log.add(device::SyncEvent{0, kAdded, 1, 0, device::SyncEventKind::Tick});
  log.passUpTo(kAdded);
  EXPECT_EQ(kept.lost, static_cast<std::uint64_t>(kAdded - (1 << 15)));
}

TEST(HapticLog, PassesATicksEntriesOnlyOncePhysicsHasReachedIt) {
  test::KeptLog kept;
  HapticLog log(&kept);
  for (int tick = 1; tick <= 3; ++tick) {
    log.add(device::SyncEvent{0, tick, 1, 0, device::SyncEventKind::Tick});
    log.add(device::DeviceSample{});
    log.add(device::WrittenWrench{});
  }
  log.passUpTo(2);
  EXPECT_EQ(kept.entries.size(), 6u);
  log.passUpTo(2);
  EXPECT_EQ(kept.entries.size(), 6u);
  log.passUpTo(3);
  EXPECT_EQ(kept.entries.size(), 9u);
}

}  // namespace
}  // namespace vps::scenes
