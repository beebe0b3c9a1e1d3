// SPDX-License-Identifier: BSD-3-Clause
// How much sound waits for a card that takes a period at a time, from a thread that may be late.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "vps_viewer/export.h"

namespace vps::viewer {

/// What is to be done with the next samples.
struct QueuePlan {
  std::size_t silence = 0;  ///< samples of silence to queue before them
  std::size_t dropped = 0;  ///< of them, by shortened()
};

/// Keeps as little waiting as the thread's lateness needs: sound is heard later by what waits. The samples
/// that still wait when the next ones come show how late the thread could have been. Where more of them are
/// left than needed, over two seconds, some are dropped, rather such as nobody hears; where the card ran out
/// of samples it begins again with more.
class VPS_VIEWER_API QueueLevel {
 public:
  /// @param period_s  of the card, which takes as much at once
  QueueLevel(int rate_hz, double period_s);

  /// @param is_playing  false: the card has nothing to play
  /// @param waiting     samples that it has not taken yet
  /// @param count       of the next samples, > 0
  /// @param peak        of them, of full scale
  /// @param now_s       increasing
  QueuePlan plan(bool is_playing, std::size_t waiting, std::size_t count, float peak, double now_s);

  /// Times that samples came too late.
  [[nodiscard]] std::size_t gaps() const { return gaps_; }

 private:
  /// The least of two halves of the time that is looked back on.
  class Least {
   public:
    void add(std::size_t value) { now_ = now_ < value ? now_ : value; }
    void turn();
    void lower(std::size_t by);
    void clear();
    /// Of a whole half at least.
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
  Least left_;   ///< that waited when others came
  Least block_;  ///< written at once
  std::size_t gaps_ = 0;
};

/// The samples with fewer of them, without a step to those before and after.
VPS_VIEWER_API std::vector<float> shortened(std::span<const float> samples, std::size_t dropped);

}  // namespace vps::viewer
