// SPDX-License-Identifier: BSD-3-Clause
// Results in words, the same on the terminal and on the pages: verdicts of runs, answers of checks.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "vps/pose.h"
#include "vps_scenes/fits/check_types.h"
#include "vps_scenes/fits/revisions.h"
#include "vps_scenes/planning/plan_types.h"
#include "vps_scenes/run/result.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

/// A unit vector in words: "+x", or "(0.71, 0.71, 0.00)".
VPS_VIEWER_API std::string directionWords(const Vec3& d);
/// "'a', 'b'"; of more than eight names the first eight "and 3 more".
VPS_VIEWER_API std::string listedNames(const std::vector<std::string>& names);

/// Two different lengths in millimetres, without unit, with three digits or with as many as tell them apart
/// (six at most): "0.010" and "0.250", or "0.0104" and "0.0100".
VPS_VIEWER_API std::array<std::string, 2> toldApart(double a_m, double b_m);

/// What is known of a part without a path, to follow its name: that it is proven to be enclosed, or
/// `not_found` with the parts that stop it and a search that ended at its limit.
VPS_VIEWER_API std::string withoutPathWords(const scenes::BlockedPart& part, const std::string& not_found);

/// The words of a verdict: "fits", "blocked", "not shown".
VPS_VIEWER_API const char* words(scenes::Verdict verdict);

/// Whether contact brought a step's part to its target: "yes", or "no: " and the reason.
VPS_VIEWER_API std::string contactWords(const scenes::StepResult& step);
/// Where the part was brought to, if its drawn place is one at which it overlaps another part
/// (StepResult::moved_m).
VPS_VIEWER_API std::string movedWords(const scenes::StepResult& step);

/// The parts that did not reach their targets and were put there so that later steps could be tried, in one
/// sentence for the whole run; empty if no step depends on such a part (StepResult::stands_on).
VPS_VIEWER_API std::string putAtTargetWords(const scenes::AssembleResult& result);

/// The result of several tries: "Ease of assembly: 7 of 10 tries brought every part home."; empty for a
/// single run.
VPS_VIEWER_API std::string easeWords(const scenes::AssembleResult& result);

/// Whether the run took parts off (vps assemble --disassemble).
VPS_VIEWER_API bool isDisassembly(const scenes::AssembleResult& result);

/// The verdict in one sentence: "Yes, the parts go together: 3 of 3 steps fit."
VPS_VIEWER_API std::string verdictLine(const scenes::AssembleResult& result);

/// The definition of the overlap in the tables.
inline constexpr const char* kOverlapMeaning =
    "overlap: greatest depth of a point of one part's surface below the other part's surface, or, if "
    "greater, thickness of the shared volume (diameter of the greatest ball in that volume); an overlap "
    "of up to 0.5 um beyond its error counts as contact";
static_assert(scenes::kContactDepth_m == 0.5e-6);

/// The free travel of a part in one direction: "free", "1009.0"; "1009.0 (+- 962.4)" if the error is more
/// than twice the usual error of the part's play, as in a taper; ">= 909.7" if the search ended before the
/// part touched.
/// @param usual  CheckedPart::play_error_m, or play_error_rad for a rotation
/// @param form   printf format of a number, as "%.1f"
VPS_VIEWER_API std::string playWords(double way, double error, double usual, double scale, const char* form);

/// Why the play of a part is uncertain, and by how much: "facets cross others as drawn; ..."; empty if the
/// play is certain.
VPS_VIEWER_API std::string playDoubt(const scenes::CheckedPart& part, const scenes::CheckResult& result);

/// The answer to "do the parts go together?", unless it is yes for the parts as drawn: "can be assembled:
/// free if 'bolt' moves by 0.050 mm along +x", "cannot be assembled with its parts where they are drawn,
/// or within 0.5 mm of there ...", "not shown: ..."; empty if the parts go together as drawn.
VPS_VIEWER_API std::string assemblyWords(const scenes::CheckResult& result);

/// The differences of two revisions in one sentence: "3 parts, 1 clearance and 2 fits changed; the answer was
/// 'fits' and is 'blocked'", or "nothing changed".
VPS_VIEWER_API std::string revisionWords(const scenes::RevisionChanges& changes);

}  // namespace vps::viewer
