// SPDX-License-Identifier: BSD-3-Clause
// What browsers are told, and what they may do. Nothing here knows sockets.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "mesh/shading_mesh.h"
#include "web/access.h"
#include "web/browser_message.h"
#include "web/snapshot_coder.h"
#include "web/watched_run.h"

namespace vps::viewer {

/// The way to one browser. Neither function waits.
class BrowserEnd {
 public:
  virtual ~BrowserEnd() = default;
  virtual void sendText(std::string text) = 0;
  virtual void sendBytes(std::string bytes) = 0;
  /// Nothing waits to be sent.
  [[nodiscard]] virtual bool isFree() const = 0;
};

/// Snapshots are sent to a browser that has drawn those before it, all but this many: one that is slow, or
/// far away, gets fewer. Of 60 a second three wait for their instant (window/presentation.h).
inline constexpr std::uint32_t kMostUnseen = 8;

/// Used by one thread.
class WebHub {
 public:
  WebHub(WatchedRun& run, double rate_hz) : run_(run), period_s_(1 / rate_hz) {}

  /// Returns the browser's number.
  int join(BrowserEnd& end);
  void leave(int browser);
  /// What a browser sent. False: it sends too much, or what is no message; close it.
  bool hear(int browser, std::string_view text, double now_s);
  /// Looks for what is new, and tells it. Call it about as often as snapshots may be sent.
  void poll(double now_s);

  /// The file of a part at /part/RUN/PART/LEVEL.glb; null: there is none.
  std::shared_ptr<const std::string> partFile(std::string_view target);
  [[nodiscard]] std::size_t browsers() const { return browsers_.size(); }

 private:
  struct Browser {
    explicit Browser(BrowserEnd& browser_end) : end(&browser_end), coder(Vec3::Zero()) {}
    BrowserEnd* end;
    SnapshotCoder coder;
    std::uint32_t drawn = 0;  ///< number of the last snapshot that it drew
    std::uint64_t seen = 0;   ///< shots_ of the last one that it was sent
    bool has_sound = false;
    double next_s = 0;         ///< earliest time of the next one
    int refused = 0;           ///< messages
    RateLimit rate{200, 400};  ///< assumed: a pointer at 125 Hz, acks at 60 Hz
  };

  void greet(int number, Browser& browser);
  void beginScene();
  void tellAll(const std::string& text);
  void tellHand();
  [[nodiscard]] std::string playbackText() const;
  void showPointer(int who, const std::optional<Vec3>& p_W);
  void sendShots(double now_s);
  void sendSounds();
  void obey(int number, Browser& browser, const BrowserMessage& message);
  void obeyHand(int number, const BrowserMessage& message);
  [[nodiscard]] std::string helloText(int number) const;
  [[nodiscard]] std::string handText() const;

  WatchedRun& run_;
  double period_s_;
  std::map<int, Browser> browsers_;
  int last_browser_ = 0;
  int run_number_ = 0;
  bool has_scene_ = false, may_take_ = false;
  std::string scene_text_;  ///< of the hello
  Vec3 center_W_ = Vec3::Zero();
  double radius_m_ = 1;
  std::string doing_;
  std::deque<std::string> news_;  ///< the last ones, for those who come later
  std::map<int, std::string> pointers_;
  std::optional<Playback> playback_;
  int holder_ = 0;  ///< browser that has the hand; 0: none
  std::optional<WatchedShot> shot_;
  std::unique_ptr<BlowSounds> sounds_;  ///< null: nobody listens
  std::uint64_t shots_ = 0;
  std::map<std::size_t, ShadingMesh> meshes_;
  std::map<std::pair<std::size_t, bool>, std::shared_ptr<const std::string>> files_;  ///< fine or coarse
};

}  // namespace vps::viewer
