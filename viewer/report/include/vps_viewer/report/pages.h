// SPDX-License-Identifier: BSD-3-Clause
// The HTML pages of `vps check`, `vps margin`, `vps study` and `vps compare`; and any page as PDF. report.h
// has the report of a run.
#pragma once

#include <string>
#include <vector>

#include "vps/errors.h"
#include "vps_scenes/fits/check_types.h"
#include "vps_scenes/fits/revisions.h"
#include "vps_scenes/planning/margin.h"
#include "vps_scenes/planning/study.h"
#include "vps_scenes/uses/compare.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

/// Tables of pairs, fits and press fits, without pictures, for the report of a run.
VPS_VIEWER_API std::string checkTablesOfRun(const scenes::CheckResult& result);
/// Tables of pairs, fits and play, for a page that has other sections.
VPS_VIEWER_API std::string checkSection(const scenes::CheckResult& result, const Progress& progress = {});
/// A whole page of a check, with the answer first.
/// @param after_answer HTML that follows the answer, as revisionSection()
/// @param progress  may be empty; called before each picture. Its exceptions end the drawing.
VPS_VIEWER_API std::string checkPage(const scenes::CheckResult& result, const std::string& after_answer = {},
                                     const Progress& progress = {});

/// The differences of two revisions as tables, with the answer before and after.
VPS_VIEWER_API std::string revisionSection(const scenes::RevisionChanges& changes);

/// A page of margins: the answer, a bar for each step (the tightest first) and a table.
VPS_VIEWER_API std::string marginPage(const scenes::MarginResult& result);

/// A page of a study: the yield, the loss of yield that each tolerance causes, and a histogram of each
/// deviation.
VPS_VIEWER_API std::string studyPage(const scenes::StudyResult& result);

/// A deviation with its unit: "-3.20 µm", "0.150 mrad", "0.020".
VPS_VIEWER_API std::string deviationText(const scenes::StudyVariable& variable, double value);

/// Writes compare.html, and for each step plots/path_N and plots/force_N (PNG and SVG), into dir, which
/// exists. Returns notes on plots that could not be drawn. Throws LoadError when dir cannot be written.
VPS_VIEWER_API std::vector<std::string> writeComparePage(const scenes::RunComparison& result,
                                                         const std::string& dir);

/// The reason why this machine cannot print PDF, with a remedy; empty if it can.
VPS_VIEWER_API std::string missingForPdf();

/// Prints an HTML file as PDF. Returns an empty text on success, otherwise the reason. Printing takes a few
/// seconds.
VPS_VIEWER_API std::string printPdf(const std::string& page, const std::string& pdf);
/// Prints the text of a page that shows nothing from other files. The result is as for printPdf().
VPS_VIEWER_API std::string printPdfOf(const std::string& html, const std::string& pdf);

}  // namespace vps::viewer
