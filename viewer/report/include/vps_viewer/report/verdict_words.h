// SPDX-License-Identifier: BSD-3-Clause
// The verdict of a run in words, the same on the terminal and in the report.
#pragma once

#include <string>

#include "vps_scenes/run/result.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

/// "fits", "blocked", "not shown"
VPS_VIEWER_API const char* words(scenes::Verdict verdict);

/// Whether a step's part was brought home by contact: "yes", or "no: " and why not.
VPS_VIEWER_API std::string contactWords(const scenes::StepResult& step);

/// "Ease of assembly: 7 of 10 tries succeeded"; empty for a single run.
VPS_VIEWER_API std::string easeWords(const scenes::AssembleResult& result);

/// The run took parts off (vps assemble --disassemble).
VPS_VIEWER_API bool isDisassembly(const scenes::AssembleResult& result);

/// One sentence: "Yes, the parts go together: all 3 steps fit."
VPS_VIEWER_API std::string verdictLine(const scenes::AssembleResult& result);

}  // namespace vps::viewer
