// SPDX-License-Identifier: BSD-3-Clause
// Fewer rows of a run's time series.
#pragma once

#include <vector>

#include "vps_scenes/run/result.h"

namespace vps::viewer {

/// The first row of every period 1 / rate_hz.
std::vector<scenes::TraceRow> thinned(const std::vector<scenes::TraceRow>& trace, double rate_hz);

}  // namespace vps::viewer
