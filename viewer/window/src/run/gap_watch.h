// SPDX-License-Identifier: BSD-3-Clause
// Measures, on threads of their own, which parts are near a part and which touch it: at the poses that are
// shown (GapWatch), and in the finished assembly (Neighbours).
#pragma once

#include <condition_variable>
#include <functional>
#include <future>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "vps_scenes/fits/check_types.h"
#include "vps_scenes/run/part_gaps.h"
#include "vps_scenes/scene/scene.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

/// The measured distances of one part.
struct MeasuredGaps {
  std::size_t part = 0;
  double time_s = 0;                       ///< time of the snapshot
  std::vector<scenes::PartGap> gaps;       ///< sorted by distance, up to GapWatch::kMost_m
  std::vector<scenes::PartTouch> touches;  ///< contacts of the part in the snapshot
};

/// Measures the newest requested snapshot, at most every 50 ms, so that the run keeps its processor time.
/// Older requests are skipped, and the same request is not measured twice.
class VPS_VIEWER_API GapWatch {
 public:
  static constexpr double kMost_m = 1e-3;

  /// The scene must outlive the GapWatch. Nothing is prepared before the first request.
  /// @param on_news  called on the measuring thread after each measurement; may be empty
  explicit GapWatch(const scenes::Scene& scene, std::function<void()> on_news = {});
  ~GapWatch();
  GapWatch(const GapWatch&) = delete;
  GapWatch& operator=(const GapWatch&) = delete;

  /// Requests a measurement.
  /// @param parts  parts to measure (the picked part, the part in hand); empty: measures nothing
  void request(const scenes::Snapshot& shot, std::vector<std::size_t> parts);
  /// The newest measurement of a part; none: it is not measured yet, or the last request had other parts.
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
  std::thread thread_;  ///< started by the first request
};

/// A line of text for each part within 1 mm: "housing: touches this part, 2.5 N", "plate: contact",
/// "shaft: 12.5 µm away". If there is no such part, the line "nothing within 1 mm".
[[nodiscard]] VPS_VIEWER_API std::vector<std::string> gapLines(const scenes::Scene& scene,
                                                               const MeasuredGaps& measured);

/// Neighbours of a part in the finished assembly.
class VPS_VIEWER_API Neighbours {
 public:
  /// The scene must outlive the Neighbours.
  explicit Neighbours(const scenes::Scene& scene) : scene_(scene) {}

  /// A line of text for each part within 1 mm: "housing: contact", "shaft: 12.5 µm apart". The first call
  /// starts the measurement; until its end the only line is "measuring ...".
  [[nodiscard]] std::vector<std::string> of(const std::string& part);

 private:
  const scenes::Scene& scene_;
  std::shared_future<scenes::CheckResult> checked_;
};

}  // namespace vps::viewer
