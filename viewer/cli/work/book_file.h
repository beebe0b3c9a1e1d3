// SPDX-License-Identifier: BSD-3-Clause
// The instruction book of a plan, as HTML or PDF, for `vps plan --book`.
#pragma once

#include <string>
#include <vector>

#include "output/output.h"
#include "output/terminal.h"
#include "vps_scenes/planning/plan.h"

namespace vps::viewer {

/// A file that receives an instruction book. The object is made before the work, so that a wrong name, a file
/// that cannot be written, or a missing Chromium is reported early.
class BookFile {
 public:
  /// With an empty name nothing is written. Throws LoadError if the name ends in neither .html nor .pdf, and
  /// as OutputFile and PdfFile do.
  BookFile(const std::string& file, const std::vector<std::string>& inputs);

  /// Measures fits and play of the scene's parts as drawn, draws the pictures and writes the book. Prints the
  /// file's name, and a warning if pictures are missing. Throws as checkAssembly(), and LoadError if the file
  /// cannot be written or printed.
  /// @param scene        the scene that was planned
  /// @param has_density  see scenes::makeBook()
  void write(const scenes::Scene& scene, const scenes::PlanResult& plan, bool has_density, ProgressBar& bar);

 private:
  std::string file_;
  OutputFile html_;  ///< of a book in HTML; else without a name
  PdfFile pdf_;      ///< of a book in PDF; else without a name
};

}  // namespace vps::viewer
