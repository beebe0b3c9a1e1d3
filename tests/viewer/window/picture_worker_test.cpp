// SPDX-License-Identifier: BSD-3-Clause
#include "view/picture_worker.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>
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
  std::this_thread::sleep_for(300ms);  // twice the time after which the worker draws a resting view in full
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

/// A function of OpenGL or EGL that a test puts in place of the driver's.
template <class Function>
class Replaced {
 public:
  Replaced(Function& of_driver, Function other) : of_driver_(of_driver), driver_(of_driver) {
    of_driver_ = other;
  }
  ~Replaced() { of_driver_ = driver_; }

 private:
  Function &of_driver_, driver_;
};

GLenum wasReset() {
  return GL_INNOCENT_CONTEXT_RESET;
}
GLenum isOutOfMemory() {
  return GL_OUT_OF_MEMORY;
}
EGLContext noContext(EGLDisplay, EGLConfig, EGLContext, const EGLint*) {
  return EGL_NO_CONTEXT;
}

class FailingRenderer : public PictureWorkerTest {
 protected:
  static constexpr double kWait_s = 0.01;

  /// Waits for a failure, for a minute at most.
  static std::string failureOf(const PictureWorker& worker) {
    const auto end = std::chrono::steady_clock::now() + 60s;
    while (std::chrono::steady_clock::now() < end && worker.failure().empty())
      std::this_thread::sleep_for(1ms);
    return worker.failure();
  }
  void expectPictureAgain(PictureWorker& worker) {
    DrawnPicture picture = next(worker);
    while (picture.is_draft) picture = next(worker);
    EXPECT_EQ(worker.failure(), "");
    Renderer renderer(scene_);
    EXPECT_EQ(picture.image.rgb, renderer.render(wanted_.snapshot, wanted_.camera, wanted_.options).rgb);
  }
};

TEST_F(FailingRenderer, AResetOfTheGraphicsCardIsSaidAndTheNextRendererDraws) {
  PictureWorker worker(
      scene_, [] {}, kWait_s);
  worker.request(wanted_);
  while (next(worker).is_draft) continue;
  {
    const Replaced reset(epoxy_glGetGraphicsResetStatus, &wasReset);
    wanted_.snapshot.bodies[0].X_WP.p.x() += 1e-3;
    worker.request(wanted_);
    EXPECT_NE(failureOf(worker).find("was reset"), std::string::npos) << worker.failure();
  }
  expectPictureAgain(worker);
}

TEST_F(FailingRenderer, TooLittleMemoryIsSaidAndTheNextRendererDraws) {
  PictureWorker worker(
      scene_, [] {}, kWait_s);
  {
    const Replaced full(epoxy_glGetError, &isOutOfMemory);
    worker.request(wanted_);
    EXPECT_NE(failureOf(worker).find("too little free memory"), std::string::npos) << worker.failure();
  }
  expectPictureAgain(worker);
}

TEST_F(FailingRenderer, ADriverWithoutOpenGl45IsSaidAndTriedAgain) {
  std::optional<Replaced<PFNEGLCREATECONTEXTPROC>> old(std::in_place, epoxy_eglCreateContext, &noContext);
  PictureWorker worker(
      scene_, [] {}, kWait_s);
  worker.request(wanted_);
  EXPECT_NE(failureOf(worker).find("no OpenGL 4.5"), std::string::npos) << worker.failure();
  EXPECT_NE(failureOf(worker).find("apt install"), std::string::npos) << "a remedy";
  old.reset();
  expectPictureAgain(worker);
}

TEST_F(FailingRenderer, AWorkerThatNeverDrawsEndsCleanly) {
  const Replaced old(epoxy_eglCreateContext, &noContext);
  PictureWorker worker(
      scene_, [] {}, 1000);
  worker.request(wanted_);
  EXPECT_NE(failureOf(worker), "");
}

TEST_F(PictureWorkerTest, ADraftForInterleavedRowsHasAllRowsAndKeepsTheEyesApart) {
  Renderer renderer(scene_);
  wanted_.options.width = 161;  // not a multiple of the divisor of drafts
  wanted_.options.height = 121;
  wanted_.stereo = StereoMode::Interleaved;
  Camera left = wanted_.camera, right = wanted_.camera;
  left.shift_x = 10;  // the left eye looks past the box
  wanted_.eyes = EyePair{left, right};
  for (const int first : {0, 1})
    for (const int shrink : {1, 2, 3}) {
      wanted_.rows.first = first;
      const Image draft = drawDraft(renderer, wanted_, shrink);
      ASSERT_EQ(draft.width, 161);
      ASSERT_EQ(draft.height, 121);
      for (int y = 0; y < draft.height; ++y) {
        const bool is_left = (first + y) % 2 == 0;
        bool has_box = false;  // whether the row shows the dark box on the light background
        for (int x = 0; x < draft.width; ++x) has_box |= draft.at(x, y)[0] < 150;
        if (!is_left && std::abs(y - 60) >= 20) continue;  // the box covers rows in the middle only
        EXPECT_EQ(has_box, !is_left) << "row " << y << " of a draft with 1/" << shrink;
      }
    }
}

TEST_F(PictureWorkerTest, AnInterleavedPictureFillsAWindowThatIsLargerThanThePicture) {
  Renderer renderer(scene_);
  wanted_.stereo = StereoMode::Interleaved;
  Camera left = wanted_.camera;
  left.shift_x = 10;
  wanted_.eyes = EyePair{left, wanted_.camera};
  wanted_.rows = {403, 301, 7};
  const Image image = drawInFull(renderer, wanted_);
  ASSERT_EQ(image.width, 403);
  ASSERT_EQ(image.height, 301);
  for (int y = 100; y < 200; ++y) {
    bool has_box = false;
    for (int x = 0; x < image.width; ++x) has_box |= image.at(x, y)[0] < 150;
    EXPECT_EQ(has_box, (y + 7) % 2 == 1) << y;
  }
}

TEST_F(PictureWorkerTest, EndingWhileAPictureIsWantedIsClean) {
  for (int i = 0; i < 3; ++i) {
    PictureWorker worker(scene_, [] {});
    worker.request(wanted_);
  }
}

}  // namespace
}  // namespace vps::viewer
