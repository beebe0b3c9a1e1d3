// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/recording.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <limits>

#include <sys/wait.h>

#include "recording/log_fields.h"
#include "support/no_alloc.h"
#include "support/temporary_folder.h"
#include "vps/errors.h"
#include "vps_device/loop.h"
#include "vps_device/random.h"

namespace vps::device {
namespace {

namespace fs = std::filesystem;

void spill(const fs::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

DeviceSample sampleAt(int i) {
  Random random(static_cast<std::uint64_t>(i) + 1);
  DeviceSample sample;
  sample.X_DH = Pose{rotationFromVector(0.3 * random.normal3()), 0.01 * random.normal3()};
  sample.V_DH = {random.normal3(), random.normal3()};
  sample.time_s = i * 1e-3;
  return sample;
}

RecordingHead smallHead() {
  RecordingHead head;
  head.about = {{"version", "test"}, {"seed", "3"}};
  head.device = "puppet";
  head.limits.peak_force_N = 1.0 / 3;
  head.limits.workspace_max_D = Vec3(0.1, 0.2, 0.3);
  head.attachments = {{"scene", "text/plain", "a scene"}};
  return head;
}

/// A few entries of every kind, with numbers that decimal text would not preserve.
std::vector<LogEntry> everyKind() {
  std::vector<LogEntry> entries;
  RunEvent event;
  event.step = 0;
  event.kind = RunEventKind::Phase;
  event.phase = 2;
  event.setWords("takes 'peg', \"the\" one");
  entries.push_back(event);
  for (int i = 0; i < 4; ++i) {
    DeviceSample sample = sampleAt(i);
    if (i == 2) sample.X_DH.p = Vec3(-0.0, std::bit_cast<double>(0x7ff8000000000123ull), 5e-324);
    if (i == 3) sample.status = Status::Fault;
    entries.push_back(sample);
    entries.push_back(WrittenWrench{sample.time_s, {Vec3(1, 2, 3) / 7, Vec3(-HUGE_VAL, 0, 1e300)}});
  }
  RunTrace trace;
  trace.time_s = 3e-3;
  trace.contacts = -5;
  trace.X_WP = sampleAt(9).X_DH;
  entries.push_back(trace);
  return entries;
}

std::string recorded(const std::vector<LogEntry>& entries) {
  const test::TemporaryFolder folder;
  const std::string file = folder.path() / "run.mcap";
  Recorder recorder(file, smallHead());
  for (const LogEntry& entry : entries) recorder.add(entry);
  recorder.finish();
  return test::bytesOf(file);
}

/// Number of leading entries that equal those of `truth`.
std::size_t equalEntries(const RecordedRun& run, const std::vector<LogEntry>& truth) {
  EXPECT_LE(run.entries.size(), truth.size());
  for (std::size_t i = 0; i < run.entries.size(); ++i)
    EXPECT_EQ(log::difference(truth[i], run.entries[i]), "") << i;
  return run.entries.size();
}

std::string whyRefused(const std::function<void()>& act) {
  try {
    act();
  } catch (const LoadError& error) {
    return error.what();
  }
  return "";
}

TEST(Recording, EveryBitIsReadBack) {
  const std::vector<LogEntry> truth = everyKind();
  const RecordedRun run = recordingFrom(recorded(truth), "run.mcap");
  EXPECT_EQ(run.damage, "");
  ASSERT_EQ(equalEntries(run, truth), truth.size());
  const auto& odd = std::get<DeviceSample>(run.entries[5]);
  EXPECT_TRUE(std::signbit(odd.X_DH.p.x()));
  EXPECT_EQ(std::bit_cast<std::uint64_t>(odd.X_DH.p.y()), 0x7ff8000000000123ull);
  EXPECT_EQ(run.head.device, "puppet");
  EXPECT_EQ(run.head.limits.peak_force_N, 1.0 / 3);
  EXPECT_EQ(run.head.limits.workspace_max_D, Vec3(0.1, 0.2, 0.3));
  EXPECT_EQ(run.head.about.at("seed"), "3");
  ASSERT_NE(run.attachment("scene"), nullptr);
  EXPECT_EQ(run.attachment("scene")->data, "a scene");
}

TEST(Recording, TheSameRunGivesTheSameFile) {
  EXPECT_EQ(recorded(everyKind()), recorded(everyKind()));
}

TEST(Recording, CutAtAnyByteItIsReadUpToTheCutAndReportsIt) {
  const std::vector<LogEntry> truth = everyKind();
  const std::string whole = recorded(truth);
  std::size_t kept = 0, opened = 0;
  for (std::size_t length = 0; length < whole.size(); ++length) {
    std::string why;
    try {
      const RecordedRun run = recordingFrom(std::string_view(whole).substr(0, length), "run.mcap");
      ASSERT_NE(run.damage, "") << length;
      const std::size_t now = equalEntries(run, truth);
      ASSERT_GE(now, kept) << length;
      kept = now;
      ++opened;
    } catch (const LoadError& error) {
      ASSERT_EQ(opened, 0u) << length << error.what();  // a file is refused only while its head is incomplete
      EXPECT_EQ(std::string(error.what()).find("run.mcap: "), 0u);
    }
  }
  EXPECT_EQ(kept, truth.size());
}

TEST(Recording, EveryChangedByteIsReportedAndNoWrongEntryReturned) {
  const std::vector<LogEntry> truth = everyKind();
  const std::string whole = recorded(truth);
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::string bytes = whole;
    bytes[at] = static_cast<char>(bytes[at] ^ (at % 2 == 0 ? 0x01 : 0xff));
    try {
      const RecordedRun run = recordingFrom(bytes, "run.mcap");
      EXPECT_NE(run.damage, "") << at;
      equalEntries(run, truth);
    } catch (const LoadError& error) {
      EXPECT_EQ(std::string(error.what()).find("run.mcap: "), 0u);
    }
  }
}

TEST(Recording, DamageIsReportedWithByteAndTime) {
  const std::string whole = recorded(everyKind());
  const RecordedRun cut = recordingFrom(std::string_view(whole).substr(0, whole.size() - 3), "x");
  EXPECT_NE(cut.damage.find("lacks the end of its index"), std::string::npos) << cut.damage;
  EXPECT_NE(cut.damage.find("kept: 4 device samples, up to 0.003 s"), std::string::npos) << cut.damage;
}

TEST(Recorder, AnExistingFileStaysUntilFinish) {
  const test::TemporaryFolder folder;
  const fs::path file = folder.path() / "run.mcap";
  { Recorder(file, smallHead()).finish(); }
  const std::string before = test::bytesOf(file);
  {
    Recorder recorder(file, smallHead());
    recorder.add(sampleAt(0));
    EXPECT_EQ(test::bytesOf(file), before);
    EXPECT_TRUE(fs::exists(recorder.unfinished()));
    recorder.finish();
    EXPECT_FALSE(fs::exists(recorder.unfinished()));
  }
  EXPECT_EQ(loadRecording(file).reads(), 1u);
}

TEST(Recorder, RefusesToOverwriteAFileThatIsNoRecording) {
  const test::TemporaryFolder folder;
  const fs::path letter = folder.path() / "letter.txt", foreign = folder.path() / "bag.mcap";
  spill(letter, "dear reader");
  std::string bag;
  McapWriter([&](std::string_view piece) { bag += piece; }, "ros2", "somebody else").finish();
  spill(foreign, bag);
  for (const fs::path& file : {letter, foreign, folder.path(), folder.path() / "no" / "run.mcap"}) {
    const std::string why = whyRefused([&] { Recorder(file, smallHead()).finish(); });
    EXPECT_EQ(why.find(file.string() + ": "), 0u) << why;
  }
  EXPECT_EQ(test::bytesOf(letter), "dear reader");
  EXPECT_EQ(test::bytesOf(foreign), bag);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 2);  // no temporary file is left
  EXPECT_NE(whyRefused([&] { loadRecording(foreign); }), "");
  EXPECT_NE(whyRefused([&] { loadRecording(letter); }), "");
  EXPECT_NE(whyRefused([&] { loadRecording(folder.path()); }), "");
}

TEST(Recorder, WithoutASampleNoFileIsLeft) {
  const test::TemporaryFolder folder;
  { Recorder recorder(folder.path() / "run.mcap", smallHead()); }
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(Recorder, AKilledProgramLeavesARecordingUpToAQuarterSecondBefore) {
  const test::TemporaryFolder folder;
  const std::string file = folder.path() / "run.mcap";
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    Recorder recorder(file, smallHead());
    for (int i = 0; i < 2000; ++i) {
      recorder.waitForRoom();
      recorder.add(sampleAt(i));
    }
    ::usleep(300'000);  // many times the writing thread's polling interval
    std::raise(SIGKILL);
  }
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status));
  ASSERT_FALSE(fs::exists(file));
  const RecordedRun run = loadRecording(fs::directory_iterator(folder.path())->path());
  EXPECT_NE(run.damage.find("ends without its closing record"), std::string::npos) << run.damage;
  // A chunk holds 250 ms of samples or 64 KiB of messages; at 1 kHz the limit is 250 samples.
  EXPECT_GE(run.entries.size(), 1750u);
  for (std::size_t i = 0; i < run.entries.size(); ++i)
    ASSERT_EQ(log::difference(sampleAt(static_cast<int>(i)), run.entries[i]), "");
}

TEST(Recorder, AFullRingDropsEntriesCountsAndReportsThem) {
  const test::TemporaryFolder folder;
  const std::string file = folder.path() / "run.mcap";
  Recorder recorder(file, smallHead(), 4);
  // Entries come far faster than a thread that polls every 5 ms can write.
  for (int i = 0; i < 100'000; ++i) recorder.add(sampleAt(i % 100));
  recorder.finish();
  EXPECT_GT(recorder.dropped(), 0u);
  const RecordedRun run = loadRecording(file);
  EXPECT_LT(run.entries.size(), 100'000u);
  EXPECT_NE(run.damage.find("too fast"), std::string::npos) << run.damage;
}

TEST(Recorder, AddingNeverAllocates) {
  const test::TemporaryFolder folder;
  Recorder recorder(folder.path() / "run.mcap", smallHead(), 16);
  const std::vector<LogEntry> entries = everyKind();
  const vps_test::NoAllocScope guard;
  for (int i = 0; i < 100; ++i)
    for (const LogEntry& entry : entries) recorder.add(entry);
}

// Recordings made before the channel was renamed hold sync events on /run/meeting.
TEST(Recording, SyncEventsOnTheOldChannelNameAreRead) {
  const test::TemporaryFolder folder;
  const std::string file = folder.path() / "run.mcap";
  const std::vector<LogEntry> entries = {DeviceSample{}, SyncEvent{0.5, 7, 2, 3, SyncEventKind::LetGo},
                                         WrittenWrench{}};
  {
    Recorder recorder(file, smallHead());
    for (const LogEntry& entry : entries) recorder.add(entry);
    recorder.finish();
  }
  std::ifstream in(file, std::ios::binary);
  const std::string now(std::istreambuf_iterator<char>(in), {});
  const McapContent content = readMcap(now);
  std::string old;
  McapWriter writer([&](std::string_view piece) { old += piece; }, content.profile, content.library);
  for (const auto& [id, schema] : content.schemas)
    writer.addSchema(schema.name, schema.encoding, schema.data);
  for (const auto& [id, channel] : content.channels) {
    McapChannel renamed = channel;
    if (renamed.topic == "/run/sync_event") renamed.topic = "/run/meeting";
    writer.addChannel(renamed);
  }
  for (const McapMetadata& metadata : content.metadata) writer.addMetadata(metadata);
  for (const McapMessage& m : content.messages) writer.write(m.channel, m.sequence, m.time_ns, m.data);
  writer.finish();
  ASSERT_EQ(old.find("/run/sync_event"), std::string::npos);
  const RecordedRun run = recordingFrom(old, "old.mcap");
  EXPECT_EQ(run.damage, "");
  ASSERT_EQ(run.entries.size(), 3u);
  for (std::size_t i = 0; i < entries.size(); ++i) EXPECT_EQ(log::difference(run.entries[i], entries[i]), "");
}

// --- As a device

/// A device whose handle oscillates.
class Oscillator final : public Device {
 public:
  DeviceSample read() noexcept override {
    DeviceSample sample;
    sample.time_s = 1e-3 * n_++;
    sample.X_DH.p.x() = 1e-3 * std::sin(20 * sample.time_s);
    return sample;
  }
  void write(const Wrench&) noexcept override {}
  [[nodiscard]] DeviceLimits limits() const noexcept override { return {}; }
  [[nodiscard]] std::string_view name() const noexcept override { return "oscillator"; }

 private:
  int n_ = 0;
};

/// Runs the loop for some ticks; it holds a part that does not move.
void hold(Device& device, double k_N_per_m, int ticks) {
  CouplingPort port;
  LoopSettings settings;
  settings.gains.k_N_per_m = k_N_per_m;
  HapticLoop loop(device, port, settings);
  loop.grasp(Pose{});
  port.physics.write({{Pose{}, Twist{}, 0, true}, 0, {}, {}});
  for (int i = 0; i < ticks; ++i) loop.tick();
}

RecordedRun swungRun() {
  const test::TemporaryFolder folder;
  const std::string file = folder.path() / "run.mcap";
  Oscillator device;
  Recorder recorder(file, smallHead());
  TappedDevice tapped(device, recorder);
  hold(tapped, 1000, 400);
  recorder.finish();
  return loadRecording(file);
}

TEST(Recording, DrivesALoopToTheSameWrenches) {
  Recording device(swungRun());
  ReplayCheck check(device.run());
  TappedDevice tapped(device, check);
  hold(tapped, 1000, 400);
  EXPECT_EQ(check.departure(), "");
  EXPECT_EQ(check.equal(), 801u);  // one read for the grasp, then 400 reads and 400 writes
  EXPECT_EQ(check.left(), 0u);
}

TEST(Recording, ADepartureIsReportedWithTickChannelAndField) {
  Recording device(swungRun());
  ReplayCheck check(device.run());
  TappedDevice tapped(device, check);
  hold(tapped, std::nextafter(1000.0, 2000.0), 400);
  // The first sample is read by the grasp, so the force of the first tick comes from the second sample, and
  // differs in the last digit.
  EXPECT_NE(check.departure().find("/device/write: force_n.x was "), std::string::npos) << check.departure();
  EXPECT_EQ(check.departure().find("tick "), 0u);
}

TEST(Recording, IsLostAfterItsLastSample) {
  Recording device(swungRun());
  for (int i = 0; i < 401; ++i) EXPECT_EQ(device.read().status, Status::Ok);
  EXPECT_EQ(device.left(), 0u);
  EXPECT_EQ(device.read().status, Status::Fault);
  RecordedRun nothing = device.run();
  nothing.entries.clear();
  EXPECT_EQ(Recording(nothing).read().status, Status::Fault);
}

TEST(Recording, ReadingNeverAllocates) {
  Recording device(swungRun());
  const vps_test::NoAllocScope guard;
  for (int i = 0; i < 500; ++i) {
    device.read();
    device.write({});
  }
}

TEST(Recording, TablesHoldEveryNumberToTheBit) {
  RecordedRun run;
  run.entries = everyKind();
  const auto tables = csvTables(run);
  ASSERT_EQ(tables.size(), log::kKinds);
  EXPECT_EQ(tables[0].first, "device_read");
  EXPECT_EQ(std::count(tables[0].second.begin(), tables[0].second.end(), '\n'), 5);
  EXPECT_EQ(tables[1].second.substr(0, tables[1].second.find('\n')),
            "time_s,force_n.x,force_n.y,force_n.z,torque_nm.x,torque_nm.y,torque_nm.z");
  const std::string row = tables[1].second.substr(tables[1].second.find('\n') + 1);
  EXPECT_EQ(row.find("0,-inf,0,1e+300,"), 0u) << row;
  EXPECT_EQ(std::strtod(row.c_str() + 16, nullptr), 1.0 / 7) << row;
  EXPECT_NE(tables[2].second.find("\"takes 'peg', \"\"the\"\" one\""), std::string::npos) << tables[2].second;
}

}  // namespace
}  // namespace vps::device
