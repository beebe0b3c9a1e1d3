// SPDX-License-Identifier: BSD-3-Clause
// Which parts are near a part, and which touch it, at the poses that are shown; measured on a thread of its
// own.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "vps_scenes/run/part_gaps.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

/// What was measured for one part.
struct MeasuredGaps {
  std::size_t part = 0;
  double time_s = 0;                       ///< of the snapshot
  std::vector<scenes::PartGap> gaps;       ///< the nearest first, up to GapWatch::kMost_m
  std::vector<scenes::PartTouch> touches;  ///< its contacts; none where a snapshot has no contacts
};

/// Measures the newest snapshot that it was asked for, at most every 50 ms, so that it does not keep a
/// processor from the run; snapshots in between are skipped, and the same one again is not measured again.
class VPS_VIEWER_API GapWatch {
 public:
  static constexpr double kMost_m = 1e-3;

  /// The scene outlives it. Nothing is prepared before the first request.
  /// @param on_news  called on its thread after each measurement; may be empty
  explicit GapWatch(const scenes::Scene& scene, std::function<void()> on_news = {});
  ~GapWatch();
  GapWatch(const GapWatch&) = delete;
  GapWatch& operator=(const GapWatch&) = delete;

  /// @param parts  to measure, as the picked part and the part in hand; none: nothing is measured
  void request(const scenes::Snapshot& shot, std::vector<std::size_t> parts);
  /// The newest of that part; none: not measured yet, or other parts were asked for since.
  [[nodiscard]] std::optional<MeasuredGaps> of(std::size_t part) const;

 private:
  struct Request {
    scenes::Snapshot shot;
    std::vector<std::size_t> parts;
  };
  [[nodiscard]] static bool isSame(const Request& a, const Request& b);
  void run();

  const scenes::Scene& scene_;
  std::function<void()> on_news_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::optional<Request> wanted_, last_;
  std::vector<MeasuredGaps> measured_;
  bool is_ending_ = false;
  std::thread thread_;  ///< begins with the first request
};

/// One line for each part near it: "housing: touches it, 2.5 N", "plate: contact", "shaft: 12.5 µm away". A
/// part that has no part within 1 mm has one line that says so.
[[nodiscard]] VPS_VIEWER_API std::vector<std::string> gapLines(const scenes::Scene& scene,
                                                               const MeasuredGaps& measured);

}  // namespace vps::viewer
