// SPDX-License-Identifier: BSD-3-Clause
// Results in words, the same on the terminal and on the pages: verdicts of runs, answers of checks.
#pragma once

#include <string>

#include "vps_scenes/fits/check_types.h"
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

/// How the overlap in the tables is meant.
inline constexpr const char* kOverlapMeaning =
    "overlap: greatest depth of a point of one part's surface below the other's, or thickness of what both "
    "share (diameter of the greatest ball in it) if more; up to 0.5 um beyond its error it counts as contact";
static_assert(scenes::kContactDepth_m == 0.5e-6);

/// The volume that two parts share, in cubic millimetres: "7.9840"; "<= 12.3" where its error is as large;
/// "not known" where no piece of its surface was found.
VPS_VIEWER_API std::string volumeWords(const scenes::CheckedPair& pair);

/// How far a part moves one way: "free", "1009.0"; "1009.0 (+- 962.4)" where its error is more than twice
/// that of the part's play, as in a taper; ">= 909.7" where the search ended before.
/// @param usual  CheckedPart::play_error_m, or of a turn play_error_rad
/// @param form   of a number, as "%.1f"
VPS_VIEWER_API std::string playWords(double way, double error, double usual, double scale, const char* form);

/// Why the play of a part is not certain, and by how much: "facets cross others as drawn; ..."; empty if
/// it is.
VPS_VIEWER_API std::string playDoubt(const scenes::CheckedPart& part, const scenes::CheckResult& result);

/// The answer to "do the parts go together?" where it is not yes as drawn: "can be assembled: free if 'bolt'
/// moves by 0.050 mm along +x", "cannot be assembled: ...", "not shown: ..."; empty for yes as drawn.
VPS_VIEWER_API std::string assemblyWords(const scenes::CheckResult& result);

}  // namespace vps::viewer
