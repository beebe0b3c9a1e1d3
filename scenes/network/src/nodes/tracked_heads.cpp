// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/network/tracked_heads.h"

#include <chrono>
#include <thread>
#include <utility>

#include "vps/errors.h"
#include "vps_device/metronome.h"
#include "vps_scenes/network/ros_topics.h"

namespace vps::scenes {
namespace {

constexpr double kSilent_s = 1;  // assumed: trackers send at least 60 poses a second
constexpr std::chrono::milliseconds kLookAgain{10};

}  // namespace

struct TrackedHeads::Work {
  struct Stream {
    std::unique_ptr<HeadTopic> topic;  ///< null: the head has no topic
    bool has_come = false, is_silent = false, is_behind = false;
    double heard_s = 0;
  };
  Display display;
  std::vector<Stream> streams;  ///< by viewer
  std::vector<std::string> news;

  /// Moves a viewer's head. Returns false if the head is behind a screen, and reports the first such pose.
  bool move(DisplayViewer& viewer, Stream& stream, const Pose& X_SE) {
    DisplayViewer moved = viewer;
    moved.X_SE = X_SE;
    for (const DisplayScreen& screen : display.screens)
      if (isBehind(moved, screen)) {
        if (!std::exchange(stream.is_behind, true))
          news.push_back("the head of '" + viewer.name + "' is behind '" + screen.name +
                         "'; the last pose in front of that screen is used");
        return false;
      }
    stream.is_behind = false;
    viewer.X_SE = X_SE;
    return true;
  }
  void listen(DisplayViewer& viewer, Stream& stream) {
    const double now_s = device::monotonicSeconds();
    if (const std::optional<Pose> X_SE = stream.topic->take()) {
      stream.heard_s = now_s;
      stream.is_silent = false;
      stream.has_come = move(viewer, stream, *X_SE) || stream.has_come;
    } else if (stream.has_come && now_s - stream.heard_s > kSilent_s && !stream.is_silent) {
      stream.is_silent = true;
      news.push_back("no more head poses of '" + viewer.name + "' arrive on '" + viewer.topic +
                     "'; check that the tracker runs");
    }
  }
};

TrackedHeads::TrackedHeads(Display display) : work_(std::make_unique<Work>()) {
  work_->display = std::move(display);
  for (const DisplayViewer& viewer : work_->display.viewers) {
    Work::Stream& stream = work_->streams.emplace_back();
    if (!viewer.topic.empty())
      stream.topic = std::make_unique<HeadTopic>(viewer.topic, viewer.ros_domain, viewer.network);
  }
}
TrackedHeads::~TrackedHeads() = default;
TrackedHeads::TrackedHeads(TrackedHeads&&) noexcept = default;
TrackedHeads& TrackedHeads::operator=(TrackedHeads&&) noexcept = default;

const Display& TrackedHeads::display() const {
  return work_->display;
}

const Display& TrackedHeads::at(double time_s) {
  for (std::size_t i = 0; i < work_->streams.size(); ++i) {
    DisplayViewer& viewer = work_->display.viewers[i];
    Work::Stream& stream = work_->streams[i];
    if (!viewer.track.time_s.empty())
      work_->move(viewer, stream, viewer.track.at(time_s));
    else if (stream.topic)
      work_->listen(viewer, stream);
  }
  return work_->display;
}

void TrackedHeads::waitForAll(double limit_s) {
  const double end_s = device::monotonicSeconds() + limit_s;
  for (;;) {
    at(0);
    const DisplayViewer* missing = nullptr;
    for (std::size_t i = 0; i < work_->streams.size(); ++i)
      if (work_->streams[i].topic && !work_->streams[i].has_come && !work_->display.viewers[i].is_placed)
        missing = &work_->display.viewers[i];
    if (missing == nullptr) return;
    if (device::monotonicSeconds() > end_s)
      throw LoadError(work_->display.file, missing->name,
                      "no head pose in front of the screens arrives on '" + missing->topic +
                          "' (ROS domain " + std::to_string(missing->ros_domain) + ", network '" +
                          missing->network +
                          "'); check that the tracker publishes it, or give 'head' as well");
    std::this_thread::sleep_for(kLookAgain);
  }
}

bool TrackedHeads::isLive() const {
  for (const Work::Stream& stream : work_->streams)
    if (stream.topic) return true;
  return false;
}

std::vector<std::string> TrackedHeads::takeNews() {
  return std::exchange(work_->news, {});
}

}  // namespace vps::scenes
