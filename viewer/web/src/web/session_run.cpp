// SPDX-License-Identifier: BSD-3-Clause
// A session of vps render as a WatchedRun.
#include <atomic>
#include <chrono>
#include <future>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "vps/errors.h"
#include "vps_scenes/network/nodes.h"
#include "web/watched_run.h"

namespace vps::viewer {

namespace {

using scenes::SessionWatcher;

/// The device node of a session, on a thread of its own. The page's user moves its device.
class PageDevice {
 public:
  PageDevice(const WebOptions& options, double scale) : drag_(scale) {
    scenes::DeviceNodeOptions node;
    node.session = options.session;
    node.network = options.network;
    node.stop = &stop_;
    node.rearms = true;  // re-arming is safe, since a simulated handle cannot hurt anybody
    node.kind = "mouse";
    node.wish = drag_.wish();
    thread_ = std::thread([this, node] { run(node); });
  }
  ~PageDevice() {
    stop_ = true;
    thread_.join();
  }
  PageDevice(const PageDevice&) = delete;
  PageDevice& operator=(const PageDevice&) = delete;

  HandDrag* drag() { return is_refused_ ? nullptr : &drag_; }
  /// Why the device node could not join the session; empty: no new reason since the last call.
  std::string takeRefusal() {
    const std::lock_guard lock(mutex_);
    return std::exchange(refusal_, {});
  }

 private:
  void run(const scenes::DeviceNodeOptions& node) {
    try {
      scenes::deviceNode(node);
    } catch (const std::exception& refused) {
      const std::lock_guard lock(mutex_);
      refusal_ = refused.what();
      is_refused_ = true;
    }
  }

  HandDrag drag_;
  std::atomic<bool> stop_{false}, is_refused_{false};
  std::mutex mutex_;
  std::string refusal_;
  std::thread thread_;
};

class SessionRun final : public WatchedRun {
 public:
  explicit SessionRun(const WebOptions& options) : options_(options) {}

  void poll() override {
    if (watcher_ == nullptr) return look();
    const bool is_over = watcher_->isOver();  // asked before the news is read, so that none is missed
    while (const auto news = watcher_->takeNews()) tell(*news);
    if (device_)
      if (std::string refusal = device_->takeRefusal(); !refusal.empty())
        news_.push_back({0, "the page cannot move the part: " + refusal, {}});
    if (!is_over) return;
    news_.push_back({0, watcher_->hasEnded() ? "the session has ended" : "the render node is lost", {}});
    device_.reset();
    pointers_.reset();
    watcher_.reset();
  }
  [[nodiscard]] const scenes::Scene* scene() const override {
    return watcher_ ? &watcher_->scene() : nullptr;
  }
  [[nodiscard]] int number() const override { return number_; }
  [[nodiscard]] std::string doing() const override {
    if (watcher_ == nullptr)
      return "waiting for the session '" + options_.session + "'; vps render starts it";
    return watcher_->hasDevice() ? "" : "waiting for a device: vps device --session " + options_.session;
  }
  std::optional<WatchedShot> takeShot() override {
    if (watcher_ == nullptr) return {};
    std::optional<scenes::Snapshot> shot = watcher_->takeSnapshot();
    if (!shot) return {};
    return WatchedShot{std::move(*shot), watcher_->snapshotSent_ns()};
  }
  std::vector<WatchedNews> takeNews() override { return std::exchange(news_, {}); }
  [[nodiscard]] HandDrag* drag() override { return device_ ? device_->drag() : nullptr; }

  void point(int person, const std::optional<Vec3>& p_W) override {
    if (pointers_) pointers_->point((person - 1) % scenes::SessionPointers::kMostPersons + 1, p_W);
  }
  std::vector<scenes::SessionPointer> takePointers() override {
    return pointers_ ? pointers_->take() : std::vector<scenes::SessionPointer>();
  }

 private:
  /// Looks for the session on another thread, since the search may take a second.
  void look() {
    if (!joining_.valid()) {
      joining_ = std::async(std::launch::async, [session = options_.session, network = options_.network] {
        std::unique_ptr<SessionWatcher> found = SessionWatcher::join(session, network);
        if (found == nullptr) std::this_thread::sleep_for(std::chrono::milliseconds(20));
        return found;
      });
      return;
    }
    if (joining_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    try {
      watcher_ = joining_.get();
    } catch (const std::exception& refused) {
      if (refusal_ != refused.what()) news_.push_back({0, refused.what(), {}});
      refusal_ = refused.what();
    }
    if (watcher_ == nullptr) return;
    ++number_;
    refusal_.clear();
    findPointers();
    if (options_.allows_hand)
      device_ = std::make_unique<PageDevice>(options_, watcher_->scene().device.scale);
  }
  void findPointers() {
    try {
      pointers_.emplace(options_.session, options_.network);
    } catch (
        const LoadError& refused) {  // certificates that were made before pointers existed do not allow them
      news_.push_back(
          {0, std::string("the pointers of other people cannot be shown: ") + refused.what(), {}});
    }
  }
  void tell(const scenes::SessionNews& news) {
    const bool has_ended = news.kind == scenes::SessionNews::Kind::Ended;
    news_.push_back({news.time_s, news.text, has_ended ? std::optional(news.verdict) : std::nullopt});
  }

  WebOptions options_;
  std::future<std::unique_ptr<SessionWatcher>> joining_;
  std::unique_ptr<SessionWatcher> watcher_;
  std::unique_ptr<PageDevice> device_;
  std::optional<scenes::SessionPointers> pointers_;
  std::vector<WatchedNews> news_;
  std::string refusal_;
  int number_ = 0;
};

}  // namespace

std::unique_ptr<WatchedRun> watchedSession(const WebOptions& options) {
  return std::make_unique<SessionRun>(options);
}

}  // namespace vps::viewer
