// SPDX-License-Identifier: BSD-3-Clause
// Latency of picture, sound and force of a contact: the evaluation of a made-up measurement, and the parts of
// a real one.
#include "vps_viewer/window/latency.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <mutex>
#include <thread>

#include "latency/contact_times.h"
#include "latency/tapping_handle.h"
#include "sound/live_sound.h"
#include "vps_device/metronome.h"
#include "vps_viewer/draw/renderer.h"

namespace vps::viewer {
namespace {

constexpr double kTick_s = 1e-3, kCard_s = kCardPeriod / 48000.0;  // a period of the sound card

/// A log of ticks, steps and periods over two seconds, with a contact. The handle is read at `read_s`; the
/// contact is found 2 ms later, felt after 3 ms, given to the sound card after 4 ms, heard after 11 ms and
/// seen after 20 ms.
LatencyLog madeUp(double read_s) {
  LatencyLog log;
  for (int i = 0; i < 2000; ++i) {
    const double time_s = i * kTick_s;
    const bool is_felt = time_s > read_s + 2.5e-3;
    log.ticks.push_back({time_s, time_s + 1e-4, Vec3(0, 0, is_felt ? 2.4 : 0.4)});
    const bool touches = time_s > read_s - 1e-4 && time_s < read_s + 0.1;
    log.steps.push_back({time_s, time_s + 2e-3, touches ? 3.0 : 0.0});
    log.written.push_back({time_s, time_s > read_s + 3.5e-3 ? 0.1F : 1e-4F});
  }
  for (double time_s = 0; time_s < 2; time_s += kCard_s) {
    LatencyLog::Heard& heard = log.heard.emplace_back();
    heard.time_s = time_s;
    for (int i = 0; i < kCardPeriod; ++i)
      heard.samples.push_back(time_s + i / log.rate_hz >= read_s + 0.011 ? -0.1F : 1e-4F);
  }
  for (double time_s = 0; time_s < 2; time_s += 0.01)
    log.pictures.push_back({time_s, time_s + 0.01, time_s + 1e-4 > read_s + 0.01 && time_s < read_s + 0.1});
  return log;
}

TEST(ContactTimes, EachOfTheThreeIsFoundWhereItBegins) {
  const std::vector<ContactTimes> found = findContacts(madeUp(1), 0.5);
  ASSERT_EQ(found.size(), 1U);
  // Tolerances: rounding of times in seconds, and one sample for the click.
  EXPECT_NEAR(found[0].found_s, 2e-3, 1e-9);
  EXPECT_NEAR(found[0].force_s, 3e-3 + 1e-4, 1e-9);
  EXPECT_NEAR(found[0].sound_written_s, 4e-3, 1e-9);
  EXPECT_NEAR(found[0].sound_s, 11e-3, 1 / 48000.0);
  EXPECT_NEAR(found[0].drawing_s, 10e-3, 1e-9);
  EXPECT_NEAR(found[0].picture_s, 20e-3, 1e-9);
  EXPECT_NEAR(found[0].apart_s(true), 16.9e-3, 1e-9);
  EXPECT_TRUE(findContacts(madeUp(1), 1.5).empty()) << "the contact began before the start of the evaluation";
}

TEST(ContactTimes, GapsOfTheSoundAreCountedFromWhereTapsCount) {
  LatencyLog log = madeUp(1);
  EXPECT_EQ(lateSamples(log, 0.5) + lateMixes(log, 0.5), 0U);
  for (LatencyLog::Heard& heard : log.heard) {
    if (heard.time_s > 0.25)
      heard.time_s += 1e-3;  // mixed too late, both before and after the start of the evaluation
    if (heard.time_s > 1.5) heard.time_s += 1e-3;
  }
  EXPECT_EQ(lateMixes(log, 0.5), 1U);
  EXPECT_EQ(lateMixes(log, 0), 2U);
  for (LatencyLog::Written& written : log.written)
    written.gaps = written.time_s < 0.25 ? 1 : written.time_s < 1.2 ? 2 : 4;
  EXPECT_EQ(lateSamples(log, 0.5), 2U);
  EXPECT_EQ(lateSamples(log, 0), 4U) << "from the start of the log";
  EXPECT_EQ(lateSamples({}, 0.5) + lateMixes({}, 0.5), 0U);
}

TEST(ContactTimes, WhatIsNotSeenIsNotGood) {
  LatencyLog log = madeUp(1);
  LatencyResult result;
  result.contacts = findContacts(log, 0.5);
  EXPECT_TRUE(result.isGood());
  for (LatencyLog::Picture& picture : log.pictures) picture.is_lit = false;
  result.contacts = findContacts(log, 0.5);
  ASSERT_EQ(result.contacts.size(), 1U);
  EXPECT_LT(result.contacts[0].apart_s(true), 0);
  EXPECT_FALSE(result.isGood());
  result.contacts.clear();
  EXPECT_FALSE(result.isGood()) << "no contact proves nothing";
}

TEST(ContactTimes, TheBoundIsMetOnBothSidesOfItsEdge) {
  LatencyResult result;
  result.contacts.resize(100, {2e-3, 3e-3, 4e-3, 5e-3, 10e-3, 20e-3});
  result.contacts[0].picture_s = 1;  // one of 100 contacts may be late
  EXPECT_TRUE(result.isGood());
  result.contacts[1].picture_s = 3e-3 + kApart_s + 1e-6;
  EXPECT_FALSE(result.isGood());
  result.contacts[1].picture_s = 3e-3 + kApart_s - 1e-6;
  EXPECT_TRUE(result.isGood());
}

TEST(TappingHandle, TapsAgainstAWallAndIsPressedByItOnly) {
  TapPlan plan;
  plan.reach_m = 0.05;
  TappingHandle handle(plan, 20000);
  constexpr double kWall_m = 0.02, kStiffness = 2000;
  double deepest_m = 0;
  for (int i = 0; i < 10000; ++i) {
    const Vec3 p = handle.readAt(i * kTick_s).X_DH.p;
    const double depth_m = -p.z() - kWall_m;
    deepest_m = std::max(deepest_m, depth_m);
    Wrench F;
    F.f = Vec3(0, 0, 0.3 + std::max(0.0, kStiffness * depth_m));  // 0.3 N: the weight of the part
    handle.writeAt(F, i * kTick_s + 1e-4);
  }
  EXPECT_GT(handle.taps(), 15U);  // taps in 10 s; each takes 0.4 s, and the start costs some
  EXPECT_FALSE(handle.hasFoundNothing());
  EXPECT_EQ(handle.ticks().size(), 10000U);
  EXPECT_DOUBLE_EQ(handle.ticks()[5000].written_s - handle.ticks()[5000].read_s, 5.0001 - 5);
  // The handle advances until it feels the force, and one tick farther. Up to half of that force goes into
  // the average of the free motion: the force grows by k v, so the mean over T takes press^2 / (8 k v T) of
  // it.
  constexpr double kMean_s = 0.05, kRounding_m = 1e-9;
  const double averaged_N = plan.press_N * plan.press_N / (8 * kStiffness * plan.speed_m_s * kMean_s);
  EXPECT_LE(deepest_m, (plan.press_N + averaged_N) / kStiffness + 2 * plan.speed_m_s * kTick_s + kRounding_m);
}

TEST(TappingHandle, SaysWhereNothingIsMet) {
  TappingHandle handle(TapPlan(), 0);
  for (int i = 0; i < 6000 && !handle.hasFoundNothing(); ++i) {
    handle.readAt(i * kTick_s);
    handle.writeAt({}, i * kTick_s);
  }
  EXPECT_TRUE(handle.hasFoundNothing());
  EXPECT_EQ(handle.taps(), 0U);
}

TEST(SoundLoopback, WhatIsWrittenIsHeardLaterAndOnce) {
  std::mutex mutex;
  std::vector<LatencyLog::Heard> heard;
  std::string why;
  std::unique_ptr<SoundOutput> card = openSoundLoopback(
      48000,
      [&](std::span<const float> samples, double time_s) {
        const std::lock_guard lock(mutex);
        heard.push_back({time_s, {samples.begin(), samples.end()}});
      },
      why);
  if (!card) GTEST_SKIP() << why;
  const std::vector<float> silence(480, 0), click = [] {
    std::vector<float> samples(480, 0);
    for (std::size_t i = 0; i < 20; ++i) samples[i] = 0.5F;
    return samples;
  }();
  for (int i = 0; i < 20; ++i) {  // written at the rate of playback, since late samples are dropped
    card->write(silence, silence, -Vec3::UnitZ());
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  const double clicked_s = device::monotonicSeconds();
  card->write(click, silence, -Vec3::UnitZ());
  for (int i = 0; i < 50; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    card->write(silence, silence, -Vec3::UnitZ());
  }
  card.reset();
  double first_s = 0, last_s = 0;
  for (std::size_t i = 0; i < heard.size(); ++i) {
    if (i > 0) {
      EXPECT_GE(heard[i].time_s - heard[i - 1].time_s, kCard_s - 1e-9);
    }
    for (std::size_t k = 0; k < heard[i].samples.size(); ++k) {
      if (std::abs(heard[i].samples[k]) < 0.05F) continue;
      last_s = heard[i].time_s + static_cast<double>(k) / 48000;
      if (first_s == 0) first_s = last_s;
    }
  }
  EXPECT_GT(first_s, clicked_s);
  // Bound: 0.4 ms of samples, and the ringing of the HRTF filters, which are about 5 ms long.
  EXPECT_LT(last_s - first_s, 10e-3);
}

TEST(Flash, IsWhiteWhileSomethingTouchesAndChangesNothingElse) {
  const Mesh box = makeBox(Vec3(0.1, 0.1, 0.1));
  Renderer renderer({{&box}});
  scenes::Snapshot shot;
  shot.bodies = {{0, Pose(), scenes::BodyRole::Mounted}};
  DrawOptions options;
  options.width = 320;
  options.height = 180;
  options.show_contacts = options.show_legend = false;
  const Camera camera = frameScene(bounds(box), Vec3(1, -1, 1));
  const Image plain = renderer.render(shot, camera, options);
  options.show_flash = true;
  const Image dark = renderer.render(shot, camera, options);
  shot.contacts = {{Vec3::Zero(), Vec3::UnitZ(), 1e-6, 0.1}};
  const Image lit = renderer.render(shot, camera, options);
  const int size_px = flashSize_px(options.height);
  for (int y = 0; y < options.height; ++y)
    for (int x = 0; x < options.width; ++x) {
      const bool is_in = x < size_px && y >= options.height - size_px;
      ASSERT_EQ(dark.at(x, y)[0], is_in ? 0 : plain.at(x, y)[0]) << x << " " << y;
      ASSERT_EQ(lit.at(x, y)[0], is_in ? 255 : plain.at(x, y)[0]) << x << " " << y;
    }
}

}  // namespace
}  // namespace vps::viewer
