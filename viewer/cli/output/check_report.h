// SPDX-License-Identifier: BSD-3-Clause
// Output of `vps check`: tables and CSV.
#pragma once

#include <string>

#include "vps_scenes/fits/check_types.h"

namespace vps::viewer {

/// Tables of pairs, fits and parts; what was not asked for, and what there is none of, is left out.
std::string checkTables(const scenes::CheckResult& result);
/// The answer in a sentence.
std::string checkHeadline(const scenes::CheckResult& result);
/// A line for each number: what, a, b, quantity, value, error.
std::string checkCsv(const scenes::CheckResult& result);

}  // namespace vps::viewer
