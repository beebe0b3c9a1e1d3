// SPDX-License-Identifier: BSD-3-Clause
#include "world/step_rows.h"

#include <algorithm>

#include "judge/body_motion.h"

namespace vps::scenes {

void StepRows::beginStep(const Box& box_P) {
  box_P_ = box_P;
  fast_.clear();
  first_row_ = rows_.size();
  samples_.clear();
  stride_ = 1;
  left_ = 0;
}

void StepRows::add(const TraceRow& row, const OverlapSample& sample) {
  if (stride_ > 1) keepIfFast(last_, sample);
  last_ = sample;
  if (left_ > 0) {
    --left_;
    if (sample.depth_m > samples_.back().depth_m) samples_.back() = sample;
    samples_.back().follows = false;
    return;
  }
  rows_.push_back(row);
  samples_.push_back(sample);
  samples_.back().follows = stride_ == 1;
  if (samples_.size() > most_) thin();
  left_ = stride_ - 1;
}

void StepRows::keepIfFast(const OverlapSample& before, const OverlapSample& sample) {
  if (fast_.size() >= 2 * most_ || greatestDisplacement(box_P_, before.X_WP, sample.X_WP) <= kFast_m) return;
  for (const OverlapSample* kept : {&before, &sample}) {
    fast_.push_back(*kept);
    fast_.back().follows = kept == &sample;
  }
}

std::vector<OverlapSample> StepRows::takeSamples() {
  samples_.insert(samples_.end(), fast_.begin(), fast_.end());
  return std::move(samples_);
}

void StepRows::thin() {
  if (stride_ == 1)
    for (std::size_t i = 1; i < samples_.size(); ++i) keepIfFast(samples_[i - 1], samples_[i]);
  const std::size_t half = (samples_.size() + 1) / 2;
  for (std::size_t i = 0; i < half; ++i) {
    const std::size_t a = 2 * i, b = std::min(a + 1, samples_.size() - 1);
    rows_[first_row_ + i] = rows_[first_row_ + a];
    samples_[i] = samples_[samples_[b].depth_m > samples_[a].depth_m ? b : a];
    samples_[i].follows = false;
  }
  rows_.resize(first_row_ + half);
  samples_.resize(half);
  stride_ *= 2;
}

}  // namespace vps::scenes
