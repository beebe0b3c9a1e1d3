// SPDX-License-Identifier: BSD-3-Clause
// Trace rows and samples for the judge, of bounded number for each step: a person may take an hour for one.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "judge/overlap_record.h"
#include "vps_scenes/run/result.h"

namespace vps::scenes {

class StepRows {
 public:
  /// @param most  rows of a step, at least 2. assumed: 100 s at 1 kHz, 40 MB
  explicit StepRows(std::size_t most = 100'000) : most_(most) {}

  /// @param box_P  of the part that is moved, in its frame
  void beginStep(const Box& box_P);
  /// Of a step of more than `most` physics steps every second row is kept, and the deeper one of two samples;
  /// then every fourth, and so on. Both samples of a fast physics step (kFast_m) are kept besides, of up to
  /// `most` of them.
  void add(const TraceRow& row, const OverlapSample& sample);

  /// The rows of the current step.
  [[nodiscard]] std::span<const TraceRow> rows() const { return std::span(rows_).subspan(first_row_); }
  /// Hands over the samples of the current step, after its last row: first those of its rows, then of a
  /// thinned step the two of each fast physics step.
  [[nodiscard]] std::vector<OverlapSample> takeSamples();
  /// Hands over the rows of all steps.
  [[nodiscard]] std::vector<TraceRow> takeRows() { return std::move(rows_); }

 private:
  void thin();
  void keepIfFast(const OverlapSample& before, const OverlapSample& sample);

  std::size_t most_;
  std::vector<TraceRow> rows_;
  std::size_t first_row_ = 0;
  std::vector<OverlapSample> samples_;  ///< as many as rows of the current step
  std::vector<OverlapSample> fast_;     ///< in pairs, since the first thinning
  OverlapSample last_;
  Box box_P_;
  std::size_t stride_ = 1;  ///< physics steps for each row of the current step
  std::size_t left_ = 0;    ///< those that the last row stands for and that are still to come
};

}  // namespace vps::scenes
