// SPDX-License-Identifier: BSD-3-Clause
#include "procedure/step_rows.h"

#include <algorithm>

namespace vps::scenes::inline v0 {

void StepRows::beginStep() {
  first_row_ = rows_.size();
  samples_.clear();
  stride_ = 1;
  left_ = 0;
}

void StepRows::add(const TraceRow& row, const OverlapSample& sample) {
  if (left_ > 0) {
    --left_;
    if (sample.depth_m > samples_.back().depth_m) samples_.back() = sample;
    return;
  }
  rows_.push_back(row);
  samples_.push_back(sample);
  if (samples_.size() > most_) thin();
  left_ = stride_ - 1;
}

void StepRows::thin() {
  const std::size_t half = (samples_.size() + 1) / 2;
  for (std::size_t i = 0; i < half; ++i) {
    const std::size_t a = 2 * i, b = std::min(a + 1, samples_.size() - 1);
    rows_[first_row_ + i] = rows_[first_row_ + a];
    samples_[i] = samples_[samples_[b].depth_m > samples_[a].depth_m ? b : a];
  }
  rows_.resize(first_row_ + half);
  samples_.resize(half);
  stride_ *= 2;
}

}  // namespace vps::scenes::inline v0
