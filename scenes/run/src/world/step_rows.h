// SPDX-License-Identifier: BSD-3-Clause
// Trace rows and samples for the judge. Their number for each step is bounded, since a person may take an
// hour for one step.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "judge/overlap_record.h"
#include "vps_scenes/run/result.h"

namespace vps::scenes {

class StepRows {
 public:
  /// @param most  greatest number of rows of a step, at least 2. assumed: 100 s at 1 kHz, 40 MB
  explicit StepRows(std::size_t most = 100'000) : most_(most) {}

  /// @param box_P  bounds of the moved part, in its frame
  void beginStep(const Box& box_P);
  /// If a step has more than `most` physics steps, every second row and the deeper of each two samples are
  /// kept; the stride doubles again whenever `most` rows are exceeded. In addition, both samples of up to
  /// `most` fast physics steps (kFast_m) are kept.
  void add(const TraceRow& row, const OverlapSample& sample);

  /// The rows of the current step.
  [[nodiscard]] std::span<const TraceRow> rows() const { return std::span(rows_).subspan(first_row_); }
  /// Returns the samples of the current step when its last row was added: first the samples of the rows,
  /// then, for a thinned step, the two samples of each fast physics step.
  [[nodiscard]] std::vector<OverlapSample> takeSamples();
  /// Returns the rows of all steps.
  [[nodiscard]] std::vector<TraceRow> takeRows() { return std::move(rows_); }

 private:
  void thin();
  void keepIfFast(const OverlapSample& before, const OverlapSample& sample);

  std::size_t most_;
  std::vector<TraceRow> rows_;
  std::size_t first_row_ = 0;
  std::vector<OverlapSample> samples_;  ///< one sample for each row of the current step
  std::vector<OverlapSample> fast_;     ///< two samples for each fast physics step; empty before thinning
  OverlapSample last_;
  Box box_P_;
  std::size_t stride_ = 1;  ///< number of physics steps for each row of the current step
  std::size_t left_ = 0;    ///< number of coming physics steps that the last row also represents
};

}  // namespace vps::scenes
