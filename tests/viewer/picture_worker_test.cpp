// SPDX-License-Identifier: BSD-3-Clause
#include "window/picture_worker.h"

#include <gtest/gtest.h>

#include <chrono>

namespace vps::viewer {
namespace {

using namespace std::chrono_literals;

class PictureWorkerTest : public testing::Test {
 protected:
  PictureWorkerTest() {
    wanted_.snapshot.bodies = {{0, Pose::translation(Vec3::Zero()), scenes::BodyRole::Mounted}};
    wanted_.options.width = 160;
    wanted_.options.height = 120;
    wanted_.options.supersampling = 1;
    wanted_.camera = frameScene(bounds(box_), Vec3(1, -1, 1));
  }
  /// Waits for the next picture, for a minute at most.
  DrawnPicture next(PictureWorker& worker) {
    const auto end = std::chrono::steady_clock::now() + 60s;
    while (std::chrono::steady_clock::now() < end) {
      if (std::optional<DrawnPicture> picture = worker.take()) return *picture;
      std::this_thread::sleep_for(1ms);
    }
    ADD_FAILURE() << "no picture within a minute";
    return {};
  }
  Mesh box_ = makeBox(Vec3(0.1, 0.1, 0.1));
  RenderScene scene_ = {{&box_}};
  PictureRequest wanted_;
};

TEST_F(PictureWorkerTest, ADraftComesFirstAndThenThePictureInFull) {
  PictureWorker worker(scene_, [] {});
  worker.request(wanted_);
  DrawnPicture picture = next(worker);
  EXPECT_TRUE(picture.is_draft);
  while (picture.is_draft) picture = next(worker);
  Renderer renderer(scene_);
  EXPECT_EQ(picture.image.rgb, renderer.render(wanted_.snapshot, wanted_.camera, wanted_.options).rgb);
}

TEST_F(PictureWorkerTest, TheSameRequestDrawsNothingAndAnotherDoes) {
  PictureWorker worker(scene_, [] {});
  worker.request(wanted_);
  while (next(worker).is_draft) continue;
  const std::size_t drawn = worker.count();
  worker.request(wanted_);
  std::this_thread::sleep_for(300ms);  // twice the time after which a draft would be drawn in full
  EXPECT_EQ(worker.count(), drawn);
  wanted_.snapshot.bodies[0].X_WP.p.x() += 1e-3;
  worker.request(wanted_);
  while (next(worker).is_draft) continue;
  EXPECT_GT(worker.count(), drawn);
}

TEST_F(PictureWorkerTest, WhatChangesThePictureIsNotTheSame) {
  EXPECT_TRUE(isSame(wanted_, wanted_));
  PictureRequest other = wanted_;
  other.camera.eye_W.x() += 1e-9;
  EXPECT_FALSE(isSame(wanted_, other));
  other = wanted_;
  other.options.cut = CutPlane{};
  EXPECT_FALSE(isSame(wanted_, other));
  other = wanted_;
  other.snapshot.contacts = {{Vec3::Zero(), Vec3::UnitZ(), 1e-6}};
  EXPECT_FALSE(isSame(wanted_, other));
  other = wanted_;
  other.snapshot.bodies[0].role = scenes::BodyRole::InHand;
  EXPECT_FALSE(isSame(wanted_, other));
}

TEST_F(PictureWorkerTest, EndingWhileAPictureIsWantedIsClean) {
  for (int i = 0; i < 3; ++i) {
    PictureWorker worker(scene_, [] {});
    worker.request(wanted_);
  }
}

}  // namespace
}  // namespace vps::viewer
