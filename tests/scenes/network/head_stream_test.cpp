// SPDX-License-Identifier: BSD-3-Clause
// Poses of the heads in front of a display, recorded or from the network.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <thread>

#include "support/temporary_folder.h"
#include "vps/errors.h"
#include "vps_scenes/network/ros_topics.h"
#include "vps_scenes/network/tracked_heads.h"
#include "vps_scenes/scene/number_table.h"

namespace vps::scenes {
namespace {

const std::string kWall =
    "[[screen]]\nname = 'wall'\nlower_left = [-0.8, 0, 0]\nlower_right = [0.8, 0, 0]\n"
    "upper_left = [-0.8, 0, 0.9]\n[[viewer]]\nname = 'anna'\n";
// The head is upright in front of the wall; a second later it is 0.2 m to the right and turned by 90 degrees
// about its x axis.
const std::string kTrack =
    "time_s,x,y,z,qx,qy,qz,qw\n0,0,-1,0.5,0.70710678,0,0,0.70710678\n"
    "1, 0.2, -1, 0.5, 0, 0, 0, 1\n";

class HeadStream : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    const std::string file = (folder_.path() / name).string();
    std::ofstream(file) << text;
    return file;
  }
  Display load(const std::string& viewer) { return loadDisplay(write("wall.toml", kWall + viewer)); }
  std::string refusal(const std::string& viewer) {
    try {
      TrackedHeads heads(load(viewer));
      heads.waitForAll(0);
    } catch (const LoadError& error) {
      return error.what();
    }
    return "not refused";
  }
  test::TemporaryFolder folder_;
};

TEST_F(HeadStream, ARecordedHeadIsBetweenItsPosesAndStaysBeyondThem) {
  write("anna.csv", kTrack);
  TrackedHeads heads(load("recorded = 'anna.csv'\n"));
  EXPECT_FALSE(heads.isLive());
  const auto head = [&](double time_s) { return heads.at(time_s).viewers[0].X_SE; };
  EXPECT_EQ(head(-1).p, Vec3(0, -1, 0.5));
  // 1e-15 is the rounding of sums of numbers below one.
  EXPECT_LT((head(0.25).p - Vec3(0.05, -1, 0.5)).norm(), 1e-15);
  EXPECT_NEAR(rotationVector(head(0.25).R)[0], 0.75 * std::numbers::pi / 2,
              1e-7);  // precision of the digits in the file
  EXPECT_EQ(head(7).p, Vec3(0.2, -1, 0.5));
}

TEST_F(HeadStream, ARecordedHeadBehindAScreenIsRefusedWithItsTime) {
  write("anna.csv", kTrack + "2.5, 0, 1, 0.5, 0, 0, 0, 1\n");
  const std::string said = refusal("recorded = 'anna.csv'\n");
  EXPECT_NE(said.find("'anna' at 2.5"), std::string::npos) << said;
  EXPECT_NE(said.find("behind 'wall'"), std::string::npos) << said;
}

TEST_F(HeadStream, WhatIsWrongInATrackIsSaidWithItsLine) {
  const auto says = [&](const std::string& track, const std::string& words) {
    write("anna.csv", track);
    const std::string said = refusal("recorded = 'anna.csv'\n");
    EXPECT_NE(said.find(words), std::string::npos) << said;
  };
  says(kTrack + "0.5, 0, -1, 0.5, 0, 0, 0, 1\n", "anna.csv:4: has a time that is not later");
  says(kTrack + "2, 0, -1, 0.5, 0, 0, 1, 1\n", "anna.csv:4: has no rotation in columns 5 to 8");
  says(kTrack + "2, 0, -1\n", "anna.csv:4: expected 8 numbers");
  says(kTrack + "2, nan, -1, 0.5, 0, 0, 0, 1\n", "anna.csv:4: expected 8 numbers");
  says("time_s,x\n", "has no row");
  std::filesystem::remove(folder_.path() / "anna.csv");
  EXPECT_NE(refusal("recorded = 'anna.csv'\n").find("cannot be read"), std::string::npos);
}

TEST_F(HeadStream, AViewerHasOneStream) {
  write("anna.csv", kTrack);
  const std::string head = "head = {position = [0, -1, 0.5], rpy_deg = [90, 0, 0]}\n";
  EXPECT_NE(refusal(head + "recorded = 'anna.csv'\n").find("leave out 'head'"), std::string::npos);
  EXPECT_NE(refusal("topic = '/anna'\nrecorded = 'anna.csv'\n").find("leave out 'topic'"), std::string::npos);
  EXPECT_NE(refusal("topic = 'anna head'\n").find("expected a topic of ROS 2"), std::string::npos);
  EXPECT_NE(refusal("topic = '/anna'\nros_domain = 400\n").find("ros_domain"), std::string::npos);
  EXPECT_NE(refusal("").find("or a stream of poses"), std::string::npos);
}

TEST_F(HeadStream, ATrackCutAtEveryByteIsReadOrRefused) {
  for (std::size_t i = 0; i < kTrack.size(); ++i) {
    try {
      loadHeadTrack(write("anna.csv", kTrack.substr(0, i)));
    } catch (const LoadError&) {
    }
  }
}

#if __has_include(<dds/dds.h>)

constexpr int kDomain = 102;
const std::string kTopic = "topic = '/vps/tracker/handle'\nros_domain = 102\n";

Snapshot headAt(const Vec3& p_S) {
  Snapshot shot;
  shot.has_hand = true;
  shot.X_W_Proxy = Pose::translation(p_S);
  return shot;
}

/// Waits until the head's pose has arrived, for at most 10 s because of discovery.
bool comes(TrackedHeads& heads, RosTopics& tracker, const Vec3& published_S, const Vec3& wanted_S) {
  for (int i = 0; i < 1000; ++i) {
    tracker.publish(headAt(published_S), 0);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    if (heads.at(0).viewers[0].X_SE.p == wanted_S) return true;
  }
  return false;
}

TEST_F(HeadStream, AHeadFollowsItsTopicAndStaysInFrontOfTheScreen) {
  TrackedHeads heads(load(kTopic + "head = {position = [0, -1, 0.5], rpy_deg = [90, 0, 0]}\n"));
  heads.waitForAll(0);  // the head's pose is known
  EXPECT_TRUE(heads.isLive());
  EXPECT_EQ(heads.at(0).viewers[0].X_SE.p, Vec3(0, -1, 0.5));
  RosTopics tracker(kDomain, "lo", "tracker", Scene());
  ASSERT_TRUE(comes(heads, tracker, {0.25, -1.5, 0.5}, {0.25, -1.5, 0.5}));
  EXPECT_TRUE(heads.takeNews().empty());
  // The head is behind the wall: the picture keeps the last pose, which is reported once.
  for (int i = 0; i < 100; ++i) {
    tracker.publish(headAt({0, 1, 0.5}), 0);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    ASSERT_EQ(heads.at(0).viewers[0].X_SE.p, Vec3(0.25, -1.5, 0.5));
  }
  const std::vector<std::string> news = heads.takeNews();
  ASSERT_EQ(news.size(), 1U);
  EXPECT_NE(news[0].find("'anna' is behind 'wall'"), std::string::npos) << news[0];
  EXPECT_TRUE(comes(heads, tracker, {0, -2, 0.5}, {0, -2, 0.5}));
}

TEST_F(HeadStream, AHeadThatNobodyPublishesIsMissedByItsTopic) {
  const std::string said = refusal(kTopic);
  EXPECT_NE(said.find("'/vps/tracker/handle' (ROS domain 102"), std::string::npos) << said;
}

#endif

}  // namespace
}  // namespace vps::scenes
