// SPDX-License-Identifier: BSD-3-Clause
// Controls how many samples wait for a sound card that takes a period at a time, from a thread that may be
// late.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "vps_viewer/export.h"

namespace vps::viewer {

/// Changes to make to the next samples.
struct QueuePlan {
  std::size_t silence = 0;  ///< samples of silence to queue before the next samples
  std::size_t dropped = 0;  ///< samples to remove from the next samples by shortened()
};

/// Keeps the queue of waiting samples, which delays the sound, as short as the thread's lateness allows. The
/// samples that still wait when the next ones are written show how much later the thread could have been. If
/// more samples than needed were left over the last two seconds, some samples are dropped, preferably quiet
/// ones. If the card ran out of samples, the queue starts again with more samples.
class VPS_VIEWER_API QueueLevel {
 public:
  /// @param period_s  time of the samples that the card takes at once
  QueueLevel(int rate_hz, double period_s);

  /// Plans the next write.
  /// @param is_playing  false: the card has nothing to play
  /// @param waiting     number of queued samples that the card has not taken yet
  /// @param count       number of the next samples, > 0
  /// @param peak        peak of the next samples, as a share of full scale
  /// @param now_s       current time; must increase from call to call
  QueuePlan plan(bool is_playing, std::size_t waiting, std::size_t count, float peak, double now_s);

  /// Number of times that samples came too late.
  [[nodiscard]] std::size_t gaps() const { return gaps_; }

 private:
  /// Minimum over a sliding time window, kept for two halves of the window.
  class Least {
   public:
    void add(std::size_t value) { now_ = now_ < value ? now_ : value; }
    void turn();
    void lower(std::size_t by);
    void clear();
    /// Whether the values cover at least half of the window.
    [[nodiscard]] bool isKnown() const { return has_before_; }
    [[nodiscard]] std::size_t get() const { return now_ < before_ ? now_ : before_; }

   private:
    static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
    std::size_t now_ = kNone, before_ = kNone;
    bool has_before_ = false;
  };

  [[nodiscard]] std::size_t samples(double time_s) const;
  void lookBack(double now_s);

  int rate_hz_;
  double period_s_, spare_s_, written_s_ = 0, turned_s_ = 0, begun_s_ = 0, calm_since_s_ = 0;
  bool has_begun_ = false;
  Least left_;   ///< samples that still waited when the next samples were written
  Least block_;  ///< samples written at once
  std::size_t gaps_ = 0;
};

/// Shortens the samples by `dropped` samples, without a step to the samples before and after.
VPS_VIEWER_API std::vector<float> shortened(std::span<const float> samples, std::size_t dropped);

}  // namespace vps::viewer
