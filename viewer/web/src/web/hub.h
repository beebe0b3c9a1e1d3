// SPDX-License-Identifier: BSD-3-Clause
// Messages to all browsers, and the effect of their messages. Independent of sockets.
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

/// Sends messages to one browser. No function waits.
class BrowserEnd {
 public:
  virtual ~BrowserEnd() = default;
  virtual void sendText(std::string text) = 0;
  virtual void sendBytes(std::string bytes) = 0;
  /// Whether all messages have been sent.
  [[nodiscard]] virtual bool isFree() const = 0;
};

/// Greatest number of snapshots that a browser has received but not drawn; a slow or distant browser thus
/// gets fewer. At 60 snapshots a second, three of them wait in the browser until they are due
/// (run/presentation.h).
inline constexpr std::uint32_t kMostUnseen = 8;

/// Connects the run with all browsers. Used by one thread.
class WebHub {
 public:
  WebHub(WatchedRun& run, double rate_hz) : run_(run), period_s_(1 / rate_hz) {}

  /// Adds a browser and returns its number.
  int join(BrowserEnd& end);
  void leave(int browser);
  /// Handles a message of a browser. Returns false if the browser sends too many or invalid messages; close
  /// the browser's connection then.
  bool hear(int browser, std::string_view text, double now_s);
  /// Sends the browsers what the run has reported since the last call. Call poll() about as often as
  /// snapshots may be sent.
  void poll(double now_s);

  /// The file of a part, requested as /part/RUN/PART/LEVEL.glb; null: there is none.
  std::shared_ptr<const std::string> partFile(std::string_view target);
  [[nodiscard]] std::size_t browsers() const { return browsers_.size(); }

 private:
  struct Browser {
    explicit Browser(BrowserEnd& browser_end) : end(&browser_end), coder(Vec3::Zero()) {}
    BrowserEnd* end;
    SnapshotCoder coder;
    std::uint32_t drawn = 0;  ///< number of the last snapshot that the browser has drawn
    std::uint64_t seen = 0;   ///< value of shots_ at the last snapshot sent to the browser
    bool has_sound = false;
    double next_s = 0;         ///< earliest time of the next snapshot
    int refused = 0;           ///< number of refused messages
    RateLimit rate{200, 400};  ///< messages per second. assumed: a pointer at 125 Hz, acks at 60 Hz
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
  std::string scene_text_;  ///< description of the scene in the hello message
  Vec3 center_W_ = Vec3::Zero();
  double radius_m_ = 1;
  std::string doing_;
  std::deque<std::string> news_;  ///< recent messages, for browsers that join later
  std::map<int, std::string> pointers_;
  std::optional<Playback> playback_;
  int holder_ = 0;  ///< browser that controls the part in hand; 0: none
  std::optional<WatchedShot> shot_;
  std::unique_ptr<BlowSounds> sounds_;  ///< null: no browser plays sound
  std::uint64_t shots_ = 0;
  std::map<std::size_t, ShadingMesh> meshes_;
  /// Files of the parts, by part and level, fine or coarse.
  std::map<std::pair<std::size_t, bool>, std::shared_ptr<const std::string>> files_;
};

}  // namespace vps::viewer
